// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/diagnosis_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "apps/diagnosis_words.hpp"
#include "apps/possibilities.hpp"
#include "report/uncertainty.hpp"

namespace steerid {
namespace {

using report::Meaning;

constexpr double kCloserLookS = 8;

const report::Axis kTime{.label = "Time", .unit = "s"};
const report::Axis kAngle{.label = "Angle", .unit = "rad"};

/// What the causes are called in a legend.
std::string after_name(const gap::Diagnosis& d) {
  if (d.causes.empty()) return "J, B, C refitted";
  std::vector<std::string> ids;
  for (const gap::Cause& cause : d.causes) ids.push_back(spoken(cause.effect.type->id));
  return "with " + joined(ids, "and");
}

const std::vector<double>& after(const gap::Diagnosis& d) {
  return d.causes.empty() ? d.series.refit_rad : d.series.with_effect_rad;
}

/// Of a simulation that has left the motion by more nothing else can be seen beside it: twice the motion's swing, rad.
double in_sight_rad(const gap::GapSeries& s) {
  constexpr double kSwings = 2;
  if (s.measured_rad.empty()) return 0;
  const auto [low, high] = std::ranges::minmax(s.measured_rad);
  return kSwings * (high - low);
}

/// First and last sample of the stretch of kCloserLookS in which the simulation errs most, held out if there is such a
/// stretch; the first of those in which it is out of sight.
std::pair<std::size_t, std::size_t> worst_stretch(const gap::GapSeries& s) {
  const double reach = in_sight_rad(s);
  const std::size_t n = s.time_s.size();
  double worst = -1;
  std::pair<std::size_t, std::size_t> found{0, n};
  std::size_t end = 0;
  std::vector<double> sum(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double miss = std::clamp(s.measured_rad[i] - s.sim_rad[i], -reach, reach);
    const bool counts = std::isfinite(miss) && (s.held_out.empty() || s.held_out[i] != 0);
    sum[i + 1] = sum[i] + (counts ? miss * miss : 0);
  }
  for (std::size_t begin = 0; begin < n; ++begin) {
    while (end < n && s.time_s[end] - s.time_s[begin] < kCloserLookS) ++end;
    if (sum[end] - sum[begin] > worst) {
      worst = sum[end] - sum[begin];
      found = {begin, end};
    }
    if (end == n) break;
  }
  return found;
}

std::vector<double> part(const std::vector<double>& values, std::pair<std::size_t, std::size_t> range) {
  return {values.begin() + static_cast<std::ptrdiff_t>(range.first),
          values.begin() + static_cast<std::ptrdiff_t>(range.second)};
}

/// The stretches of the record that are held out.
std::vector<report::Region> held_out(const gap::GapSeries& s) {
  std::vector<report::Region> regions;
  for (std::size_t i = 0; i < s.held_out.size(); ++i) {
    if (s.held_out[i] == 0) continue;
    if (i == 0 || s.held_out[i - 1] == 0) regions.push_back({s.time_s[i], s.time_s[i], ""});
    regions.back().to = s.time_s[i];
  }
  if (!regions.empty()) regions.front().label = "held out";
  return regions;
}

/// The finite ends of an axis' bins.
std::vector<double> edges_of(const gap::GapAxis& axis) {
  std::vector<double> edges;
  for (const gap::GapBin& bin : axis.bins) {
    for (const double end : {bin.low, bin.high}) {
      if (std::isfinite(end)) edges.push_back(end);
    }
  }
  return edges;
}

std::string bin_label(const gap::GapAxis& axis, std::size_t i, int decimals) {
  if (i < axis.bin_names.size()) return spoken(axis.bin_names[i]);
  const gap::GapBin& bin = axis.bins[i];
  const auto edge = [&](double value) { return report::in_decimals(value, decimals); };
  if (!std::isfinite(bin.high)) return "above " + edge(bin.low);
  if (!std::isfinite(bin.low)) return "below " + edge(bin.high);
  return fmt::format("{} to {}", edge(bin.low), edge(bin.high));
}

std::string axis_title(const gap::GapAxis& axis) {
  if (axis.axis == "velocity") return "By velocity";
  if (axis.axis == "position") return "By angle";
  if (axis.axis == "reversal") return "By time since the last reversal";
  return "By " + spoken(axis.axis);
}

report::Bars axis_chart(const gap::GapAxis& axis) {
  report::Bars chart{.title = axis_title(axis) + (axis.unit.empty() ? "" : ", " + axis.unit),
                     .value = {.label = "Share of the gap", .unit = "%"}};
  report::BarSeries share{.name = "gap", .meaning = Meaning::kModel};
  report::BarSeries noise{.name = "what the noise alone would hold", .meaning = Meaning::kReference};
  const int decimals = report::decimals_apart(edges_of(axis));
  for (std::size_t i = 0; i < axis.bins.size(); ++i) {
    chart.categories.push_back(bin_label(axis, i, decimals));
    share.values.push_back(100 * axis.bins[i].share.value);
    share.low.push_back(100 * axis.bins[i].share.low);
    share.high.push_back(100 * axis.bins[i].share.high);
    noise.values.push_back(100 * axis.bins[i].expected_share);
  }
  chart.series = {std::move(share), std::move(noise)};
  return chart;
}

std::vector<std::string> middles(const std::vector<double>& edges) {
  std::vector<double> values;
  for (std::size_t i = 1; i < edges.size(); ++i) values.push_back((edges[i - 1] + edges[i]) / 2);
  const int decimals = report::decimals_apart(values);
  std::vector<std::string> text;
  text.reserve(values.size());
  for (const double value : values) text.push_back(report::in_decimals(value, decimals));
  return text;
}

report::Heatmap map_chart(const gap::AngleVelocityMap& map, const std::vector<double>& torque_nm, std::string title,
                          std::array<double, 2> range) {
  report::Heatmap chart{.title = std::move(title),
                        .x_label = "Angle in rad",
                        .y_label = "Rate in rad/s",
                        .value = {.label = "Residual torque", .unit = "Nm", .range = range},
                        .diverging = true,
                        .digits = 2};
  chart.columns = middles(map.angle_edges_rad);
  const std::vector<std::string> rates = middles(map.rate_edges_rad_s);
  const std::size_t columns = chart.columns.size();
  for (std::size_t r = rates.size(); r-- > 0;) {  // the fastest on top
    chart.rows.push_back(rates[r]);
    const auto first = torque_nm.begin() + static_cast<std::ptrdiff_t>(r * columns);
    chart.values.emplace_back(first, first + static_cast<std::ptrdiff_t>(columns));
  }
  return chart;
}

void add_maps(const gap::Diagnosis& d, report::Page& page) {
  const gap::AngleVelocityMap& map = d.map;
  if (map.angle_edges_rad.size() < 2 || map.rate_edges_rad_s.size() < 2) return;
  double most = 0;
  for (const double torque : map.mean_torque_nm) most = std::max(most, std::isfinite(torque) ? std::abs(torque) : 0);
  if (most == 0) return;
  report::Heatmap before =
      map_chart(map, map.mean_torque_nm, "Residual torque over angle and rate, before", {-most, most});
  before.caption =
      "Mean of what the refitted linear wheel leaves: two levels split at rate zero are dry friction, a curve "
      "along the angle is the spring's.";
  page.parts.emplace_back(std::move(before));
  if (!d.causes.empty()) {
    page.parts.emplace_back(map_chart(map, map.mean_torque_after_nm,
                                      fmt::format("The same {}, same colours", after_name(d)), {-most, most}));
  }
}

/// The picture ends where a simulation is out of sight, and says so. `zero_rad`: where the chart has the motion's
/// middle; as measured if absent.
void keep_in_sight(const gap::GapSeries& s, std::optional<double> zero_rad, report::LineChart& chart) {
  const double reach = in_sight_rad(s);
  if (!(reach > 0)) return;
  const auto [low, high] = std::ranges::minmax(s.measured_rad);
  const double middle = zero_rad.value_or((low + high) / 2);
  double farthest = 0;
  for (const report::Series& series : chart.series) {
    for (const double value : series.y) {
      if (std::isfinite(value)) farthest = std::max(farthest, std::abs(value - middle));
    }
  }
  if (!(farthest > reach)) return;
  chart.y.range = {middle - reach, middle + reach};
  chart.caption +=
      fmt::format(" A simulation leaves the picture: it is as far as {} rad away.", report::in_digits(farthest, 2));
}

}  // namespace

report::LineChart closer_look_chart(const gap::Diagnosis& d) {
  const gap::GapSeries& s = d.series;
  const auto range = worst_stretch(s);
  const std::vector<double> time = part(s.time_s, range);
  report::LineChart chart{.title = "Measured and simulated",
                          .caption = "The stretch of the unseen part in which the simulation as given errs most.",
                          .x = kTime,
                          .y = kAngle,
                          .height_px = 320};
  chart.series = {{"measured", Meaning::kMeasured, time, part(s.measured_rad, range)},
                  {"simulation as given", Meaning::kPlain, time, part(s.sim_rad, range)},
                  {after_name(d), Meaning::kModel, time, part(after(d), range), {}, report::Drawn::kDashed}};
  keep_in_sight(s, std::nullopt, chart);
  return chart;
}

report::Bars probability_chart(const gap::Diagnosis& d) {
  constexpr std::size_t kFewest = 3;
  constexpr std::size_t kMost = 6;
  constexpr double kWorthABar = 0.005;
  report::Bars chart{.title = "How sure each change is",
                     .value = {.label = "Probability", .unit = "%", .range = std::array{0.0, 100.0}}};
  report::BarSeries bars{.name = "probability", .meaning = Meaning::kModel};
  const std::vector<Possibility> all = possibilities(d);
  for (std::size_t i = 0; i < std::min(std::max(kMost, d.causes.size() + 1), all.size()); ++i) {
    if (i >= kFewest && all[i].probability < kWorthABar) break;
    chart.categories.push_back(all[i].name);
    bars.values.push_back(100 * all[i].probability);
  }
  chart.series = {std::move(bars)};
  if (names_several(d)) chart.caption = "Several changes can be so at once: each bar is a probability of its own.";
  if (!d.equivalent.empty()) {
    chart.caption = d.verdict == "unknown" ? fmt::format("Nor does this record rule out {}.", enumerated(d.equivalent))
                                           : fmt::format("This record cannot tell {} from {}.", spoken(d.verdict),
                                                         enumerated(d.equivalent));
  }
  return chart;
}

report::Bars budget_chart(const gap::Diagnosis& d) {
  report::Bars chart{.title = "The budget of the gap",
                     .caption =
                         "The gap is what J, B and C alone leave above the noise, on the held-out part. What "
                         "each change closes is the mean over the orders in which they can be made.",
                     .value = {.label = "Share of the gap", .unit = "%"}};
  report::BarSeries closes{.name = "share", .meaning = Meaning::kModel};
  for (const gap::Cause& cause : d.causes) {
    chart.categories.push_back(spoken(cause.effect.type->id));
    closes.values.push_back(100 * cause.closes);
  }
  chart.categories.emplace_back("what is left");
  closes.values.push_back(100 * d.unexplained.share_of_gap);
  chart.series = {std::move(closes)};
  return chart;
}

void add_place_charts(const gap::Diagnosis& d, report::Page& page) {
  if (!d.axes.empty() && !d.axes.front().bins.empty()) {
    report::Bars best = axis_chart(d.axes.front());
    best.caption = "The axis that concentrates the gap most. Whiskers: 95 % intervals by bootstrap of blocks.";
    page.parts.emplace_back(std::move(best));
  }
  add_maps(d, page);
}

void add_other_axes(const gap::Diagnosis& d, report::Page& page) {
  if (d.axes.size() < 2) return;
  page.parts.emplace_back(report::Section{"The gap along the other axes", "The most telling ones first."});
  for (std::size_t i = 1; i < d.axes.size(); ++i) {
    if (!d.axes[i].bins.empty()) page.parts.emplace_back(axis_chart(d.axes[i]));
  }
}

report::LineChart residual_chart(const gap::Diagnosis& d) {
  const gap::GapSeries& s = d.series;
  const auto misses = [&](const std::vector<double>& simulated) {
    std::vector<double> out(s.time_s.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = s.measured_rad[i] - simulated[i];
    return out;
  };
  report::LineChart chart{.title = "Measured less simulated",
                          .caption = "Shaded: held out.",
                          .x = kTime,
                          .y = kAngle,
                          .regions = held_out(s)};
  chart.series = {{"simulation as given", Meaning::kPlain, s.time_s, misses(s.sim_rad)},
                  {"J, B, C refitted", Meaning::kReference, s.time_s, misses(s.refit_rad)}};
  if (!d.causes.empty()) chart.series.push_back({after_name(d), Meaning::kModel, s.time_s, misses(s.with_effect_rad)});
  keep_in_sight(s, 0, chart);
  return chart;
}

report::LineChart spectrum_chart(const gap::Diagnosis& d) {
  const auto in_mrad2 = [](std::vector<double> density) {
    for (double& value : density) value *= 1e6;
    return density;
  };
  const gap::ResidualSpectrum& s = d.spectrum;
  report::LineChart chart{.title = "Spectrum of what is left",
                          .x = {.label = "Frequency", .unit = "Hz", .log = true},
                          .y = {.label = "Power density", .unit = "mrad\u00b2/Hz", .log = true}};
  chart.series = {{"J, B, C refitted", Meaning::kReference, s.frequency_hz, in_mrad2(s.refit_rad2_per_hz)}};
  if (!d.causes.empty())
    chart.series.push_back({after_name(d), Meaning::kModel, s.frequency_hz, in_mrad2(s.with_effect_rad2_per_hz)});
  chart.series.push_back(
      {"noise alone", Meaning::kMeasured, s.frequency_hz, in_mrad2(s.noise_rad2_per_hz), {}, report::Drawn::kDashed});
  return chart;
}

}  // namespace steerid
