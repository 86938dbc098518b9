// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Tables I and II beside the experiment's own, and what the printed ones say of themselves.
#include <cmath>

#include "reproduction/page_parts.hpp"

namespace steerid::page {
namespace {

constexpr std::array kNames{"J, kg m\u00b2", "B, Nms/rad", "C, Nm/rad", "f, Hz"};

std::string printed_range(const PublishedRange& range) {
  return fmt::format("{} [{}, {}]", range.nominal, range.low, range.high);
}

std::vector<report::Column> columns(bool with_paper) {
  std::vector<report::Column> out{words("hands"), words("")};
  if (with_paper) out.push_back(words("paper"));
  for (const char* label : {"put in", "found, as the paper excites", "found, with a probe", "firmware, with a probe"}) {
    out.push_back(words(label));
  }
  return out;
}

void add_rows(report::Table& table, const TableRow& row, bool with_paper) {
  const PublishedRow& paper = published_row(row.task, row.hands);
  const std::array printed{paper.inertia_kgm2, paper.damping_nms_per_rad, paper.stiffness_nm_per_rad,
                           paper.natural_frequency_hz};
  for (std::size_t i = 0; i < 4; ++i) {
    std::vector<report::Cell> cells{i == 0 ? spoken(row.hands) : std::string(), std::string(kNames[i])};
    if (with_paper) cells.emplace_back(printed_range(printed[i]));
    for (const FourSpreads* spreads : {&row.truth, &row.plain, &row.probed, &row.recursive_probed}) {
      cells.emplace_back(written((*spreads)[i], i == 0 ? 3 : 2, kSubjects));
    }
    table.rows.push_back(std::move(cells));
  }
}

report::Table table(const ExperimentResults& results, TaskKind task, bool both, const std::string& title) {
  report::Table out;
  out.title = title;
  out.columns = columns(!both);
  for (const TableRow& row : results.rows) {
    if (row.task == task && both_arms(row.hands) == both) add_rows(out, row, !both);
  }
  return out;
}

report::Table overdamped(const ExperimentResults& results) {
  report::Table out;
  out.title = "Records to which equation 5 does not apply";
  out.caption =
      "\u03be \u2265 1: the wheel returns without swinging, and \u221a(1 \u2212 \u03be\u00b2) is not a number. The "
      "paper's three nominal active rows are of this kind. In brackets \u03be of the arm that was put in.";
  out.columns = {words("task and hands"), words("subjects (\u03be)"), numbers("put in", "", 3),
                 numbers("named so by the fit", "", 3)};
  for (const TableRow& row : results.rows) {
    if (row.overdamped_truth == 0) continue;
    std::string subjects;
    for (const Overdamped& one : results.overdamped) {
      if (one.task != row.task || one.hands != row.hands) continue;
      subjects += fmt::format("{}{} ({:.2f})", subjects.empty() ? "" : ", ", one.subject + 1, one.damping_ratio_truth);
    }
    out.rows.push_back({spoken(row.task, row.hands), subjects, fmt::format("{}", row.overdamped_truth),
                        fmt::format("{}", row.overdamped_probed)});
  }
  return out;
}

report::Table frequencies(const ExperimentResults& results) {
  report::Table out;
  out.title = "The printed natural frequencies against equation 5";
  out.caption =
      "Nominal J, B, C of each row put into the paper's own equation. Over all inertias equation 5 gives at most "
      "C/(2\u03c0B), at J = B\u00b2/(2C); a printed frequency above that belongs to no inertia whatever.";
  out.columns = {words("row"),
                 numbers("\u03be", "", 3),
                 numbers("printed f", "Hz", 2),
                 numbers("equation 5", "Hz", 3),
                 numbers("\u221a(C/J)/2\u03c0", "Hz", 3),
                 numbers("most of any J", "Hz", 3),
                 words("J that would agree", "kg m\u00b2")};
  for (const FrequencyCheck& check : results.checks) {
    const std::string agree = check.larger_inertia_kgm2 ? fmt::format("{:.3f} or {:.3f}", *check.smaller_inertia_kgm2,
                                                                      *check.larger_inertia_kgm2)
                                                        : std::string("none");
    out.rows.push_back({spoken(check.row.task, check.row.hands), check.damping_ratio,
                        check.row.natural_frequency_hz.nominal, check.equation_5_hz.value_or(kNothing),
                        check.undamped_hz, check.highest_hz, agree});
  }
  return out;
}

}  // namespace

std::string spoken(HandPosition hands) {
  constexpr std::array kSpoken{"right arm, 3",     "right arm, 12",     "right arm, 1:30",
                               "both arms, 3 + 9", "both arms, 12 + 6", "both arms, 10:10"};
  return kSpoken[static_cast<std::size_t>(hands)];
}

std::string written(const Spread& spread, int decimals, std::size_t of) {
  if (spread.count == 0) return "\u2013";
  const auto number = [&](double value) { return fmt::format("{:.{}f}", value, decimals); };
  std::string text = number(spread.median);
  if (number(spread.low) != number(spread.high)) {
    text += fmt::format(" [{}, {}]", number(spread.low), number(spread.high));
  }
  if (spread.count < of) text += fmt::format(", {} of {}", spread.count, of);
  return text;
}

std::string spoken(TaskKind task, HandPosition hands) { return fmt::format("{}, {}", name(task), spoken(hands)); }

void add_put_in(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{
      "What was put in, and what was found",
      "The drivers are virtual. Their arms are drawn from tables I and II of the paper, the effect of a second arm is "
      "a factor of this program. Nothing here confirms the paper's tables: it shows what an identification gives back "
      "of arms that are known."});
  report::Table table;
  table.title = "The same statistic of the arms put in and of the answers";
  table.caption =
      "Median [least, largest]; ratios of two records of one subject that differ in nothing else. Valid batch answers "
      "only, with their number where it is smaller.";
  table.columns = {words(""), words("comes from"), words("put in"), words("found, as the paper excites"),
                   words("found, with a probe")};
  for (const PutIn& one : results.put_in) {
    const int decimals = one.unit.starts_with("kg") ? 3 : 2;
    const auto cell = [&](const Spread& spread) { return written(spread, decimals, one.truth.count); };
    table.rows.push_back({one.unit.empty() ? one.what : fmt::format("{}, {}", one.what, one.unit), one.origin,
                          cell(one.truth), cell(one.plain), cell(one.probed)});
  }
  page.parts.push_back(table);
}

