// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/hypotheses/hysteresis_loop.hpp"

#include <algorithm>
#include <cmath>

#include "plant/cubic.hpp"

namespace steerid::gap {
namespace {

constexpr double kStep = 1.0 / 32;
constexpr double kDeveloped = 1e-5;  // that much below 1 the curve ends

double slope_at(double z, double sharpness) {
  const double size = std::pow(std::min(std::abs(z), 1.0), sharpness);
  return 1 - (z < 0 ? -size : size);
}

/// One step of the classical Runge-Kutta method.
double next(double z, double slope, double sharpness) {
  const double second = slope_at(z + kStep / 2 * slope, sharpness);
  const double third = slope_at(z + kStep / 2 * second, sharpness);
  const double fourth = slope_at(z + kStep * third, sharpness);
  return z + kStep / 6 * (slope + 2 * (second + third) + fourth);
}

}  // namespace

HysteresisLoop::HysteresisLoop(double sharpness) {
  for (double z = -1; z < 1 - kDeveloped;) {
    const double slope = slope_at(z, sharpness);
    curve_.push_back({z, slope});
    z = next(z, slope, sharpness);
  }
  curve_.push_back({1, 0});
  place_ = place_of(0);
}

double HysteresisLoop::advance(double step) {
  const int way = step < 0 ? -1 : 1;
  if (step != 0 && way != way_) {
    place_ = place_of(-z_at(place_));
    way_ = way;
  }
  place_ = std::min(place_ + std::abs(step), kStep * static_cast<double>(curve_.size() - 1));
  return way_ * z_at(place_);
}

double HysteresisLoop::z_at(double place) const {
  const double steps = place / kStep;
  const auto i = std::min(static_cast<std::size_t>(steps), curve_.size() - 2);
  const Point& from = curve_[i];
  const Point& to = curve_[i + 1];
  return Cubic::hermite(from.z, from.slope, to.z, to.slope, kStep).at(place - kStep * static_cast<double>(i));
}

/// Where the curve reaches z: Newton's method from the chord between two points.
double HysteresisLoop::place_of(double z) const {
  const auto behind = std::ranges::upper_bound(curve_.begin() + 1, curve_.end() - 1, z, {}, &Point::z);
  const Point& from = *(behind - 1);
  const Point& to = *behind;
  const double start = kStep * static_cast<double>(behind - curve_.begin() - 1);
  double t = (z - from.z) / (to.z - from.z);
  for (int round = 0; round < 2; ++round) {
    const double slope = from.slope + t * (to.slope - from.slope);
    t = std::clamp(t - (z_at(start + kStep * t) - z) / (kStep * std::max(slope, kDeveloped)), 0.0, 1.0);
  }
  return start + kStep * t;
}

}  // namespace steerid::gap
