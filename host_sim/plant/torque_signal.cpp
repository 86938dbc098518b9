// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/torque_signal.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace steerid {
namespace {

// Second derivatives at the samples of the interpolating cubic spline with not-a-knot ends: the third derivative is
// continuous across the second and the last but one sample, so that no end slope has to be invented. The two end
// values are eliminated, which leaves a diagonally dominant tridiagonal system (de Boor, A Practical Guide to
// Splines, chapter IV) solved without pivoting.
std::vector<double> not_a_knot_curvature(std::span<const double> t, std::span<const double> y) {
  const std::size_t n = t.size();
  std::vector<double> curvature(n, 0.0);
  if (n < 3) return curvature;
  const auto step = [&](std::size_t i) { return t[i + 1] - t[i]; };
  const auto slope = [&](std::size_t i) { return (y[i + 1] - y[i]) / step(i); };
  if (n == 3) {  // both conditions sit on the same sample: the parabola through the three
    std::fill(curvature.begin(), curvature.end(), 2 * (slope(1) - slope(0)) / (t[2] - t[0]));
    return curvature;
  }
  std::vector<double> upper(n, 0.0);  // of the eliminated system, diagonal one
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = step(i - 1);
    const double after = step(i);
    double lower = before;
    double diagonal = 2 * (before + after);
    double above = after;
    if (i == 1) {
      diagonal += before * (before + after) / after;
      above -= before * before / after;
      lower = 0;
    }
    if (i + 2 == n) {
      diagonal += after * (before + after) / before;
      lower -= after * after / before;
      above = 0;
    }
    const double pivot = diagonal - lower * upper[i - 1];
    upper[i] = above / pivot;
    curvature[i] = (6 * (slope(i) - slope(i - 1)) - lower * curvature[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i-- > 1;) curvature[i] -= upper[i] * curvature[i + 1];
  curvature[0] = curvature[1] + (curvature[1] - curvature[2]) * step(0) / step(1);
  curvature[n - 1] = curvature[n - 2] + (curvature[n - 2] - curvature[n - 3]) * step(n - 2) / step(n - 3);
  return curvature;
}

}  // namespace

TorqueSignal TorqueSignal::from_samples(std::span<const double> time_s, std::span<const double> torque_nm,
                                        Between between) {
  if (time_s.empty()) throw std::invalid_argument("a torque signal needs at least one sample");
  if (time_s.size() != torque_nm.size()) throw std::invalid_argument("torque and time differ in length");
  if (std::adjacent_find(time_s.begin(), time_s.end(), [](double a, double b) { return !(a < b); }) != time_s.end()) {
    throw std::invalid_argument("the times of a torque signal must increase strictly");
  }
  TorqueSignal signal;
  signal.time_s_.assign(time_s.begin(), time_s.end());
  signal.cubic_.resize(time_s.size());
  for (std::size_t i = 0; i < time_s.size(); ++i) signal.cubic_[i].c0 = torque_nm[i];
  if (between == Between::kHeld) return signal;

  const std::vector<double> curvature = not_a_knot_curvature(time_s, torque_nm);
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) {
    const double step = time_s[i + 1] - time_s[i];
    Cubic& cubic = signal.cubic_[i];
    cubic.c1 = (torque_nm[i + 1] - torque_nm[i]) / step - step * (2 * curvature[i] + curvature[i + 1]) / 6;
    cubic.c2 = curvature[i] / 2;
    cubic.c3 = (curvature[i + 1] - curvature[i]) / (6 * step);
  }
  return signal;
}

// The piece whose half-open interval [knot k, knot k + 1) holds the time; a record is nearly equally spaced, so a
// guess from the mean spacing is right or one off.
std::size_t TorqueSignal::piece_holding(double time_s) const {
  const std::size_t last = time_s_.size() - 1;
  if (!(time_s > time_s_.front())) return 0;
  if (time_s >= time_s_.back()) return last;
  const double share = (time_s - time_s_.front()) / (time_s_.back() - time_s_.front());
  std::size_t k = std::min(static_cast<std::size_t>(share * static_cast<double>(last)), last - 1);
  if (time_s >= time_s_[k] && time_s < time_s_[k + 1]) return k;
  if (k > 0 && time_s >= time_s_[k - 1] && time_s < time_s_[k]) return k - 1;
  if (k + 2 <= last && time_s >= time_s_[k + 1] && time_s < time_s_[k + 2]) return k + 1;
  return static_cast<std::size_t>(std::upper_bound(time_s_.begin(), time_s_.end(), time_s) - time_s_.begin()) - 1;
}

double TorqueSignal::at(double time_s) const {
  if (time_s <= time_s_.front()) return cubic_.front().c0;
  const std::size_t k = piece_holding(time_s);
  return cubic_[k].at(time_s - time_s_[k]);
}

TorqueSignal::Local TorqueSignal::local(double time_s) const {
  if (time_s < time_s_.front()) return {Cubic{cubic_.front().c0, 0, 0, 0}, time_s_.front()};
  const std::size_t k = piece_holding(time_s);
  if (k + 1 == time_s_.size()) return {cubic_[k], std::numeric_limits<double>::infinity()};
  const double offset = time_s - time_s_[k];
  return {offset == 0 ? cubic_[k] : cubic_[k].shifted(offset), time_s_[k + 1]};
}

}  // namespace steerid
