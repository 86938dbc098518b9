// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/record_gates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "log/bad_input.hpp"
#include "log/record_quality.hpp"

namespace steerid::gap {
namespace {

constexpr double kShortest_s = 6.0;

double spread(const std::vector<double>& x) {
  const auto [low, high] = std::ranges::minmax_element(x);
  return *high - *low;
}

/// Distinct values, counted up to a few.
std::size_t distinct(const std::vector<double>& x) {
  std::set<double> seen;
  for (const double value : x) {
    seen.insert(value);
    if (seen.size() > 8) break;
  }
  return seen.size();
}

}  // namespace

void require_usable(const Record& record) {
  const double period_s = quality_of(record).median_period_s;  // the last sample lasts one, too
  const double length_s = record.size() > 1 ? record.time_s.back() - record.time_s.front() + period_s : 0;
  if (length_s < kShortest_s) {
    throw BadInput(fmt::format("the record is {:.3f} s long: expected {:g} s or more; record a longer drive",
                               std::floor(1000 * length_s) / 1000, kShortest_s));
  }
  // A coarse angle may have three values, and say when it passes from one to the next.
  if (distinct(record.angle_rad) < 3) {
    throw BadInput(
        "not excited: the angle hardly ever changes, so the record says nothing about the wheel; move the wheel, or "
        "check the angle sensor");
  }
  if (!(spread(record.net_torque_nm()) > 0)) {
    throw BadInput(
        "not excited: the torque never changes, so the record says nothing about the wheel; apply a torque that "
        "varies, or check the torque sensors");
  }
}

bool misses_most(double nrmse) {
  constexpr double kMost = 0.5;  // of the motion's power
  return nrmse * nrmse > kMost;
}

std::vector<std::string> require_excited(const BatchFit& fit, double closest_nrmse,
                                         const std::function<double()>& beside_offset_nrmse) {
  const auto says = [](const FittedParameter& one) { return one.state == ParameterState::kValid; };
  if (fit.stop == StopReason::kNoData) {
    throw BadInput("no gap-free stretch of the record is long enough; record a drive without gaps");
  }
  const bool nothing = !says(fit.inertia) && !says(fit.damping) && !says(fit.stiffness);
  if (nothing && misses_most(closest_nrmse) && misses_most(beside_offset_nrmse())) {
    throw BadInput(
        "not excited: neither inertia nor damping nor stiffness can be told from this record; steer faster, or have "
        "the EPS play a probe (steerid simulate --task probe shows one)");
  }
  std::vector<std::string> notes;
  const auto note = [&](const FittedParameter& one, const char* name) {
    if (!says(one)) notes.push_back(fmt::format("the {} is not excited: what depends on it is not certain", name));
  };
  note(fit.inertia, "inertia");
  note(fit.damping, "damping");
  note(fit.stiffness, "stiffness");
  return notes;
}

}  // namespace steerid::gap
