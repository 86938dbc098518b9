// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/summary.hpp"

#include <cmath>
#include <limits>

#include "fleet/calendar.hpp"

namespace steerid::fleet {

void Summary::add(const RecordLine& line) {
  const ListedRecord& record = line.record;
  if (record.vehicle.empty() || record.vehicle != vehicle_) end_vehicle();
  vehicle_ = record.vehicle;
  named_vehicles_ = named_vehicles_ || !vehicle_.empty();
  ++records_;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  RecordNumber one{.record = record.name, .vehicle = vehicle_};
  one.clocks[Spread::kDays] = days_of(record.date).value_or(kNone);
  one.clocks[Spread::kKilometres] = record.mileage_km.value_or(kNone);
  if (line.ended == Ended::kAnswered) {
    add_answer(line, one);
  } else {
    const bool fault = line.ended == Ended::kFault;
    faults_ += fault ? 1 : 0;
    refused_.add(line.error, fault, one);
  }
}

void Summary::add_answer(const RecordLine& line, const RecordNumber& record) {
  ++answered_;
  in_vehicle_ = true;
  const RecordFacts facts = kind_.facts(line.answer);
  for (const ChangeFact& one : facts.changes) changes_[{one.effect, one.change}].add(one, record);
  for (const QuantityFact& one : facts.quantities) quantities_[one.name].add(one.value, record);
  if (std::isfinite(facts.closed)) closed_.add(facts.closed, record);
  if (facts.unknown) unknown_.add(facts.unexplained, record);
  if (!facts.doubt.empty()) doubted_.add(facts.doubt, false, record);
}

void Summary::end_vehicle() {
  if (!in_vehicle_) return;
  for (auto& [name, tally] : changes_) tally.end_vehicle(vehicles_);
  for (auto& [name, tally] : quantities_) tally.end_vehicle(vehicles_);
  closed_.end_vehicle(vehicles_);
  ++vehicles_;
  in_vehicle_ = false;
}

}  // namespace steerid::fleet
