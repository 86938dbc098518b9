// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/tallies.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace steerid::fleet {
namespace {

constexpr std::size_t kFewVehicles = 10;
constexpr double kFalseOutliers = 0.05;  // a fleet
constexpr std::size_t kReasons = 200;    // more are one

/// The z that a standard normal variable exceeds with this probability, by bisection.
double upper_normal(double probability) {
  double low = 0;
  double high = 40;
  for (int i = 0; i < 60; ++i) {
    const double z = (low + high) / 2;
    (std::erfc(z / std::sqrt(2.0)) / 2 > probability ? low : high) = z;
  }
  return low;
}

/// -1, -2, .. for negative values the larger they are, 0 for zero, 1, 2, .. for positive ones; an octave a step.
int octave(double value) {
  if (value == 0) return 0;
  const int step = std::clamp(static_cast<int>(std::floor(std::log2(std::abs(value)))), -40, 40) + 41;
  return value > 0 ? step : -step;
}

/// Neighbours have neighbouring numbers. Ranges without a unit number names, of which none is another's neighbour.
int place_number(const PlaceFact& place) {
  if (place.axis.empty()) return 0;
  return place.unit.empty() ? 2 * static_cast<int>(place.low) : octave((place.low + place.high) / 2);
}

/// The sentence with … for what is quoted and for the file's name, and # for numbers.
std::string without_particulars(const std::string& sentence) {
  std::string out;
  const std::size_t colon = sentence.find(": ");
  // "FILE, line 3, column 'x': expected ..": what stands before is the record's own.
  const std::size_t from = colon == std::string::npos || sentence.starts_with("internal error") ? 0 : colon + 2;
  bool quoted = false;
  for (const char c : sentence.substr(from)) {
    if (c == '"') {
      quoted = !quoted;
      if (quoted) out += "\"\u2026\"";
    } else if (quoted || (c == '.' && out.ends_with('#'))) {
      continue;  // the point of a number, or the last of the sentence
    } else if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
      if (!out.ends_with('#')) out += '#';
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

void ChangeTally::add(const ChangeFact& fact, const RecordNumber& record) {
  share_.add(fact.probability, fact.prior);
  probability_.add(fact.probability, record.clocks);
  if (fact.probability > 0.5) {
    ++named_;
    vehicle_named_ = true;
    RecordNumber one = record;
    one.number = fact.probability;
    clearest_.add(fact.probability, std::move(one));
  }
}

void ChangeTally::end_vehicle(std::size_t vehicle) {
  share_.end_vehicle();
  probability_.end_vehicle(vehicle);
  vehicles_ += vehicle_named_ ? 1 : 0;
  vehicle_named_ = false;
}

void QuantityTally::add(double value, RecordNumber record) {
  record.number = value;
  spread_.add(value, record.clocks);
  smallest_.add(-value, record);
  largest_.add(value, record);
  now_.vehicle = record.vehicle;
  now_.records += 1;
  now_.mean += (value - now_.mean) / now_.records;
  if (!(least_.number <= value)) least_ = record;
  if (!(most_.number >= value)) most_ = record;
  sample_.add(std::move(record));
}

void QuantityTally::end_vehicle(std::size_t vehicle) {
  spread_.end_vehicle(vehicle);
  if (now_.records == 0) return;
  means_.add(now_.mean);
  now_.extreme = least_;
  low_.add(-now_.mean, now_);
  now_.extreme = most_;
  high_.add(now_.mean, now_);
  now_ = {};
  least_ = most_ = {};
}

QuantityTally::Usual QuantityTally::usual() const {
  if (means_.seen() < kFewVehicles) {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
  const double median = quantile(means_.kept(), 0.5);
  std::vector<double> away;
  away.reserve(means_.kept().size());
  for (const double mean : means_.kept()) away.push_back(std::abs(mean - median));
  return {median, 1.4826 * quantile(std::move(away), 0.5)};
}

std::vector<VehicleMean> QuantityTally::outliers() const {
  const Usual is = usual();
  std::vector<VehicleMean> out;
  if (!(is.sd > 0)) return out;
  const double reach = is.sd * upper_normal(kFalseOutliers / 2 / static_cast<double>(means_.seen()));
  for (const auto& [key, one] : low_.items()) {
    if (one.mean < is.median - reach) out.push_back(one);
  }
  for (const auto& [key, one] : high_.items()) {
    if (one.mean > is.median + reach) out.push_back(one);
  }
  std::ranges::sort(out, std::greater<>(), [&](const VehicleMean& one) { return std::abs(one.mean - is.median); });
  return out;
}

void PlaceTally::add(const PlaceFact& place, const RecordNumber& record) {
  auto [entry, is_new] = places_.try_emplace({place.axis, place_number(place)});
  Cluster& at = entry->second;
  if (is_new) at = {.axis = place.axis, .unit = place.unit, .low = place.low, .high = place.high};
  at.low = std::min(at.low, place.low);
  at.high = std::max(at.high, place.high);
  ++at.records;
  if (at.examples.size() < kListed) at.examples.push_back(record);
}

std::vector<PlaceTally::Cluster> PlaceTally::clusters() const {
  std::vector<Cluster> out;
  int last = 0;
  for (const auto& [key, place] : places_) {
    if (out.empty() || out.back().axis != place.axis || key.second > last + 1) {
      out.push_back(place);
    } else {
      Cluster& to = out.back();
      to.low = std::min(to.low, place.low);
      to.high = std::max(to.high, place.high);
      to.records += place.records;
      for (const RecordNumber& one : place.examples) {
        if (to.examples.size() < kListed) to.examples.push_back(one);
      }
    }
    last = key.second;
  }
  std::ranges::stable_sort(out, std::greater<>(), &Cluster::records);
  return out;
}

void ReasonTally::add(const std::string& sentence, bool fault, const RecordNumber& record) {
  std::string reason = without_particulars(sentence);
  if (reasons_.size() >= kReasons && !reasons_.contains(reason)) reason = "other reasons";
  Reason& at = reasons_[reason];
  at.sentence = reason;
  at.fault = at.fault || fault;
  ++at.records;
  if (at.examples.size() < kListed) at.examples.push_back(record);
}

std::vector<ReasonTally::Reason> ReasonTally::reasons() const {
  std::vector<Reason> out;
  out.reserve(reasons_.size());
  for (const auto& [sentence, reason] : reasons_) out.push_back(reason);
  std::ranges::stable_sort(out, std::greater<>(), &Reason::records);
  return out;
}

}  // namespace steerid::fleet
