// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "report/identify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/uncertainty.hpp"

namespace steerid::report {
namespace {

constexpr const char* kTimeGroup = "time";
constexpr double kBand = 1.96;  // 95 % of a normal distribution

const Axis kTime{.label = "Time", .unit = "s", .log = false, .range = {}};

using Parameters = std::array<const IdentifiedParameter*, 3>;

Parameters parameters(const IdentifyReport& report) { return {&report.inertia, &report.damping, &report.stiffness}; }

Meaning meaning_of(const IdentifiedParameter& parameter) {
  if (parameter.symbol == "J") return Meaning::kInertia;
  return parameter.symbol == "B" ? Meaning::kDamping : Meaning::kStiffness;
}

bool is_known(const ParameterAnswer& answer) { return answer.state == "valid" || answer.state == "holding"; }

/// "J", "J and B", "J, B and C".
std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 == names.size() ? " and " : ", ";
    out += names[i];
  }
  return out;
}

/// What is shown as an answer: what was identified, and is not contradicted.
bool shown(const IdentifyReport& report, const ParameterAnswer& answer) {
  return report.refused.empty() && is_known(answer);
}

std::vector<std::string> known_by_batch(const IdentifyReport& report) {
  std::vector<std::string> known;
  for (const IdentifiedParameter* parameter : parameters(report)) {
    if (parameter->batch && is_known(*parameter->batch)) known.push_back(parameter->symbol);
  }
  return known;
}

std::string verdict(const IdentifyReport& report) {
  if (!report.refused.empty()) return "Not credible: " + report.refused.front() + ".";
  std::vector<std::string> known;
  std::vector<std::string> unknown;
  for (const IdentifiedParameter* parameter : parameters(report)) {
    (is_known(parameter->recursive) ? known : unknown).push_back(parameter->symbol);
  }
  std::string text;
  if (const std::vector<std::string> by_batch = known_by_batch(report); by_batch.size() > known.size()) {
    text = fmt::format("At its end the firmware identifies {}; the batch fit to the whole record identifies {}",
                       known.empty() ? "no parameter" : joined(known), joined(by_batch));
  } else if (known.empty()) {
    text = "No parameter is identified from this record";
  } else {
    text = joined(known) + (known.size() == 1 ? " is identified" : " are identified");
    if (!unknown.empty()) text += "; " + joined(unknown) + (unknown.size() == 1 ? " is" : " are") + " not";
  }
  if (report.free_run_nrmse) {
    text += fmt::format(". Run free on the record's torques, the model misses the measured {} by {} % of its spread",
                        report.angle.label == "Angle" ? "angle" : report.angle.label,
                        in_digits(100 * *report.free_run_nrmse, 3));
  } else if (!report.fit_sentence.empty()) {
    text += ". " + report.fit_sentence;
  }
  return text + ".";
}

Tone tone(const IdentifyReport& report) {
  if (!report.refused.empty()) return Tone::kBad;
  const Parameters all = parameters(report);
  const auto known = std::count_if(all.begin(), all.end(), [](const auto* p) { return is_known(p->recursive); });
  if (known == 3 && report.cautions.empty()) return Tone::kGood;
  return known == 0 && known_by_batch(report).empty() ? Tone::kBad : Tone::kCaution;
}

Headline headline(const IdentifyReport& report) {
  Headline part{verdict(report), tone(report), {}};
  for (const IdentifiedParameter* parameter : parameters(report)) {
    const bool answered = shown(report, parameter->recursive);
    const Written text =
        answered ? written(parameter->recursive.value, parameter->recursive.sd) : Written{"\u2013", ""};
    part.numbers.push_back({.label = parameter->quantity.label + " " + parameter->symbol,
                            .value = text.value,
                            .unit = parameter->quantity.unit,
                            .note = text.sd.empty() ? "" : "\u00b1 " + text.sd,
                            .state = report.refused.empty() ? parameter->recursive.state : "",
                            .meaning = meaning_of(*parameter)});
  }
  const bool swings = report.refused.empty() && report.natural_frequency_hz;
  part.numbers.push_back({.label = "Natural frequency",
                          .value = swings ? in_digits(report.natural_frequency_hz.value_or(0), 3) : "none",
                          .unit = swings ? "Hz" : "",
                          .note = swings ? "" : report.natural_frequency_reason,
                          .state = "",
                          .meaning = {}});
  if (report.damping_ratio && report.refused.empty()) {
    part.numbers.push_back({"Damping ratio", in_digits(*report.damping_ratio, 3), "", "", "", {}});
  }
  if (report.amplitude) {
    part.numbers.push_back({"Amplitude fit",
                            in_digits(report.amplitude->fit_percent, 3),
                            "%",
                            fmt::format("up to {} Hz", in_digits(report.amplitude->limit_hz, 1)),
                            "",
                            {}});
  }
  return part;
}

/// A value that was not identified is the prior: a reader would take it for a result.
Cell shown_cell(const ParameterAnswer& answer) {
  if (!is_known(answer)) return std::nan("");
  return with_sd(answer.value, answer.sd);
}

