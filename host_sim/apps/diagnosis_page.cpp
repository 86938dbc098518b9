// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/diagnosis_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "apps/diagnosis_charts.hpp"
#include "apps/diagnosis_words.hpp"
#include "apps/possibilities.hpp"
#include "log/reading_time.hpp"
#include "report/uncertainty.hpp"

namespace steerid {
namespace {

using report::Cell;

report::Tone tone(const gap::Diagnosis& d) {
  if (d.verdict == "none") return report::Tone::kGood;
  if (d.verdict == "unknown") return report::Tone::kBad;
  return probability_of_answer(d) >= 0.8 && d.equivalent.empty() ? report::Tone::kGood : report::Tone::kCaution;
}

bool adds_effects(const gap::Diagnosis& d) { return !d.causes.empty(); }

template <class Estimate>
std::string range(const Estimate& e) {
  if (!std::isfinite(e.low) || !std::isfinite(e.high)) return "not excited";
  return report::in_interval(e.low, e.high);
}

report::Headline headline(const gap::Diagnosis& d) {
  report::Headline part{verdict_sentence(d), tone(d), {}};
  const bool several = names_several(d);
  part.numbers.push_back({.label = "Verdict",
                          .value = several ? fmt::format("{} changes", d.causes.size()) : spoken(d.verdict),
                          .note = fmt::format("probability {}{}", report::in_digits(probability_of_answer(d), 2),
                                              several ? " or more, each" : "")});
  if (adds_effects(d)) {
    const gap::BoundedValue& closed = d.gap.closed_fraction;
    if (std::isfinite(closed.value)) {
      part.numbers.push_back({.label = "Gap closed",
                              .value = fmt::format("{:.0f}", 100 * closed.value),
                              .unit = "%",
                              .note = percent_range(closed.low, closed.high)});
    } else {
      part.numbers.push_back(
          {.label = "Gap closed",
           .value = "\u2013",
           .note = d.only_the_loop_holds ? "only the loop holds the wheel" : "no larger than what noise leaves"});
    }
  }
  const double after = adds_effects(d) ? d.gap.with_effect_nrmse : d.gap.refit_nrmse;
  part.numbers.push_back({.label = "Free-run error, before",
                          .value = report::in_digits(100 * d.gap.sim_nrmse, 3),
                          .unit = "%",
                          .note = "simulation as given",
                          .meaning = report::Meaning::kReference});
  const bool said = std::isfinite(after) && !d.only_the_loop_holds;
  part.numbers.push_back({.label = "Free-run error, after",
                          .value = said ? report::in_digits(100 * after, 3) : "\u2013",
                          .unit = said ? "%" : "",
                          .note = fmt::format("the noise leaves {}", percent(d.gap.floor_nrmse)),
                          .meaning = report::Meaning::kModel});
  return part;
}

report::Table probability_table(const gap::Diagnosis& d) {
  report::Table table{.title = "The whole vocabulary",
                      .caption = "Every change has a probability of its own.",
                      .columns = {{"Change", "", false}, {"Probability", "%", true, 2}, {"What it is", "", false}}};
  for (const Possibility& one : possibilities(d)) {
    std::string says = one.id == "none"         ? "the simulation already explains the record"
                       : one.id == "parameters" ? "J, B or C of the simulation are wrong"
                       : one.id == "unknown"    ? "an effect that is none of these"
                                                : std::string(find_effect(one.id).says);
    table.rows.push_back({one.name, 100 * one.probability, std::move(says)});
  }
  return table;
}

report::Table sizes_table(const gap::Diagnosis& d) {
  report::Table table{
      .title = "Before and after, on the held-out part",
      .caption =
          "Angle: rms of measured less free run, over the standard deviation of the measured angle. Torque: rms of "
          "what the model's torque balance leaves, over the applied torque's rms.",
      .columns = {{"Simulation", "", false}, {"Angle", "%", true, 3}, {"Torque", "%", true, 3}}};
  table.rows.push_back({"as given", 100 * d.gap.sim_nrmse, std::nan("")});
  table.rows.push_back({"J, B, C refitted", 100 * d.gap.refit_nrmse, 100 * d.gap.torque_refit});
  if (adds_effects(d)) {
    table.rows.push_back({d.surrogate ? "with the surrogate" : "with what is changed", 100 * d.gap.with_effect_nrmse,
                          100 * d.gap.torque_with_effect});
  }
  table.rows.push_back({"what the noise leaves", 100 * d.gap.floor_nrmse, 100 * d.gap.torque_floor});
  return table;
}

report::Table wheel_table(const DiagnosisPageInput& input) {
  const gap::Diagnosis& d = input.diagnosis;
  report::Table table{.title = "The wheel",
                      .caption = adds_effects(d) ? "J, B and C with what is changed, and their 95 % intervals."
                                                 : "J, B and C refitted, and their 95 % intervals.",
                      .columns = {{"Parameter", "", false},
                                  {"Unit", "", false},
                                  {"As given", "", true, 3},
                                  {"Refitted alone", "", true, 3},
                                  {"Found", "", true, 3},
                                  {"95 %", "", false}}};
  const auto row = [&](const char* label, const char* unit, double given, double refitted, const auto& found) {
    table.rows.push_back({label, unit, given, refitted, found.value, range(found)});
  };
  const WheelArm& given = input.given.wheel;
  const WheelArm& refit = d.refit.wheel;
  row("Inertia J", "kg m\u00b2", given.inertia_kgm2, refit.inertia_kgm2, d.base.inertia_kgm2);
  row("Damping B", "Nms/rad", given.damping_nms_per_rad, refit.damping_nms_per_rad, d.base.damping_nms_per_rad);
  row("Stiffness C", "Nm/rad", given.stiffness_nm_per_rad, refit.stiffness_nm_per_rad, d.base.stiffness_nm_per_rad);
  return table;
}

report::Table changes_table(const gap::Diagnosis& d) {
  report::Table table{.title = d.surrogate           ? "The surrogate"
                               : d.causes.size() > 1 ? "The changes"
                                                     : "The change",
                      .columns = {{"Effect", "", false},
                                  {"Change", "", false},
                                  {"Probability", "%", true, 2},
                                  {"Parameter", "", false},
                                  {"Unit", "", false},
                                  {"As given", "", true, 3},
                                  {"Found", "", true, 3},
                                  {"95 %", "", false}}};
  for (const gap::Cause& cause : d.causes) {
    const auto& known = cause.effect.type->parameters;
    const bool removed = cause.change == gap::ChangeKind::kRemove;
    for (std::size_t i = 0; i < known.size() && i < cause.effect.values.size(); ++i) {
      const bool first = i == 0;
      const double found = removed ? std::nan("") : cause.effect.values[i];
      const double was = cause.was ? cause.was->values[i] : removed ? cause.effect.values[i] : std::nan("");
      table.rows.push_back({first ? spoken(cause.effect.type->id) : std::string(),
                            first ? std::string(gap::name(cause.change)) : std::string(),
                            first ? Cell(100 * cause.probability) : Cell(std::string()), quantity_of(known[i].name),
                            unit_of(known[i].name), was, found,
                            i < cause.parameters.size() ? range(cause.parameters[i]) : std::string()});
    }
  }
  return table;
}

report::Note next_experiment(const gap::Diagnosis& d) {
  const gap::ProbeProposal& p = d.next_experiment.probe;
  report::Note note{.title = "The next experiment", .paragraphs = {d.next_experiment.why}};
  if (d.next_experiment.separates[0].empty()) return note;  // why there is none
  note.paragraphs.push_back(fmt::format(
      "Let the EPS motor play a multisine of {:.3g} Nm rms from {:g} to {:g} Hz, repeated every {:g} s, for {:g} s. It "
      "stands in "
      "diagnosis.json under next_experiment; `steerid simulate --task probe --probe diagnosis.json --sim "
      "sim_with_effect.json --out drive.csv` plays it on the simulated wheel, whose answer the real one is to be held "
      "against.",
      p.rms_nm, p.low_hz, p.high_hz, p.period_s, p.duration_s));
  return note;
}

/// With the time of a record whose stamps are dates counted from its beginning (log/reading_time.hpp).
gap::Diagnosis as_read(gap::Diagnosis d) {
  if (d.series.time_s.empty()) return d;
  const double zero_s = reading_zero_s(d.series.time_s.front());
  d.series.time_s = reading_times(std::move(d.series.time_s), zero_s);
  for (gap::GapAxis& axis : d.axes) {
    if (axis.axis != "time") continue;
    for (gap::GapBin& bin : axis.bins) {
      bin.low -= zero_s;
      bin.high -= zero_s;
    }
  }
  return d;
}

}  // namespace

report::Page diagnosis_page(const DiagnosisPageInput& input) {
  const gap::Diagnosis d = as_read(input.diagnosis);
  report::Page page{.title = "Diagnosis of " + input.record_name,
                    .subtitle = fmt::format("Measured: {}. Simulation: {}. All errors are of the part of the record "
                                            "that no fit and no choice has seen.",
                                            input.record_name, input.simulation_name)};
  page.parts.emplace_back(headline(d));
  if (!d.notes.empty()) page.parts.emplace_back(report::Note{.title = "Notes", .paragraphs = d.notes});
  const bool series = !d.series.time_s.empty();
  if (series) page.parts.emplace_back(closer_look_chart(d));
  page.parts.emplace_back(probability_chart(d));

  page.parts.emplace_back(report::Section{"Where the gap lies", d.where.says});
  add_place_charts(d, page);

  page.parts.emplace_back(report::Section{"How far it shrinks", ""});
  const bool closes = adds_effects(d) && !d.surrogate && std::isfinite(d.gap.closed_fraction.value);
  if (closes && !d.only_the_loop_holds) page.parts.emplace_back(budget_chart(d));
  page.parts.emplace_back(sizes_table(d));
  if (series) page.parts.emplace_back(residual_chart(d));
  if (!d.spectrum.frequency_hz.empty()) page.parts.emplace_back(spectrum_chart(d));

  page.parts.emplace_back(report::Section{"Parameters", ""});
  if (adds_effects(d)) page.parts.emplace_back(changes_table(d));
  page.parts.emplace_back(wheel_table(input));

  page.parts.emplace_back(report::Section{"What to do next", ""});
  if (!d.next_experiment.why.empty()) page.parts.emplace_back(next_experiment(d));
  add_other_axes(d, page);
  page.parts.emplace_back(report::Section{"Every probability", ""});
  page.parts.emplace_back(probability_table(d));
  page.footer = "steerid diagnose. How to read this page: docs/gap_diagnosis.md";
  return page;
}

}  // namespace steerid
