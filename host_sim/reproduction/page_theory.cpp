// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the excitation can show, and the convergence theory, measured.
#include <algorithm>
#include <cmath>

#include "reproduction/conclusions.hpp"
#include "reproduction/page_parts.hpp"

namespace steerid::page {
namespace {

constexpr std::array kSymbols{"J", "B", "C"};
constexpr std::array kMeanings{report::Meaning::kInertia, report::Meaning::kDamping, report::Meaning::kStiffness};

report::LineChart bound_chart(const ExcitationRow& row) {
  report::LineChart chart{
      .title = fmt::format("{}, {}", spoken(row.task, row.hands),
                           row.performed == Performed::kToTheLetter ? "task to the letter" : "by a driver"),
      .x = {"probe", "Nm rms"},
      .y = {"least relative sd", "", true}};
  chart.marks = {{report::Mark::Along::kY, kVisible, "10 %: visible"}};
  chart.height_px = 220;
  for (std::size_t i = 0; i < 3; ++i) {
    report::Series series{.name = kSymbols[i], .meaning = kMeanings[i], .x = row.probe_rms_nm};
    for (const auto& sd : row.relative_sd) series.y.push_back(std::min(sd[i], 100.0));
    chart.series.push_back(series);
  }
  return chart;
}

std::string bound_text(double relative) {
  return relative > 1 ? "unexcited" : fmt::format("{:.2g}\u00a0%", 100 * relative);
}

report::Table bound_table(const ExperimentResults& results) {
  report::Table out;
  out.title = "Least standard deviation that any unbiased estimate of a record can have";
  out.caption =
      "Cramer-Rao, nominal arms. Dark: more than the parameter itself. Last column: the probe from which J is visible, "
      "that is known to 10 %.";
  out.columns = {words("task"), words("J without probe"), words("B"), words("C"), words("J with 0.5 Nm"), words("B"),
                 words("C"),    words("J visible from")};
  for (const ExcitationRow& row : results.excitation) {
    const auto half = std::find(row.probe_rms_nm.begin(), row.probe_rms_nm.end(), 0.5) - row.probe_rms_nm.begin();
    const auto& plain = row.relative_sd.front();
    const auto& probed = row.relative_sd[static_cast<std::size_t>(half)];
    const std::optional<double> least = row.least_probe_nm[0];
    out.rows.push_back({fmt::format("{}, {}", spoken(row.task, row.hands),
                                    row.performed == Performed::kToTheLetter ? "to the letter" : "by a driver"),
                        bound_text(plain[0]), bound_text(plain[1]), bound_text(plain[2]), bound_text(probed[0]),
                        bound_text(probed[1]), bound_text(probed[2]),
                        !least        ? std::string("no probe")
                        : *least == 0 ? std::string("without")
                                      : fmt::format("{:.1f} mNm rms", 1e3 * *least)});
  }
  return out;
}

/// Measured error of J over the probe's strength, the bound beside it.
report::LineChart sweep_chart(const ExperimentResults& results, TaskKind task) {
  report::LineChart chart{.title = fmt::format("Error of J against the probe, {} task, measured", name(task)),
                          .caption = "Root mean square over ten subjects at 3 o'clock, valid or not.",
                          .x = {"probe", "Nm rms"},
                          .y = {"relative error of J", "", true}};
  chart.marks = {{report::Mark::Along::kY, kVisible, "10 %: visible"}};
  chart.height_px = 220;
  report::Series batch{.name = "batch", .meaning = report::Meaning::kModel};
  report::Series firmware{.name = "firmware", .meaning = report::Meaning::kMeasured};
  for (const SweepPoint& point : results.sweep) {
    if (point.task != task) continue;
    batch.x.push_back(point.probe_rms_nm);
    batch.y.push_back(point.batch.rms[0]);
    firmware.x.push_back(point.probe_rms_nm);
    firmware.y.push_back(point.recursive.rms[0]);
  }
  chart.series = {batch, firmware};
  for (const ExcitationRow& row : results.excitation) {
    if (row.performed != Performed::kByADriver || row.task != task || row.hands != HandPosition::kRight3) continue;
    report::Series bound{
        .name = "bound, nominal arm", .meaning = report::Meaning::kReference, .drawn = report::Drawn::kDashed};
    for (std::size_t i = 0; i < row.probe_rms_nm.size() && row.probe_rms_nm[i] <= kSweptProbes_nm.back(); ++i) {
      bound.x.push_back(row.probe_rms_nm[i]);
      bound.y.push_back(row.relative_sd[i][0]);
    }
    chart.series.push_back(bound);
  }
  return chart;
}

report::Table error_table(const ExperimentResults& results) {
  report::Table out;
  out.title = "What was measured: errors against the true arms";
  out.caption =
      "Sixty records a row. Bias and rms error of all answers, valid or not; share called valid; share of the valid "
      "answers whose 95 % interval holds the truth.";
  out.columns = {words("records, method")};
  for (const char* symbol : kSymbols) {
    out.columns.push_back(numbers(fmt::format("{} bias", symbol), "%", 2));
    out.columns.push_back(numbers("rms", "%", 2));
    out.columns.push_back(numbers("valid", "%", 3));
    out.columns.push_back(numbers("covered", "%", 3));
  }
  for (const ErrorRow& row : error_rows(results.run)) {
    std::vector<report::Cell> cells{
        fmt::format("{}{}, {}", name(row.task), row.probed ? " with probe" : "", row.batch ? "batch" : "firmware")};
    const MeasuredErrors& errors = row.errors;
    for (std::size_t i = 0; i < 3; ++i) {
      cells.insert(cells.end(), {100 * errors.bias[i], 100 * errors.rms[i], 100 * errors.valid_share[i],
                                 errors.valid_share[i] > 0 ? 100 * errors.covered[i] : kNothing});
    }
    out.rows.push_back(std::move(cells));
  }
  return out;
}

report::Scatter factor_chart(const ExperimentResults& results) {
  report::Scatter chart{.title = "Convergence factor: measured against ||[J'J]\u207b\u00b9 H||",
                        .caption =
                            "Equation 27, in the norm of J'J. The factor by which a step of unit length shrinks "
                            "the distance to the minimum.",
                        .x = {"predicted", "", true},
                        .y = {"measured", "", true}};
  chart.identity = true;
  report::Cloud cloud{.name = "records", .meaning = report::Meaning::kMeasured};
  for (const ConvergenceCase& one : results.convergence) {
    cloud.x.push_back(one.predicted_factor);
    cloud.y.push_back(one.measured_factor);
    cloud.labels.push_back(one.name);
  }
  chart.clouds = {cloud};
  return chart;
}

report::Table factor_table(const ExperimentResults& results) {
  report::Table out;
  out.title = "Factors, orders and directions";
  out.caption =
      "Two poor starts each: J three times, B and C a third; J a third, B three times, C twice. Order: 2 where H "
      "vanishes, 1 where it does not. Least cosine: between step and steepest descent, the quantity that theorem 1 "
      "keeps away from zero (equation 20).";
  out.columns = {words("record"),
                 numbers("predicted factor", "", 3),
                 numbers("measured", "", 3),
                 words("steps, first start"),
                 words("steps, second start"),
                 numbers("order", "", 2),
                 numbers("least cosine", "", 2)};
  for (const ConvergenceCase& one : results.convergence) {
    std::vector<report::Cell> row{one.name, one.predicted_factor, one.measured_factor};
    double cosine = 1;
    for (const ConvergenceTrace& trace : one.traces) {
      const auto there = std::find_if(trace.distance.begin(), trace.distance.end(), [](double d) { return d < 1e-3; });
      row.emplace_back(trace.reached ? fmt::format("{}", there - trace.distance.begin()) : std::string("not reached"));
      for (const double c : trace.cosine) cosine = std::min(cosine, c);
    }
    row.insert(row.end(), {order_of(one.traces.front()).value_or(kNothing), cosine});
    out.rows.push_back(std::move(row));
  }
  return out;
}

report::LineChart trace_chart(const ExperimentResults& results) {
  report::LineChart chart{.title = "Distance to the minimum, step by step",
                          .caption =
                              "From J three times, B and C a third of the minimum's. Straight lines are linear "
                              "convergence, their slope the factor; a line that bends down is quadratic.",
                          .x = {"step", ""},
                          .y = {"relative distance", "", true}};
  constexpr std::array kLook{report::Meaning::kModel,        report::Meaning::kInertia,
                             report::Meaning::kDamping,      report::Meaning::kStiffness,
                             report::Meaning::kTorqueDriver, report::Meaning::kTorqueMotor};
  for (std::size_t i = 0; i < results.convergence.size(); ++i) {
    const ConvergenceTrace& trace = results.convergence[i].traces.front();
    report::Series series{.name = results.convergence[i].name, .meaning = kLook[i % kLook.size()]};
    for (std::size_t k = 0; k < trace.distance.size(); ++k) {
      series.x.push_back(static_cast<double>(k));
      series.y.push_back(trace.distance[k] > 1e-12 ? trace.distance[k] : kNothing);
    }
    chart.series.push_back(series);
  }
  return chart;
}

report::Heatmap basin_map(const Basin& basin, const std::vector<std::vector<double>>& steps, const std::string& title,
                          double share) {
  report::Heatmap map{
      .title = title,
      .caption = fmt::format("{} of the starts reach the minimum, J {:.3f} kg m\u00b2 and C {:.2f} Nm/rad; the "
                             "others are blank. Active task with the probe, 20 s.",
                             percent(share, 0), basin.minimum.inertia_kgm2, basin.minimum.stiffness_nm_per_rad),
      .x_label = "J at the start, kg m\u00b2",
      .y_label = "C at the start, Nm/rad"};
  for (const double j : basin.inertia_kgm2) map.columns.push_back(fmt::format("{:.2g}", j));
  for (const double c : basin.stiffness_nm_per_rad) map.rows.push_back(fmt::format("{:.3g}", c));
  map.values = steps;
  std::reverse(map.rows.begin(), map.rows.end());  // the stiffest on top
  std::reverse(map.values.begin(), map.values.end());
  map.value = {.label = "steps"};
  map.digits = 2;
  return map;
}

report::Table rank_table(const ExperimentResults& results) {
  report::Table out;
  out.title = "Full rank, equation 17";
  out.caption =
      "Directions of J, B and C that a record shows to a quarter of their value, and gamma: the smallest singular "
      "value "
      "of the Jacobian per relative change, over the noise (1/gamma is the relative standard deviation along the "
      "darkest "
      "direction).";
  out.columns = {words("record"), numbers("rank", "", 1), numbers("gamma", "", 3), words("what is unexcited")};
  for (const RankCase& one : results.ranks) {
    out.rows.push_back({one.name, static_cast<double>(one.rank), one.gamma, one.says});
  }
  return out;
}

}  // namespace

void add_excitation(report::Page& page, const ExperimentResults& results) {
  std::string lead =
      "A steady sine fixes two numbers, C \u2212 J\u03c9\u00b2 and B\u03c9: J and C are not separately visible in "
      "it.";
  for (const ExcitationRow& row : results.excitation) {
    const bool shown = row.performed == Performed::kToTheLetter && row.hands == HandPosition::kRight3;
    if (shown) lead += " " + on_excitation(row);
  }
  page.parts.push_back(report::Section{"What the paper's own excitation can show", lead});
  for (const Performed performed : {Performed::kToTheLetter, Performed::kByADriver}) {
    for (const ExcitationRow& row : results.excitation) {
      if (row.performed == performed && row.hands == HandPosition::kRight3) page.parts.push_back(bound_chart(row));
    }
  }
  page.parts.push_back(bound_table(results));
  for (const TaskKind task : kSteeringTasks) page.parts.push_back(sweep_chart(results, task));
  page.parts.push_back(error_table(results));
  page.parts.push_back(report::Note{
      "How to read the two tables together",
      {"The bound takes the torque for known, and so does a fit of the angle: noise on the measured torque biases J "
       "and B, and neither states it.",
       fmt::format("Without a probe: {}. With {} Nm rms: {}.", on_parameters(batch_errors(results.run.plain)),
                   results.run.settings.probe_rms_nm, on_parameters(batch_errors(results.run.probed)))},
      report::Tone::kCaution});
}

void add_convergence(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{
      "The convergence theory, measured",
      "Theorem 1 and equations 21 to 28 of the paper, on records of this experiment with equal weights, as the paper "
      "has them."});
  page.parts.push_back(factor_chart(results));
  page.parts.push_back(factor_table(results));
  page.parts.push_back(trace_chart(results));
  const Basin& basin = results.basin;
  page.parts.push_back(basin_map(basin, basin.unit_steps, "Basin of convergence, steps of unit length (equation 12)",
                                 basin.unit_share()));
  page.parts.push_back(basin_map(basin, basin.line_search, "Basin of convergence, line search (equation 15)",
                                 basin.line_search_share()));
  page.parts.push_back(report::Note{
      "Why theorem 1 does not promise more",
      {"It says that J'r tends to zero, not that the minimum is the right one: an iteration may end in another "
       "stationary point or leave J > 0.",
       on_basin(basin.unit_share(), basin.line_search_share()),
       "The batch fit takes its starts from least squares on filtered signals."}});
  page.parts.push_back(rank_table(results));
}

}  // namespace steerid::page
