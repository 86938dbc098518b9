// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/hypotheses/measured_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "log/record_quality.hpp"
#include "plant/linear_response.hpp"
#include "plant/torque_signal.hpp"

namespace steerid::gap {
namespace {

std::vector<double> slope(std::span<const double> x, double rate_hz) {
  const std::size_t n = x.size();
  std::vector<double> out(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1;
    const std::size_t b = std::min(i + 1, n - 1);
    if (b > a) out[i] = (x[b] - x[a]) * rate_hz / static_cast<double>(b - a);
  }
  return out;
}

/// The slope at every sample by central differences of fourth order: exact to 1 % at 12 Hz of 100.
std::vector<double> fine_slope(std::span<const double> x, double rate_hz) {
  std::vector<double> out = slope(x, rate_hz);
  for (std::size_t i = 2; i + 2 < x.size(); ++i) {
    out[i] = rate_hz * (8 * (x[i + 1] - x[i - 1]) - (x[i + 2] - x[i - 2])) / 12;
  }
  return out;
}

/// Samples a second of a stretch.
double rate_of(std::span<const double> time_s) {
  return static_cast<double>(time_s.size() - 1) / (time_s.back() - time_s.front());
}

constexpr std::size_t kFewest = 4;  // samples of a stretch in which something moves

}  // namespace

/// Mirrored at the ends, so that the ends keep their value.
std::vector<double> smoothed(const std::vector<double>& in, double rate_hz, double cutoff_hz) {
  // exp(-(2 pi f s)^2/2) = 1/sqrt(2) at the cutoff.
  const double sigma = std::sqrt(std::numbers::ln2) / (2 * std::numbers::pi * cutoff_hz) * rate_hz;
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(4 * sigma));
  std::vector<double> kernel;
  double sum = 0;
  for (std::ptrdiff_t i = 0; i <= reach; ++i) {
    const double x = static_cast<double>(i) / sigma;
    kernel.push_back(std::exp(-x * x / 2));
    sum += (i == 0 ? 1 : 2) * kernel.back();
  }
  const auto n = static_cast<std::ptrdiff_t>(in.size());
  const auto at = [&](std::ptrdiff_t i) {
    if (i < 0) i = -i;
    if (i >= n) i = 2 * (n - 1) - i;
    return in[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1))];
  };
  std::vector<double> out(in.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    double value = kernel[0] * in[static_cast<std::size_t>(i)];
    const bool inside = i >= reach && i + reach < n;
    for (std::ptrdiff_t k = 1; k <= reach; ++k) {
      const double pair =
          inside ? in[static_cast<std::size_t>(i - k)] + in[static_cast<std::size_t>(i + k)] : at(i - k) + at(i + k);
      value += kernel[static_cast<std::size_t>(k)] * pair;
    }
    out[static_cast<std::size_t>(i)] = value / sum;
  }
  return out;
}

MeasuredMotion measured_motion(const Record& record, const WheelArm& wheel) {
  MeasuredMotion motion;
  const std::size_t n = record.size();
  motion.time_s = record.time_s;
  motion.angle_rad.resize(n);
  motion.rate_rad_s.resize(n);
  motion.acceleration_rad_s2.resize(n);
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    const std::size_t count = rows.size();
    if (count < kFewest) continue;
    const std::span time = std::span(record.time_s).subspan(rows.begin, count);
    const double rate_hz = rate_of(time);
    std::vector<double> net(count);
    for (std::size_t i = 0; i < count; ++i) net[i] = record.net_torque_nm(rows.begin + i);
    const auto torque = TorqueSignal::from_samples(time, net, TorqueSignal::Between::kBandLimited);
    const double* angle = &record.angle_rad[rows.begin];
    const WheelState start{angle[0], (angle[3] - angle[0]) * rate_hz / 3};
    const std::vector<WheelState> run = free_run_states(wheel, torque, time, start);
    std::vector<double> rest(count);
    for (std::size_t i = 0; i < count; ++i) rest[i] = angle[i] - run[i].angle_rad;
    const std::vector<double> beyond = smoothed(rest, rate_hz, kSmoothing_hz);
    const std::vector<double> beyond_rate = slope(beyond, rate_hz);
    const std::vector<double> beyond_acceleration = slope(beyond_rate, rate_hz);
    for (std::size_t i = 0; i < count; ++i) {
      const WheelState& free = run[i];
      const double acceleration =
          (net[i] - wheel.damping_nms_per_rad * free.rate_rad_s - wheel.stiffness_nm_per_rad * free.angle_rad) /
          wheel.inertia_kgm2;
      motion.angle_rad[rows.begin + i] = free.angle_rad + beyond[i];
      motion.rate_rad_s[rows.begin + i] = free.rate_rad_s + beyond_rate[i];
      motion.acceleration_rad_s2[rows.begin + i] = acceleration + beyond_acceleration[i];
    }
  }
  return motion;
}

MeasuredMotion motion_carried_by(const Record& record, std::span<const double> run_rad, const MeasuredMotion& otherwise,
                                 double smoothing_hz) {
  MeasuredMotion motion = otherwise;
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    const std::span<const double> run = run_rad.subspan(rows.begin, rows.size());
    const auto finite = [](double x) { return std::isfinite(x); };
    if (run.size() < kFewest || !std::ranges::all_of(run, finite)) continue;
    const double rate_hz = rate_of(std::span(record.time_s).subspan(rows.begin, rows.size()));
    std::vector<double> rest(run.size());
    for (std::size_t i = 0; i < run.size(); ++i) rest[i] = record.angle_rad[rows.begin + i] - run[i];
    std::vector<double> angle = smoothed(rest, rate_hz, smoothing_hz);
    for (std::size_t i = 0; i < run.size(); ++i) angle[i] += run[i];
    const std::vector<double> rate = fine_slope(angle, rate_hz);
    const std::vector<double> acceleration = fine_slope(rate, rate_hz);
    const auto at = static_cast<std::ptrdiff_t>(rows.begin);
    std::ranges::copy(angle, motion.angle_rad.begin() + at);
    std::ranges::copy(rate, motion.rate_rad_s.begin() + at);
    std::ranges::copy(acceleration, motion.acceleration_rad_s2.begin() + at);
  }
  return motion;
}

}  // namespace steerid::gap
