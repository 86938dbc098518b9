// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/slow_torque.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "log/resample.hpp"
#include "plant/effects/vocabulary.hpp"
#include "plant/linear_response.hpp"
#include "plant/torque_signal.hpp"

namespace steerid::gap {
namespace {

constexpr double kKnots_s = 0.3;  // at 1 Hz a cubic spline misses 0.1 % of the power; with 0.5 s it were a half

/// The angle that one spline of unit size causes, from its start at -2 knots on, a sample apart.
std::vector<double> spline_response(const WheelArm& wheel) {
  const double length_s = 4 * kKnots_s + std::min(8 * memory_s(wheel), 60.0);
  std::vector<double> time_s;
  std::vector<double> torque_nm;
  for (double t = 0; t < length_s; t += 1 / kResampledRateHz) {
    const double x = std::abs(t / kKnots_s - 2);
    time_s.push_back(t);
    torque_nm.push_back(x < 1 ? (4 - 6 * x * x + 3 * x * x * x) / 6 : x < 2 ? std::pow(2 - x, 3) / 6 : 0);
  }
  const auto torque = TorqueSignal::from_samples(time_s, torque_nm, TorqueSignal::Between::kBandLimited);
  return free_run(wheel, torque, time_s, {});
}

/// The noise of an angle as white noise.
double angle_noise_rad2(const NoiseFloor& floor, const WheelArm& wheel) {
  return floor.angle_variance + floor.torque_variance * 1e-3 / std::max(wheel.stiffness_nm_per_rad, 1.0);
}

}  // namespace

Effect slow_torque(const Record& record, const WheelArm& wheel, const std::vector<double>& residual_rad,
                   const std::vector<char>& use, const NoiseFloor& floor) {
  const std::vector<double> response = spline_response(wheel);
  const double origin = record.time_s.front();
  const auto knots = static_cast<Eigen::Index>((record.time_s.back() - origin) / kKnots_s) + 3;
  const double noise = angle_noise_rad2(floor, wheel);
  const double prior = std::max(floor.slow_variance, 1e-12) / kSplinePower;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(knots);
  const auto reach = static_cast<Eigen::Index>(static_cast<double>(response.size()) / kResampledRateHz / kKnots_s) + 1;
  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(knots, reach + 1);  // [k, d]: knots k and k + d
  std::vector<double> column(static_cast<std::size_t>(reach) + 1);
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (use[i] == 0 || !std::isfinite(residual_rad[i])) continue;
    const double t = record.time_s[i] - origin;
    const auto last = std::min<Eigen::Index>(knots - 1, static_cast<Eigen::Index>(t / kKnots_s + 2));
    const Eigen::Index first = std::max<Eigen::Index>(0, last - reach);
    for (Eigen::Index k = first; k <= last; ++k) {
      const double since = t - (static_cast<double>(k) - 2) * kKnots_s;
      const auto at = static_cast<std::size_t>(std::lround(since * kResampledRateHz));
      column[static_cast<std::size_t>(k - first)] = since >= 0 && at < response.size() ? response[at] : 0;
    }
    for (Eigen::Index k = first; k <= last; ++k) {
      const double own = column[static_cast<std::size_t>(k - first)];
      right[k] += own * residual_rad[i] / noise;
      for (Eigen::Index m = k; m <= last; ++m)
        band(k, m - k) += own * column[static_cast<std::size_t>(m - first)] / noise;
    }
  }
  for (Eigen::Index k = 0; k < knots; ++k) {
    entries.emplace_back(k, k, band(k, 0) + 1 / prior);
    for (Eigen::Index d = 1; d <= reach && k + d < knots; ++d) {
      if (band(k, d) == 0) continue;
      entries.emplace_back(k, k + d, band(k, d));
      entries.emplace_back(k + d, k, band(k, d));
    }
  }
  Eigen::SparseMatrix<double> matrix(knots, knots);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd course = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  Effect effect(effect::unmeasured_torque);
  effect.at("knot_interval_s") = kKnots_s;
  effect.at("rms_nm") = std::min(std::sqrt(floor.slow_variance), effect.type->parameters.front().high);
  effect.time_course_nm.assign(course.begin(), course.end());
  return effect;
}

Effect slow_torque_by_runs(const Record& record, const std::vector<RunStretch>& stretches, const Simulation& simulation,
                           const Effect& linear, const std::vector<char>& use, const NoiseFloor& floor) {
  constexpr int kRounds = 5;
  CourseFit fit({.record = record,
                 .stretches = stretches,
                 .between = simulation.torque_between_samples,
                 .knots_s = linear.at("knot_interval_s"),
                 .use = use},
                simulation.effects, simulation.wheel,
                {.rms_nm = linear.at("rms_nm"), .angle_variance_rad2 = angle_noise_rad2(floor, simulation.wheel)});
  Eigen::VectorXd start = Eigen::VectorXd::Zero(fit.knots());
  const Eigen::Index known = std::min(fit.knots(), static_cast<Eigen::Index>(linear.time_course_nm.size()));
  start.head(known) = Eigen::Map<const Eigen::VectorXd>(linear.time_course_nm.data(), known);
  if (const Eigen::VectorXd none = Eigen::VectorXd::Zero(fit.knots()); fit.cost(none) < fit.cost(start)) start = none;
  return fit.torque(fit.fit(std::move(start), kRounds));
}

double course_rms_nm(const Effect& torque) {
  const std::vector<double>& c = torque.time_course_nm;
  double square = 0;
  for (std::size_t k = 1; k + 1 < c.size(); ++k) {
    const double at_knot = (c[k - 1] + 4 * c[k] + c[k + 1]) / 6;
    square += at_knot * at_knot;
  }
  return c.size() > 2 ? std::sqrt(square / static_cast<double>(c.size() - 2)) : 0;
}

}  // namespace steerid::gap
