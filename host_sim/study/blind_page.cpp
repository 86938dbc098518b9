// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page of a blind study: the figures that matter, which effect is taken for which, how far a probability may be
// trusted, from which gap on an effect is found, what came out of the parameters.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "report/uncertainty.hpp"
#include "study/blind_files.hpp"
#include "study/several_score.hpp"

namespace steerid::blind_study {
namespace {

std::string spoken(std::string id) {
  std::replace(id.begin(), id.end(), '_', ' ');
  return id;
}

report::KeyNumber key_number(const char* label, const Share& share) {
  const Interval ci = share.ci95();
  return {.label = label,
          .value = report::in_digits(100 * share.value(), 3),
          .unit = share.all == 0 ? "" : "%",
          .note = share.all == 0 ? "no such record"
                                 : fmt::format("{:.1f} to {:.1f} %, {} of {}", 100 * ci.low, 100 * ci.high, share.some,
                                               share.all)};
}

report::Headline headline(const Study& study) {
  report::Headline head;
  const std::size_t records = study.cases.size() + study.pairs.size() + study.left_out.size();
  head.verdict = fmt::format("{} drawn records, seed {}: diagnosed without their answers.", records, study.seed);
  if (!study.cases.empty()) {
    const Scores s = score(study.cases);
    head.numbers = {
        key_number("Verdict right", s.right),
        key_number("Among the first three", s.top3),
        key_number("Effect named where there is none", s.false_alarms),
        key_number("Unknown effects called unknown", s.abstained),
        key_number("Needlessly unknown", s.needlessly_unknown),
        {.label = "Probability on the truth", .value = report::in_digits(s.mean_probability, 3), .note = "mean"},
        {.label = "Brier score", .value = report::in_digits(s.brier, 3), .note = "0 best, 2 worst"},
        {.label = "Gap closed", .value = report::in_digits(100 * s.median_closed, 3), .unit = "%", .note = "median"}};
  }
  if (!study.pairs.empty())
    head.numbers.push_back(key_number("Both of two effects named", score_pairs(study.pairs).both_named));
  if (!study.several.empty())
    head.numbers.push_back(key_number("All changes named, no other", score_several(study.several).all.exact));
  if (!study.left_out.empty()) {
    head.numbers.push_back(key_number("Left-out effects called unknown",
                                      score_leave_one_out(study.left_out, study.left_out_whole).unknown));
  }
  return head;
}

report::Heatmap confusion(const Scores& s) {
  std::set<std::string> said;
  for (const auto& [label, of] : s.labels) {
    said.insert(label);
    for (const auto& [verdict, count] : of.verdicts) said.insert(verdict);
  }
  report::Heatmap map{.title = "Which is taken for which",
                      .caption = "Share of a row's records, in percent.",
                      .x_label = "verdict",
                      .y_label = "truth",
                      .value = {.label = "Share", .unit = "%", .range = std::array{0.0, 100.0}},
                      .digits = 3};
  for (const std::string& verdict : said) map.columns.push_back(spoken(verdict));
  for (const auto& [label, of] : s.labels) {
    map.rows.push_back(fmt::format("{} ({})", spoken(label), of.cases));
    std::vector<double> row;
    for (const std::string& verdict : said) {
      const auto found = of.verdicts.find(verdict);
      row.push_back(found == of.verdicts.end()
                        ? std::nan("")
                        : 100 * static_cast<double>(found->second) / static_cast<double>(of.cases));
    }
    map.values.push_back(std::move(row));
  }
  return map;
}

void push(report::BarSeries& bars, const Share& share) {
  const Interval ci = share.ci95();
  bars.values.push_back(100 * share.value());
  bars.low.push_back(100 * ci.low);
  bars.high.push_back(100 * ci.high);
}

report::Bars detection(const Scores& s) {
  report::Bars chart{.title = "From which gap on an effect is found",
                     .caption = "Records with an effect of the vocabulary, by what it adds to the noise.",
                     .value = {.label = "Share of the records", .unit = "%"}};
  report::BarSeries right{.name = "right effect named", .meaning = report::Meaning::kModel};
  report::BarSeries noticed{.name = "gap noticed", .meaning = report::Meaning::kReference};
  for (const GapBand& band : s.detection) {
    if (band.right.all == 0) continue;
    chart.categories.push_back(band.high > 50 ? fmt::format("gap over noise above {}", band.low)
                                              : fmt::format("gap over noise {} to {}", band.low, band.high));
    push(right, band.right);
    push(noticed, band.noticed);
  }
  chart.series = {std::move(right), std::move(noticed)};
  return chart;
}

/// A calibrated probability lies on the line.
report::Scatter reliability(const std::vector<ReliabilityBand>& bands, std::string caption) {
  report::Scatter chart{.title = "Whether a probability is one",
                        .caption = std::move(caption),
                        .x = {.label = "Probability stated", .unit = "%", .range = std::array{0.0, 100.0}},
                        .y = {.label = "Right", .unit = "%", .range = std::array{0.0, 100.0}},
                        .identity = true};
  report::Cloud cloud{.name = "groups", .meaning = report::Meaning::kModel};
  for (const ReliabilityBand& band : bands) {
    if (band.right.all == 0) continue;
    cloud.x.push_back(100 * band.mean_probability);
    cloud.y.push_back(100 * band.right.value());
    cloud.labels.push_back(fmt::format("{} of {} right", band.right.some, band.right.all));
  }
  chart.clouds = {std::move(cloud)};
  return chart;
}

report::Table labels(const Scores& s) {
  report::Table table{.title = "By truth",
                      .columns = {{"Truth", "", false},
                                  {"Records", "", true, 4},
                                  {"Right", "%", true, 3},
                                  {"Probability on it", "", true, 3},
                                  {"Taken for", "", false}}};
  for (const auto& [label, of] : s.labels) {
    std::vector<std::string> others;
    for (const auto& [verdict, count] : of.verdicts) {
      if (verdict != label) others.push_back(fmt::format("{} {}", spoken(verdict), count));
    }
    table.rows.push_back({spoken(label), static_cast<double>(of.cases), 100 * of.right.value(), of.mean_probability,
                          fmt::format("{}", fmt::join(others, ", "))});
  }
  return table;
}

report::Table counted(const char* title, const char* what,
                      const std::map<std::string, std::map<std::string, std::size_t>>& rows) {
  report::Table table{.title = title, .columns = {{what, "", false}, {"Verdicts", "", false}}};
  for (const auto& [name, verdicts] : rows) {
    std::vector<std::string> said;
    for (const auto& [verdict, count] : verdicts) said.push_back(fmt::format("{} {}", spoken(verdict), count));
    table.rows.push_back({spoken(name), fmt::format("{}", fmt::join(said, ", "))});
  }
  return table;
}

report::Table changes(const SeveralScores& s) {
  report::Table table{.title = "By what has to change",
                      .columns = {{"Simulation against wheel", "", false},
                                  {"Records", "", true, 4},
                                  {"Exactly the changes", "%", true, 3},
                                  {"All of them named", "%", true, 3},
                                  {"No other named", "%", true, 3}}};
  for (const auto& [name, of] : s.of) {
    table.rows.push_back({name, static_cast<double>(of.exact.all), 100 * of.exact.value(), 100 * of.all_named.value(),
                          100 * of.only_true.value()});
  }
  return table;
}

report::Table recovery(const Scores& s) {
  report::Table table{.title = "What came out of the numbers",
                      .caption = "Where the right verdict was given. Covered: by the 95 % interval.",
                      .columns = {{"Parameter", "", false},
                                  {"Records", "", true, 4},
                                  {"Median error", "%", true, 2},
                                  {"90 % err less than", "%", true, 2},
                                  {"Covered", "%", true, 3}}};
  for (const auto& [name, of] : s.recovery) {
    table.rows.push_back({spoken(name), static_cast<double>(of.cases), of.median_error_percent, of.p90_error_percent,
                          100 * of.covered.value()});
  }
  return table;
}

}  // namespace

report::Page blind_page(const Study& study) {
  report::Page page{.title = "Study: blind",
                    .subtitle = fmt::format("Records drawn by an independent simulation, answers sealed before the "
                                            "diagnosis; SHA-256 of the key {}.",
                                            study.key_sha256)};
  page.parts.emplace_back(headline(study));
  if (!study.cases.empty()) {
    const Scores s = score(study.cases);
    page.parts.emplace_back(detection(s));
    page.parts.emplace_back(
        reliability(s.reliability, fmt::format("Records grouped by the probability of the most probable verdict; a "
                                               "calibrated one lies on the line. Mean distance {}.",
                                               report::in_digits(s.calibration_error, 2))));
    page.parts.emplace_back(confusion(s));
    page.parts.emplace_back(labels(s));
    page.parts.emplace_back(counted("Effects outside the vocabulary", "Effect", s.outside));
    page.parts.emplace_back(recovery(s));
  }
  if (!study.several.empty()) {
    const SeveralScores s = score_several(study.several);
    page.parts.emplace_back(changes(s));
    page.parts.emplace_back(reliability(
        s.reliability, fmt::format("Changes grouped by their probability; a calibrated one lies on the line. Mean "
                                   "distance above 5 % {}.",
                                   report::in_digits(s.calibration_error, 2))));
  }
  if (!study.left_out.empty()) {
    const LeaveOneOutScores s = score_leave_one_out(study.left_out, study.left_out_whole);
    std::map<std::string, std::map<std::string, std::size_t>> rows;
    for (const auto& [effect, of] : s.effects) {
      rows[effect] = of.impostors;
      rows[effect]["unknown"] += of.unknown.all;
      for (const auto& [impostor, count] : of.impostors) rows[effect]["unknown"] -= count;
    }
    page.parts.emplace_back(counted("Left out of the library", "Effect", rows));
  }
  page.footer = fmt::format("steerid study blind --seed {}", study.seed);
  return page;
}

}  // namespace steerid::blind_study
