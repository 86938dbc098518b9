// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/spread.hpp"

#include <cmath>
#include <limits>

namespace steerid::fleet {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// 97.5 % quantile of Student's t, 3 or more degrees: Abramowitz and Stegun 26.7.5, within 1 % of the tables.
double student(double degrees) {
  constexpr double z = 1.959964;
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double z7 = z5 * z * z;
  return z + (z3 + z) / (4 * degrees) + (5 * z5 + 16 * z3 + 3 * z) / (96 * degrees * degrees) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * degrees * degrees * degrees);
}

}  // namespace

Spread::Line& Spread::Line::operator+=(const Line& other) {
  n += other.n;
  x += other.x;
  y += other.y;
  xx += other.xx;
  xy += other.xy;
  return *this;
}

void Spread::Line::add(double x_value, double y_value) {
  *this += Line{1, x_value, y_value, x_value * x_value, x_value * y_value};
}

Spread::Sums& Spread::Sums::operator+=(const Sums& other) {
  n += other.n;
  vehicles += other.vehicles;
  nn += other.nn;
  y += other.y;
  n_mean2 += other.n_mean2;
  inside += other.inside;
  for (std::size_t c = 0; c < kClocks; ++c) {
    pooled[c] += other.pooled[c];
    inside_xx[c] += other.inside_xx[c];
    inside_xy[c] += other.inside_xy[c];
    inside_n[c] += other.inside_n[c];
  }
  return *this;
}

void Spread::add(double y, const std::array<double, kClocks>& clocks) {
  if (!y_zero_) y_zero_ = y;
  const double from_zero = y - *y_zero_;
  n_ += 1;
  const double away = from_zero - mean_;
  mean_ += away / n_;
  squares_ += away * (from_zero - mean_);
  for (std::size_t c = 0; c < kClocks; ++c) {
    if (!std::isfinite(clocks[c])) continue;
    if (!x_zero_[c]) x_zero_[c] = clocks[c];
    lines_[c].add(clocks[c] - *x_zero_[c], from_zero);
  }
}

void Spread::end_vehicle(std::size_t vehicle) {
  if (n_ == 0) return;
  Sums one;
  one.n = n_;
  one.vehicles = 1;
  one.nn = n_ * n_;
  one.y = n_ * mean_;
  one.n_mean2 = n_ * mean_ * mean_;
  one.inside = squares_;
  one.pooled = lines_;
  for (std::size_t c = 0; c < kClocks; ++c) {
    if (lines_[c].n < 2) continue;
    one.inside_xx[c] = lines_[c].sxx();
    one.inside_xy[c] = lines_[c].sxy();
    one.inside_n[c] = lines_[c].n;
  }
  groups_[vehicle % kGroups] += one;
  n_ = mean_ = squares_ = 0;
  lines_ = {};
}

Spread::Sums Spread::total() const {
  Sums all;
  for (const Sums& one : groups_) all += one;
  return all;
}

std::size_t Spread::records() const { return static_cast<std::size_t>(total().n); }

std::size_t Spread::vehicles() const { return static_cast<std::size_t>(total().vehicles); }

Interval Spread::jackknifed(const std::function<double(const Sums&)>& estimate) const {
  const double value = estimate(total());
  double count = 0;
  double mean = 0;
  double squares = 0;
  for (const Sums& group : groups_) {
    if (group.n == 0) continue;
    Sums others;  // summed anew: a difference would leave a rounding error where nothing is left
    for (const Sums& other : groups_) {
      if (&other != &group) others += other;
    }
    const double without = estimate(others);
    if (!std::isfinite(without)) continue;
    count += 1;
    const double away = without - mean;
    mean += away / count;
    squares += away * (without - mean);
  }
  if (count < 4) return {value, kNone, kNone};
  const double reach = student(count - 1) * std::sqrt((count - 1) / count * squares);
  return {value, value - reach, value + reach};
}

Interval Spread::mean() const {
  const double zero = y_zero_.value_or(0);
  return jackknifed([zero](const Sums& s) { return zero + s.y / s.n; });
}

Interval Spread::within() const {
  Interval found = jackknifed(
      [](const Sums& s) { return s.n > s.vehicles ? std::sqrt(std::max(0.0, s.inside / (s.n - s.vehicles))) : kNone; });
  if (found.low < 0) found.low = 0;
  return found;
}

Interval Spread::between() const {
  Interval found = jackknifed([](const Sums& s) {
    if (s.n <= s.vehicles || s.vehicles < 2) return kNone;
    const double within = s.inside / (s.n - s.vehicles);
    const double among = (s.n_mean2 - s.y * s.y / s.n) / (s.vehicles - 1);
    const double size = (s.n - s.nn / s.n) / (s.vehicles - 1);  // of a vehicle, between mean and harmonic mean
    return std::sqrt(std::max(0.0, (among - within) / size));
  });
  if (found.low < 0) found.low = 0;
  return found;
}

std::optional<Spread::Drift> Spread::drift(Clock clock) const {
  const Sums all = total();
  const bool within = all.inside_xx[clock] > 0;
  const double n = within ? all.inside_n[clock] : all.pooled[clock].n;
  if (n < 3 || !(within || all.pooled[clock].sxx() > 0)) return std::nullopt;
  const Interval slope = jackknifed([&](const Sums& s) {
    const double xx = within ? s.inside_xx[clock] : s.pooled[clock].sxx();
    const double xy = within ? s.inside_xy[clock] : s.pooled[clock].sxy();
    return xx > 0 ? xy / xx : kNone;
  });
  return Drift{within, static_cast<std::size_t>(n), slope};
}

}  // namespace steerid::fleet
