// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/summary_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fleet/calendar.hpp"

namespace steerid::fleet {
namespace {

using Row = std::vector<FleetCell>;

constexpr double kDaysAYear = 365.25;
constexpr double kKilometres = 10'000;  // of a slope's unit

struct ClockUnit {
  Spread::Clock clock;
  const char* over;
  const char* unit;
  double per;  // the clock's units in one of the slope's
};
constexpr std::array<ClockUnit, 2> kClockUnits = {ClockUnit{Spread::kDays, "date", "a year", kDaysAYear},
                                                  ClockUnit{Spread::kKilometres, "mileage", "10,000 km", kKilometres}};

/// A key that is also an anchor of a page.
std::string key_of(const std::string& kind, const std::string& name) {
  std::string out = kind + "_" + name;
  std::ranges::replace_if(
      out, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return out;
}

double count(std::size_t number) { return static_cast<double>(number); }

void add(Row& row, const Interval& interval) { row.insert(row.end(), {interval.value, interval.low, interval.high}); }

FleetTable changes(const Summary& summary) {
  FleetTable table{"changes",
                   "Which changes are common",
                   "Share of the records that have the change, with its 95 % interval: the records' own probabilities "
                   "combined over records and vehicles. Named are records that have it more likely than not.",
                   {{"effect", "Effect", false},
                    {"change", "Change", false},
                    {"share", "Share of records"},
                    {"share_low", kLow},
                    {"share_high", kHigh},
                    {"records", "Named in", true, "records"},
                    {"vehicles", "Named in", true, "vehicles"},
                    {"clearest", "Clearest record", false}}};
  for (const Summary::ChangeName& name : by_share(summary)) {
    const ChangeTally& tally = summary.changes().at(name);
    Row row = {name.first, name.second};
    add(row, tally.share().interval());
    row.emplace_back(CountOf{count(tally.named()), key_of("named", words(name))});
    row.emplace_back(count(tally.naming_vehicles()));
    const auto& clearest = tally.clearest().items();
    row.push_back(clearest.empty() ? FleetCell() : RecordName{clearest.front().second.record});
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<double> values(const QuantityTally& tally) {
  std::vector<double> out;
  out.reserve(tally.sample().kept().size());
  for (const RecordNumber& one : tally.sample().kept()) out.push_back(one.number);
  return out;
}

Row quantity_row(const std::string& name, const QuantityTally& tally) {
  const std::vector<double> sample = values(tally);
  const Spread& spread = tally.spread();
  Row row = {name,
             CountOf{count(spread.records()), key_of("values", name)},
             count(spread.vehicles()),
             quantile(sample, 0.5),
             quantile(sample, 0.05),
             quantile(sample, 0.95)};
  add(row, spread.mean());
  add(row, spread.between());
  add(row, spread.within());
  row.emplace_back(RecordName{tally.smallest().items().front().second.record});
  row.emplace_back(RecordName{tally.largest().items().front().second.record});
  return row;
}

/// All quantities, and the closed share of the gap as one of them.
std::vector<std::pair<std::string, const QuantityTally*>> all_quantities(const Summary& summary) {
  std::vector<std::pair<std::string, const QuantityTally*>> out;
  out.reserve(summary.quantities().size() + 1);
  if (summary.closed().spread().records() > 0) out.emplace_back("closed_fraction", &summary.closed());
  for (const auto& [name, tally] : summary.quantities()) out.emplace_back(name, &tally);
  return out;
}

FleetTable quantities(const Summary& summary) {
  FleetTable table{"quantities",
                   "How sizes spread over the vehicles",
                   "Of a change the records in which it is named. Median and percentiles are of records; the standard "
                   "deviations between and within vehicles are from an analysis of variance, with 95 % intervals.",
                   {{"quantity", "Quantity", false},
                    {"records", "Records"},
                    {"vehicles", "Vehicles"},
                    {"median", "Median"},
                    {"percentile_5", "5 %"},
                    {"percentile_95", "95 %"},
                    {"mean", "Mean"},
                    {"mean_low", kLow},
                    {"mean_high", kHigh},
                    {"between_vehicles_sd", "Between vehicles", true, "sd"},
                    {"between_vehicles_sd_low", kLow},
                    {"between_vehicles_sd_high", kHigh},
                    {"within_vehicles_sd", "Within vehicles", true, "sd"},
                    {"within_vehicles_sd_low", kLow},
                    {"within_vehicles_sd_high", kHigh},
                    {"smallest", "Smallest in", false},
                    {"largest", "Largest in", false}}};
  for (const auto& [name, tally] : all_quantities(summary)) table.rows.push_back(quantity_row(name, *tally));
  return table;
}

FleetTable outliers(const Summary& summary) {
  FleetTable table{
      "outliers",
      "Vehicles that are unlike the others",
      "Vehicles whose mean is so far from the vehicles' median that one would be in twenty fleets of this "
      "size, were the means spread normally. The distance is in standard deviations as the median absolute "
      "deviation gives them. With fewer than ten vehicles none is named; with a quantity and a side no more "
      "than 25 are.",
      {{"quantity", "Quantity", false},
       {"vehicle", "Vehicle", false},
       {"mean", "Its mean"},
       {"records", "Its records"},
       {"median", "Vehicles' median"},
       {"distance", "Distance", true, "sd"},
       {"record", "Farthest record", false}}};
  for (const auto& [name, tally] : all_quantities(summary)) {
    const QuantityTally::Usual usual = tally->usual();
    for (const VehicleMean& one : tally->outliers()) {
      table.rows.push_back({name, one.vehicle.empty() ? one.extreme.record : one.vehicle, one.mean, one.records,
                            usual.median, (one.mean - usual.median) / usual.sd, RecordName{one.extreme.record}});
    }
  }
  return table;
}

void add_drifts(FleetTable& table, const std::string& of, const Spread& spread) {
  for (const ClockUnit& unit : kClockUnits) {
    const auto drift = spread.drift(unit.clock);
    if (!drift) continue;
    const Interval& slope = drift->slope;
    const bool away_from_zero = slope.low > 0 || slope.high < 0;
    table.rows.push_back({of, std::string(unit.over), std::string(drift->within_vehicles ? "within" : "across"),
                          slope.value * unit.per, slope.low * unit.per, slope.high * unit.per, std::string(unit.unit),
                          count(drift->records), std::string(away_from_zero ? "drifts" : "")});
  }
}

FleetTable drift(const Summary& summary) {
  FleetTable table{
      "drift",
      "Drift over time and mileage",
      "Slopes with 95 % intervals: within vehicles, or across them where no vehicle has two records that say "
      "when they were taken. Of twenty quantities that do not drift, one is expected to be marked.",
      {{"of", "Of", false},
       {"over", "Over", false},
       {"vehicles", "Vehicles", false},
       {"slope", "Slope"},
       {"slope_low", kLow},
       {"slope_high", kHigh},
       {"per", "Per", false},
       {"records", "Records"},
       {"drifts", "", false}}};
  for (const auto& [name, tally] : all_quantities(summary)) add_drifts(table, name, tally->spread());
  for (const Summary::ChangeName& name : by_share(summary)) {
    const ChangeTally& tally = summary.changes().at(name);
    if (tally.named() > 0) add_drifts(table, "share with " + words(name), tally.probability());
  }
  return table;
}

FleetTable unknown(const Summary& summary) {
  FleetTable table{
      "unknown",
      "What is unknown, by where it lies",
      "Records whose gap no change explains, in clusters of neighbouring octaves of where the gap lies. "
      "Ranges without a unit number what the gap follows: 0 the driver's torque, 1 the motor's, 2 the angle.",
      {{"axis", "Axis", false},
       {"low", "From"},
       {"high", "To"},
       {"unit", "Unit", false},
       {"records", "Records"},
       {"share_of_unknown", "Share of the unknown"},
       {"example", "For example", false}}};
  double all = 0;
  const auto clusters = summary.unknown().clusters();
  for (const auto& one : clusters) all += count(one.records);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const auto& one = clusters[i];
    table.rows.push_back({one.axis, one.axis.empty() ? FleetCell() : one.low, one.axis.empty() ? FleetCell() : one.high,
                          one.unit, CountOf{count(one.records), fmt::format("unknown_{}", i)}, count(one.records) / all,
                          RecordName{one.examples.front().record}});
  }
  return table;
}

std::vector<std::pair<std::string, std::vector<ReasonTally::Reason>>> reasons(const Summary& summary) {
  return {{"refused", summary.refused().reasons()}, {"doubted", summary.doubted().reasons()}};
}

FleetTable refused(const Summary& summary) {
  FleetTable table{"refused",
                   "Records without an answer, and answers that are not credible",
                   "Sentences alike but for names and numbers are one reason. A fault is this program's own.",
                   {{"ended", "Ended", false},
                    {"reason", "Reason", false},
                    {"records", "Records"},
                    {"example", "For example", false}}};
  for (const auto& [kind, all] : reasons(summary)) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      // A refused record has no page: its name says where its log is.
      table.rows.push_back({kind == "doubted" ? "doubted" : std::string(all[i].fault ? "fault" : "unusable"),
                            all[i].sentence, CountOf{count(all[i].records), fmt::format("{}_{}", kind, i)},
                            kind == "doubted" ? FleetCell(RecordName{all[i].examples.front().record})
                                              : FleetCell(all[i].examples.front().record)});
    }
  }
  return table;
}

FleetTable records_table(std::string key, std::string title, const char* number) {
  FleetTable table{std::move(key),
                   std::move(title),
                   "",
                   {{"record", "Record", false},
                    {"vehicle", "Vehicle", false},
                    {"date", "Date", false},
                    {"mileage_km", "Mileage", true, "km"}}};
  if (number != nullptr) table.columns.push_back({"number", number});
  return table;
}

void add_record(FleetTable& table, const RecordNumber& one, bool has_page = true) {
  const double days = one.clocks[Spread::kDays];
  Row row = {has_page ? FleetCell(RecordName{one.record}) : FleetCell(one.record), one.vehicle,
             std::isfinite(days) ? FleetCell(date_of(days)) : FleetCell(), one.clocks[Spread::kKilometres]};
  if (table.columns.size() > row.size()) row.emplace_back(one.number);
  table.rows.push_back(std::move(row));
}

}  // namespace

std::string words(const Summary::ChangeName& change) {
  return change.second.empty() ? change.first : change.second + " " + change.first;
}

std::vector<Summary::ChangeName> by_share(const Summary& summary) {
  std::vector<std::pair<double, Summary::ChangeName>> all;
  all.reserve(summary.changes().size());
  for (const auto& [name, tally] : summary.changes()) all.emplace_back(tally.share().interval().value, name);
  std::ranges::stable_sort(all, [](const auto& one, const auto& other) {
    const bool effect = !one.second.second.empty();
    const bool other_effect = !other.second.second.empty();
    return effect != other_effect ? effect : one.first > other.first;
  });
  std::vector<Summary::ChangeName> out;
  out.reserve(all.size());
  for (auto& [share, name] : all) out.push_back(std::move(name));
  return out;
}

std::vector<FleetTable> summary_tables(const Summary& summary) {
  return {changes(summary), quantities(summary), outliers(summary), drift(summary), unknown(summary), refused(summary)};
}

std::vector<FleetTable> record_tables(const Summary& summary) {
  std::vector<FleetTable> out;
  for (const Summary::ChangeName& name : by_share(summary)) {
    const ChangeTally& tally = summary.changes().at(name);
    if (tally.named() == 0) continue;
    out.push_back(records_table(key_of("named", words(name)), "Records with " + words(name), "Probability"));
    for (const auto& [key, one] : tally.clearest().items()) add_record(out.back(), one);
  }
  for (const auto& [name, tally] : all_quantities(summary)) {
    out.push_back(records_table(key_of("values", name), "Records with the extremes of " + name, name.c_str()));
    const auto& smallest = tally->smallest().items();
    const auto& largest = tally->largest().items();
    const std::size_t half = kListed / 2;
    const std::size_t all = tally->spread().records();
    for (std::size_t i = 0; i < std::min(half, smallest.size()); ++i) add_record(out.back(), smallest[i].second);
    for (std::size_t i = std::min({half, largest.size(), all - std::min(all, half)}); i-- > 0;) {
      add_record(out.back(), largest[i].second);
    }
  }
  const auto clusters = summary.unknown().clusters();
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    out.push_back(records_table(fmt::format("unknown_{}", i), "Unknown, " + clusters[i].axis, nullptr));
    for (const RecordNumber& one : clusters[i].examples) add_record(out.back(), one);
  }
  for (const auto& [kind, all] : reasons(summary)) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      out.push_back(records_table(fmt::format("{}_{}", kind, i), all[i].sentence, nullptr));
      for (const RecordNumber& one : all[i].examples) add_record(out.back(), one, kind == "doubted");
    }
  }
  return out;
}

}  // namespace steerid::fleet
