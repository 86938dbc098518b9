// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/fleet_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fleet/summary_tables.hpp"

namespace steerid {
namespace {

using report::Meaning;

constexpr std::size_t kBars = 20;
constexpr std::size_t kBins = 24;
constexpr std::size_t kCharts = 6;  // of sizes, and of drifts; the tables have all
constexpr double kDaysAYear = 365.25;
constexpr double kEpochYear = 1970;

const std::map<std::string, Meaning>& meanings() {
  static const std::map<std::string, Meaning> kAll = {{"inertia_kgm2", Meaning::kInertia},
                                                      {"damping_nms_per_rad", Meaning::kDamping},
                                                      {"stiffness_nm_per_rad", Meaning::kStiffness}};
  return kAll;
}

Meaning meaning_of(const std::string& quantity) {
  const auto found = meanings().find(quantity);
  return found == meanings().end() ? Meaning::kPlain : found->second;
}

/// "stiffness_nm_per_rad" says its unit in its last words; those that a page has a symbol for.
std::pair<std::string, std::string> name_and_unit(const std::string& quantity) {
  static const std::vector<std::pair<std::string, std::string>> kUnits = {{"_nms_per_rad", "Nms/rad"},
                                                                          {"_nm_per_rad", "Nm/rad"},
                                                                          {"_kgm2", "kg m\u00b2"},
                                                                          {"_rad_s", "rad/s"},
                                                                          {"_nm", "Nm"},
                                                                          {"_rad", "rad"},
                                                                          {"_hz", "Hz"},
                                                                          {"_s", "s"}};
  for (const auto& [end, unit] : kUnits) {
    if (quantity.ends_with(end)) return {quantity.substr(0, quantity.size() - end.size()), unit};
  }
  return {quantity, ""};
}

report::Axis axis_of(const std::string& quantity) {
  const auto [name, unit] = name_and_unit(quantity);
  return {.label = name, .unit = unit};
}

std::vector<report::Part> shares(const fleet::Summary& summary) {
  report::Bars bars{.title = "Share of the records that have the change",
                    .caption = "",
                    .value = {.label = "Share of records", .unit = "%", .range = {{0, 100}}}};
  report::BarSeries series{.name = "share, with its 95 % interval", .meaning = Meaning::kPlain};
  for (const auto& name : fleet::by_share(summary)) {
    if (bars.categories.size() == kBars) break;
    const fleet::ChangeTally& tally = summary.changes().at(name);
    if (tally.named() == 0) continue;
    const fleet::Interval share = tally.share().interval();
    bars.categories.push_back(fleet::words(name));
    series.values.push_back(100 * share.value);
    series.low.push_back(100 * share.low);
    series.high.push_back(100 * share.high);
  }
  if (bars.categories.empty()) return {};
  bars.series.push_back(std::move(series));
  return {std::move(bars)};
}

/// Between the 1st and the 99th percentile, so that one record far out does not squeeze all others into a bin.
report::Histogram histogram(const std::string& quantity, const fleet::QuantityTally& tally) {
  std::vector<double> values;
  values.reserve(tally.sample().kept().size());
  for (const fleet::RecordNumber& one : tally.sample().kept()) values.push_back(one.number);
  const double low = fleet::quantile(values, 0.01);
  const double high = fleet::quantile(values, 0.99);
  const double width = high > low ? (high - low) / kBins : std::max(1e-12, std::abs(low) / kBins);
  report::Histogram out{.title = name_and_unit(quantity).first,
                        .x = axis_of(quantity),
                        .name = "records",
                        .meaning = meaning_of(quantity)};
  for (std::size_t i = 0; i <= kBins; ++i) out.edges.push_back(low + width * static_cast<double>(i));
  out.counts.assign(kBins, 0);
  std::size_t beyond = 0;
  for (const double value : values) {
    const double at = (value - low) / width;
    if (at < 0 || at > kBins) {
      ++beyond;
    } else {
      ++out.counts[std::min(kBins - 1, static_cast<std::size_t>(at))];
    }
  }
  out.caption = fmt::format("{} of {} values", values.size(), tally.sample().seen());
  if (beyond > 0) out.caption += fmt::format(", {} of them beyond the axis", beyond);
  return out;
}

std::vector<report::Part> sizes(const fleet::Summary& summary) {
  std::vector<report::Part> out;
  if (summary.closed().sample().seen() > 0) out.emplace_back(histogram("closed_fraction", summary.closed()));
  std::vector<std::pair<std::string, const fleet::QuantityTally*>> rest;
  for (const auto& [name, tally] : summary.quantities()) {
    if (meanings().contains(name)) {
      out.emplace_back(histogram(name, tally));
    } else {
      rest.emplace_back(name, &tally);
    }
  }
  std::ranges::stable_sort(rest, std::greater<>(), [](const auto& one) { return one.second->sample().seen(); });
  for (const auto& [name, tally] : rest) {
    if (out.size() >= kCharts) break;
    out.emplace_back(histogram(name, *tally));
  }
  return out;
}

report::Scatter over(fleet::Spread::Clock clock, const std::string& quantity, const fleet::QuantityTally& tally,
                     const RecordLinks& links) {
  const bool days = clock == fleet::Spread::kDays;
  report::Scatter out{.title = fmt::format("{} over {}", name_and_unit(quantity).first, days ? "time" : "mileage"),
                      .caption = "A point is a record; a click opens it.",
                      .x = days ? report::Axis{.label = "Year"} : report::Axis{.label = "Mileage", .unit = "km"},
                      .y = axis_of(quantity)};
  report::Cloud cloud{.name = "records", .meaning = meaning_of(quantity)};
  for (const fleet::RecordNumber& one : tally.sample().kept()) {
    const double at = one.clocks[clock];
    if (!std::isfinite(at)) continue;
    cloud.x.push_back(days ? kEpochYear + at / kDaysAYear : at);
    cloud.y.push_back(one.number);
    cloud.labels.push_back(one.vehicle.empty() ? one.record : one.vehicle + ", " + one.record);
    cloud.hrefs.push_back(links.to(one.record));
  }
  out.clouds.push_back(std::move(cloud));
  return out;
}

/// Of what drifts, the surest first: whose slope is the most half-widths of its interval from zero.
std::vector<report::Part> drifts(const fleet::Summary& summary, const RecordLinks& links) {
  struct Found {
    double surety;
    fleet::Spread::Clock clock;
    std::string quantity;
    const fleet::QuantityTally* tally;
  };
  std::vector<Found> found;
  const auto look = [&](const std::string& name, const fleet::QuantityTally& tally) {
    for (const auto clock : {fleet::Spread::kDays, fleet::Spread::kKilometres}) {
      const auto drift = tally.spread().drift(clock);
      if (!drift || !(drift->slope.low > 0 || drift->slope.high < 0)) continue;
      const double reach = (drift->slope.high - drift->slope.low) / 2;
      found.push_back({std::abs(drift->slope.value) / reach, clock, name, &tally});
    }
  };
  if (summary.closed().sample().seen() > 0) look("closed_fraction", summary.closed());
  for (const auto& [name, tally] : summary.quantities()) look(name, tally);
  std::ranges::stable_sort(found, std::greater<>(), &Found::surety);
  std::vector<report::Part> out;
  for (const Found& one : found) {
    if (out.size() == kCharts) break;
    out.emplace_back(over(one.clock, one.quantity, *one.tally, links));
  }
  return out;
}

}  // namespace

std::vector<report::Part> fleet_charts(const std::string& table, const fleet::Summary& summary,
                                       const RecordLinks& links) {
  if (table == "changes") return shares(summary);
  if (table == "quantities") return sizes(summary);
  if (table == "drift") return drifts(summary, links);
  return {};
}

}  // namespace steerid
