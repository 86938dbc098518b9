// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/effects/sliding_springs.hpp"

#include <algorithm>
#include <cmath>

#include "plant/cubic.hpp"

namespace steerid::effect {
namespace {

constexpr double kStep = 1.0 / 32;
constexpr double kDeveloped = 1e-6;  // that much below 1 the curve ends

}  // namespace

SlidingSprings::SlidingSprings(double sharpness) {
  const auto slope = [&](double z) { return 1 - std::pow(std::min(z, 1.0), sharpness); };
  double z = 0;
  while (z < 1 - kDeveloped) {  // the classical Runge-Kutta method
    const double first = slope(z);
    curve_.push_back({z, first});
    const double second = slope(z + kStep / 2 * first);
    const double third = slope(z + kStep / 2 * second);
    z += kStep / 6 * (first + 2 * (second + third) + slope(z + kStep * third));
  }
  curve_.push_back({1, 0});
}

/// Odd.
double SlidingSprings::first_loading(double gone) const {
  const double steps = std::abs(gone) / kStep;
  if (!(steps < static_cast<double>(curve_.size() - 1))) return gone < 0 ? -1 : 1;
  const auto i = static_cast<std::size_t>(steps);
  const Knot& from = curve_[i];
  const Knot& to = curve_[i + 1];
  const double z =
      Cubic::hermite(from.z, from.slope, to.z, to.slope, kStep).at(std::abs(gone) - kStep * static_cast<double>(i));
  return gone < 0 ? -z : z;
}

const SlidingSprings::Turn& SlidingSprings::turn(std::size_t number) const {
  return number <= turns_.size() ? turns_[number - 1] : now_;
}

std::size_t SlidingSprings::curve_at(double place, int way) const {
  std::size_t number = turns_.size() + (way == way_ ? 0 : 1);
  while (number > 0) {
    // A loop closes at the turn before the last; the loop around all others is as far to either side.
    const double closes_at = number > 1 ? turn(number - 1).place : -turn(1).place;
    if (way * (place - closes_at) < 0) break;
    number -= std::min<std::size_t>(number, 2);
  }
  return number;
}

double SlidingSprings::along(std::size_t number, double place, int way) const {
  if (number == 0) return first_loading(place);
  const Turn& from = turn(number);
  return from.z + way * 2 * first_loading(way * (place - from.place) / 2);
}

double SlidingSprings::at(double place, int way) const { return along(curve_at(place, way), place, way); }

double SlidingSprings::go(double place, int way) {
  const std::size_t number = curve_at(place, way);
  const double z = along(number, place, way);
  if (way != way_) turns_.push_back(now_);
  turns_.resize(number);
  way_ = way;
  now_ = {place, z};
  return z;
}

}  // namespace steerid::effect
