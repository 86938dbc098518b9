// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/together.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/likelihood/student.hpp"

namespace steerid::gap {
namespace {

/// What chi^2 exceeds once in a hundred (Wilson and Hilferty 1931): 6.6 for one degree of freedom, to 2 %.
double chi_square_99(double free) {
  constexpr double kNormal99 = 2.326348;
  const double spread = 2 / (9 * free);
  return free * std::pow(1 - spread + kNormal99 * std::sqrt(spread), 3);
}

SharedNumber shared(std::string of, std::string parameter, std::vector<BoundedValue> values) {
  SharedNumber out{std::move(of), std::move(parameter), std::move(values), {}, false};
  double weight = 0;
  double sum = 0;
  double told = 0;
  const auto weight_of = [](const BoundedValue& one) {
    const double sd = (one.high - one.low) / (2 * kNormal95);
    return std::isfinite(sd) && sd > 0 ? 1 / (sd * sd) : 0;
  };
  for (const BoundedValue& one : out.values) {
    weight += weight_of(one);
    sum += weight_of(one) * one.value;
    told += weight_of(one) > 0 ? 1 : 0;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  out.together = {out.values.front().value, -infinity, infinity};
  if (!(weight > 0)) return out;
  const double mean = sum / weight;
  const double half = kNormal95 / std::sqrt(weight);
  out.together = {mean, mean - half, mean + half};
  double chi_square = 0;
  for (const BoundedValue& one : out.values) chi_square += weight_of(one) * std::pow(one.value - mean, 2);
  out.differs = told > 1 && chi_square > chi_square_99(told - 1);
  return out;
}

/// The cause of this type in each record; fewer where some have none.
template <class Record>
auto causes_of(const EffectType& type, std::span<Record> records) {
  std::vector<decltype(&records.front().causes.front())> all;
  for (Record& record : records) {
    const auto same = std::ranges::find(record.causes, &type, [](const Cause& one) { return one.effect.type; });
    if (same != record.causes.end()) all.push_back(&*same);
  }
  return all;
}

}  // namespace

void widen_shared_sizes(std::span<Diagnosis> records) {
  for (const Cause& cause : records.front().causes) {
    std::vector<Cause*> same = causes_of(*cause.effect.type, records);
    std::erase_if(same, [&](const Cause* one) { return one->alone.size() != cause.alone.size(); });
    for (std::size_t i = 0; i < cause.alone.size(); ++i) {
      std::vector<BoundedValue> values;
      values.reserve(same.size());
      for (const Cause* one : same) values.push_back(one->alone[i]);
      const BoundedValue alone = shared({}, {}, std::move(values)).together;
      for (Cause* one : same) {
        BoundedValue& size = one->parameters[i];
        size.low = std::min(size.low, size.value - (alone.value - alone.low));
        size.high = std::max(size.high, size.value + (alone.high - alone.value));
      }
    }
  }
}

std::vector<SharedNumber> shared_numbers(std::span<const Diagnosis> records) {
  std::vector<SharedNumber> out;
  const auto of_wheel = [&](const char* name, BoundedValue BaseWheel::*value) {
    std::vector<BoundedValue> values;
    for (const Diagnosis& one : records) values.push_back(one.base.*value);
    out.push_back(shared("wheel", name, std::move(values)));
  };
  of_wheel("inertia_kgm2", &BaseWheel::inertia_kgm2);
  of_wheel("damping_nms_per_rad", &BaseWheel::damping_nms_per_rad);
  of_wheel("stiffness_nm_per_rad", &BaseWheel::stiffness_nm_per_rad);
  for (const Cause& cause : records.front().causes) {
    const EffectType& type = *cause.effect.type;
    for (std::size_t i = 0; i < cause.parameters.size() && i < type.parameters.size(); ++i) {
      std::vector<BoundedValue> values;
      for (const Cause* same : causes_of(type, records)) {
        if (i < same->parameters.size()) values.push_back(same->alone.empty() ? same->parameters[i] : same->alone[i]);
      }
      if (values.size() != records.size()) continue;
      out.push_back(shared(std::string(type.id), std::string(type.parameters[i].name), std::move(values)));
      if (!cause.alone.empty()) out.back().together = cause.parameters[i];
    }
  }
  return out;
}

std::string difference_words(const SharedNumber& number, std::span<const NamedRecord> records) {
  std::string values;
  for (std::size_t i = 0; i < records.size(); ++i) {
    values += fmt::format("{}{:.4g} in {}", i == 0 ? "" : ", ", number.values[i].value, records[i].name);
  }
  return fmt::format("{} of {} differs: {}", number.parameter, number.of == "wheel" ? "the wheel" : number.of, values);
}

}  // namespace steerid::gap