Table answers(const IdentifyReport& report) {
  const Parameters all = parameters(report);
  const bool batch = std::any_of(all.begin(), all.end(), [](const auto* p) { return p->batch.has_value(); });
  const bool published = std::any_of(all.begin(), all.end(), [](const auto* p) { return p->published.has_value(); });
  Table part{.title = "Parameters",
             .caption = "Value \u00b1 one standard deviation. The recursive value is the one at the end of the record.",
             .columns = {{"Parameter", "", false, 4},
                         {"Unit", "", false, 4},
                         {"Recursive", "", true, 4},
                         {"State", "", false, 4}},
             .rows = {}};
  if (batch) part.columns.push_back({"Batch", "", true, 4});
  if (batch) part.columns.push_back({"Batch state", "", false, 4});
  if (published) part.columns.push_back({"Published", "", true, 4});
  for (const IdentifiedParameter* p : all) {
    std::vector<Cell> row = {p->quantity.label + " " + p->symbol, p->quantity.unit, shown_cell(p->recursive),
                             Badge{p->recursive.state}};
    if (batch) row.emplace_back(p->batch ? shown_cell(*p->batch) : Cell{std::nan("")});
    if (batch) row.emplace_back(p->batch ? Cell{Badge{p->batch->state}} : Cell{std::nan("")});
    if (published) row.emplace_back(p->published ? Cell{in_digits(*p->published)} : Cell{std::nan("")});
    part.rows.push_back(std::move(row));
  }
  return part;
}

LineChart time_chart(std::string title, const Quantity& quantity) {
  return {.title = std::move(title),
          .caption = "",
          .x = kTime,
          .y = {quantity.label, quantity.unit, false, {}},
          .series = {},
          .group = kTimeGroup};
}

void add_record(const IdentifyReport& report, Page& page) {
  page.parts.emplace_back(Section{"The record", "Zoom with the slider; all charts over time follow."});
  LineChart angle = time_chart("Measured " + report.angle.label, report.angle);
  angle.title = report.angle.label;
  angle.series.push_back({"measured", Meaning::kMeasured, report.time_s, report.angle_rad});
  LineChart torque = time_chart(report.torque.label, report.torque);
  if (!report.torque_driver_nm.empty()) {
    torque.series.push_back({"driver", Meaning::kTorqueDriver, report.time_s, report.torque_driver_nm});
  }
  if (!report.torque_motor_nm.empty()) {
    torque.series.push_back({"motor", Meaning::kTorqueMotor, report.time_s, report.torque_motor_nm});
  }
  if (!report.torque_bar_nm.empty()) {
    torque.series.push_back({"torsion bar", Meaning::kMeasured, report.time_s, report.torque_bar_nm});
  }
  if (!report.torque_rim_nm.empty()) {
    torque.series.push_back({"rim", Meaning::kTorqueRim, report.time_s, report.torque_rim_nm});
  }
  page.parts.emplace_back(std::move(angle));
  page.parts.emplace_back(std::move(torque));
}

/// The range of a parameter's axis: what is valid or holding, with its band, and the answers beside it. The first
/// seconds, when the band is as wide as the prior, would otherwise press everything that matters into one line.
std::array<double, 2> settled_range(const std::vector<double>& time_s, const IdentifiedParameter& parameter) {
  double low = parameter.recursive.value;
  double high = low;
  const auto include = [&](double value, double sd) {
    const double reach = std::isfinite(sd) ? kBand * sd : 0;
    if (!std::isfinite(value)) return;
    low = std::min(low, value - reach);
    high = std::max(high, value + reach);
  };
  if (parameter.batch) include(parameter.batch->value, parameter.batch->sd);
  if (parameter.published) include(*parameter.published, 0);
  const ParameterTrace& trace = parameter.trace;
  for (const StateSpan& span : trace.states) {
    if (span.state != "valid" && span.state != "holding") continue;
    const auto from = std::lower_bound(time_s.begin(), time_s.end(), span.from) - time_s.begin();
    const auto to = std::upper_bound(time_s.begin(), time_s.end(), span.to) - time_s.begin();
    for (auto i = static_cast<std::size_t>(from); i < static_cast<std::size_t>(to); ++i) {
      include(trace.value[i], trace.sd[i]);
    }
  }
  for (std::size_t i = 0; i < parameter.smoothed.value.size(); ++i) {
    include(parameter.smoothed.value[i], parameter.smoothed.sd[i]);
  }
  const double margin = high > low ? 0.15 * (high - low) : std::max(1e-9, 0.5 * std::abs(high));
  return {low - margin, high + margin};
}