void add_tables(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{
      "Tables I and II",
      "Nominal value (here: the median of ten) and range. \"Put in\" are the arms that were drawn from the paper's "
      "column, so that it is no finding that they resemble it; found is what the records show of them. Only answers "
      "that are valid are counted; where fewer than ten subjects have one, it says so."});
  page.parts.push_back(table(results, TaskKind::kPassive, false, "Table I: passive task, right arm"));
  page.parts.push_back(table(results, TaskKind::kActive, false, "Table II: active task, right arm"));
  page.parts.push_back(table(results, TaskKind::kPassive, true, "Passive task, both arms (the paper prints none)"));
  page.parts.push_back(table(results, TaskKind::kActive, true, "Active task, both arms (the paper prints none)"));
  page.parts.push_back(overdamped(results));
}

void add_contradictions(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{"Where the paper contradicts itself", "With the arithmetic."});
  page.parts.push_back(frequencies(results));
  const FrequencyCheck& first = results.checks.front();
  page.parts.push_back(report::Note{
      "What follows",
      {fmt::format(
           "Passive, 3 o'clock: \u03be = 1.5/(2\u221a(0.11\u00b722.7)) = {:.3f}, so equation 5 gives "
           "{:.2f} Hz. Table I prints 3.3 Hz, and even without damping \u221a(22.7/0.11)/2\u03c0 = {:.2f} Hz is all "
           "there is. With C/B = 15.1 /s no inertia reaches more than {:.2f} Hz.",
           first.damping_ratio, first.equation_5_hz.value_or(0), first.undamped_hz, first.highest_hz),
       "Nominal values of separate columns need not belong to one subject, and medians of a nonlinear function are not "
       "the function of medians. That explains small differences, not a factor, and not a frequency for \u03be > 1.",
       "Section VI.A gives the stiffness \"mainly within the range of 2.5 Hz-3.5 Hz\" and so does the conclusion: "
       "the natural frequency is meant.",
       "Section VI.B finds no evident variation of the stiffness with the hand position, but table I has nominal "
       "values "
       "of 22.7, 45.9 and 17.0 Nm/rad at 3, 12 and 1:30, and the ranges of the last two hardly meet "
       "([29.1, 80.5] and [13.0, 35.2]). See figure 10 above for how a correlation can miss that.",
       "Section V.B asks for a sine of around 1.0 rad (60 degrees) and describes figure 6 as having an amplitude of "
       "0.5 rad; both hold only if the 1.0 rad are counted from peak to peak.",
       "Equation 19 bounds the Jacobian from below (\u2265 \u03b2); the proof that follows needs \u2264 \u03b2. "
       "Equation 15 puts "
       "the model \u03c6 where the objective f belongs.",
       "Section IV.C takes the moment measured at the rim for T_driver. A transducer between hand and wheel feels the "
       "whole hand, its inertia, damping and stiffness included: in the quasi-static passive task it reads T_motor, "
       "and "
       "T_driver \u2212 T_motor of equation 1 would vanish. Here T_driver is what the driver applies beyond J, B and "
       "C."},
      report::Tone::kCaution});
}

}  // namespace steerid::page