void add_parameters(const IdentifyReport& report, Page& page) {
  page.parts.emplace_back(
      Section{"The parameters over time",
              "Each with its 95 % band and, below it, its state. The height shows the range in which it is valid "
              "or holding; while a parameter is still being learned its band may leave it."});
  for (const IdentifiedParameter* parameter : parameters(report)) {
    LineChart chart = time_chart(parameter->quantity.label + " " + parameter->symbol, parameter->quantity);
    chart.y.range = settled_range(report.trace_time_s, *parameter);
    chart.height_px = 220;
    const ParameterTrace& trace = parameter->trace;
    chart.series.push_back(
        {"recursive " + parameter->symbol, meaning_of(*parameter), report.trace_time_s, trace.value, trace.sd});
    chart.states = trace.states;
    const SmoothedCourse& smoothed = parameter->smoothed;
    if (!smoothed.time_s.empty()) {
      chart.series.push_back({"batch " + parameter->symbol, Meaning::kModel, smoothed.time_s, smoothed.value,
                              smoothed.sd, Drawn::kDashed});
    } else if (parameter->batch) {
      chart.marks.push_back({Mark::Along::kY, parameter->batch->value, "batch", meaning_of(*parameter)});
    }
    if (parameter->published) {
      chart.marks.push_back({Mark::Along::kY, *parameter->published, "published", Meaning::kReference});
    }
    page.parts.emplace_back(std::move(chart));
  }
}

void add_driver(const IdentifyReport& report, Page& page) {
  if (report.driver.empty()) return;
  constexpr std::size_t kRowsShown = 30;
  page.parts.emplace_back(Section{"The driver", "What the loop told of the driver while it ran."});
  LineChart chart = time_chart("State of the driver, beside the stiffness that decides it", report.stiffness.quantity);
  chart.y.range = settled_range(report.trace_time_s, report.stiffness);
  chart.height_px = 180;
  chart.series.push_back({"recursive C", Meaning::kStiffness, report.trace_time_s, report.stiffness.trace.value});
  Table table{
      .title = "States in their order",
      .caption = "",
      .columns = {{"From", "s", true, 5}, {"To", "s", true, 5}, {"State", "", false, 4}, {"Hands", "", false, 4}},
      .rows = {}};
  for (const DriverSpan& span : report.driver) {
    chart.states.push_back({span.from, span.to, span.state});
    if (table.rows.size() < kRowsShown) {
      table.rows.push_back(
          {fmt::format("{:.2f}", span.from), fmt::format("{:.2f}", span.to), Badge{span.state}, span.hands});
    }
  }
  if (report.driver.size() > kRowsShown) {
    table.caption = fmt::format("The first {} of {}; the answer of --json has all.", kRowsShown, report.driver.size());
  }
  page.parts.emplace_back(std::move(chart));
  page.parts.emplace_back(std::move(table));
}

void add_free_run(const IdentifyReport& report, Page& page) {
  if (report.free_run_angle_rad.empty()) return;
  page.parts.emplace_back(
      Section{"The model run free", "The model gets the record's torques and its own past, never the measurement."});
  LineChart both = time_chart(report.angle.label + ", measured and free run", report.angle);
  if (report.free_run_nrmse) {
    both.caption = fmt::format("The residual's rms is {} % of the measured signal's standard deviation.",
                               in_digits(100 * *report.free_run_nrmse, 3));
  }
  both.series = {{"measured", Meaning::kMeasured, report.time_s, report.angle_rad},
                 {"model", Meaning::kModel, report.time_s, report.free_run_angle_rad, {}, Drawn::kDashed}};
  std::vector<double> residual(report.time_s.size());
  for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = report.angle_rad[i] - report.free_run_angle_rad[i];
  LineChart left = time_chart("Residual, measured less free run", report.angle);
  left.height_px = 180;
  left.series = {{"residual", Meaning::kResidual, report.time_s, std::move(residual)}};
  page.parts.emplace_back(std::move(both));
  page.parts.emplace_back(std::move(left));
}

void add_amplitude(const IdentifyReport& report, Page& page) {
  if (!report.amplitude) return;
  const AmplitudeCurves& curves = *report.amplitude;
  page.parts.emplace_back(Section{"The amplitude curve", ""});
  page.parts.emplace_back(LineChart{
      .title = "Amplitude over frequency",
      .caption =
          fmt::format("The model's amplitudes fit the measured ones to {} % up to {} Hz (the comparison of figure 7 "
                      "of Lv et al. 2018).",
                      in_digits(curves.fit_percent, 3), in_digits(curves.limit_hz, 1)),
      .x = {"Frequency", "Hz", false, std::array{0.0, curves.limit_hz}},
      .y = {report.angle.label + " amplitude", report.angle.unit, false, {}},
      .series = {{"measured", Meaning::kMeasured, curves.frequency_hz, curves.measured},
                 {"model", Meaning::kModel, curves.frequency_hz, curves.model, {}, Drawn::kDashed}}});
}

}  // namespace

Page identify_page(const IdentifyReport& report) {
  Page page{.title = "Identification of " + report.record_name, .subtitle = report.subtitle, .parts = {}};
  page.parts.emplace_back(headline(report));
  page.parts.emplace_back(answers(report));
  if (report.refused.size() > 1) {
    page.parts.emplace_back(Note{"Not credible", report.refused, Tone::kBad});
  }
  if (!report.cautions.empty()) page.parts.emplace_back(Note{"With caution", report.cautions, Tone::kCaution});
  for (const Note& note : report.notes) page.parts.emplace_back(note);
  add_record(report, page);
  add_parameters(report, page);
  add_driver(report, page);
  add_free_run(report, page);
  add_amplitude(report, page);
  return page;
}

}  // namespace steerid::report
