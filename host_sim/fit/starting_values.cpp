// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/starting_values.hpp"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "plant/linear_response.hpp"

namespace steerid {
namespace {

constexpr double kCorners_hz[] = {1.0, 5.0};

// Adds J a + B w + C th (+ offset) = T of one segment, all filtered by 1/(s + lambda)^2, to the normal equations.
// Columns: acceleration, rate, angle, one, torque. The first samples hold the filter's own transient.
void add_segment(const Segment& segment, const TorqueSignal& angle, double lambda, Eigen::Matrix<double, 5, 5>& gram) {
  const WheelArm filter{1, 2 * lambda, lambda * lambda};
  const double dc = lambda * lambda;
  const std::vector<WheelState> th =
      free_run_states(filter, angle, segment.time_s, {segment.angle_rad.front() / dc, 0});
  const std::vector<double> torque =
      free_run(filter, segment.torque, segment.time_s, {segment.net_torque_nm.front() / dc, 0});
  const double settled_s =
      segment.time_s.front() + std::min(8 / lambda, (segment.time_s.back() - segment.time_s.front()) / 4);
  for (std::size_t i = 0; i < segment.size(); ++i) {
    if (segment.time_s[i] < settled_s) continue;
    const double acceleration = segment.angle_rad[i] - 2 * lambda * th[i].rate_rad_s - dc * th[i].angle_rad;
    const Eigen::Matrix<double, 5, 1> row(acceleration, th[i].rate_rad_s, th[i].angle_rad, 1.0, torque[i]);
    gram.noalias() += row * row.transpose();
  }
}

WheelArm least_squares(std::span<const Segment> segments, std::span<const TorqueSignal> angles, double lambda,
                       bool torque_offset) {
  Eigen::Matrix<double, 5, 5> gram = Eigen::Matrix<double, 5, 5>::Zero();
  for (std::size_t s = 0; s < segments.size(); ++s) add_segment(segments[s], angles[s], lambda, gram);
  const Eigen::Index unknowns = torque_offset ? 4 : 3;
  Eigen::VectorXd scale = gram.diagonal().head(unknowns).cwiseSqrt();
  scale = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram.topLeftCorner(unknowns, unknowns) * scale.asDiagonal();
  const Eigen::VectorXd rhs = scale.asDiagonal() * gram.col(4).head(unknowns);
  const Eigen::VectorXd x = scale.asDiagonal() * scaled.completeOrthogonalDecomposition().solve(rhs);
  return {x[0], x[1], x[2]};
}

// A negative answer is noise: kept inside, near the edge, in proportion to the rest of the wheel.
WheelArm made_physical(WheelArm wheel) {
  constexpr double kSlow = 2 * std::numbers::pi * 0.3;
  if (!(wheel.inertia_kgm2 > 0)) {
    wheel.inertia_kgm2 =
        std::max(0.1 * std::abs(wheel.damping_nms_per_rad), 1e-3 * std::abs(wheel.stiffness_nm_per_rad));
  }
  wheel.damping_nms_per_rad = std::max(wheel.damping_nms_per_rad, 0.1 * kSlow * wheel.inertia_kgm2);
  wheel.stiffness_nm_per_rad = std::max(wheel.stiffness_nm_per_rad, 0.0);
  return wheel;
}

}  // namespace

std::vector<WheelArm> starting_values(std::span<const Segment> segments, bool torque_offset) {
  std::vector<TorqueSignal> angles;  // the filter's input: any signal between samples, here an angle
  for (const Segment& segment : segments) {
    angles.push_back(
        TorqueSignal::from_samples(segment.time_s, segment.angle_rad, TorqueSignal::Between::kBandLimited));
  }
  std::vector<WheelArm> candidates;
  for (const double corner_hz : kCorners_hz) {
    const WheelArm wheel =
        made_physical(least_squares(segments, angles, 2 * std::numbers::pi * corner_hz, torque_offset));
    if (wheel.inertia_kgm2 > 0 &&
        std::isfinite(wheel.inertia_kgm2 + wheel.damping_nms_per_rad + wheel.stiffness_nm_per_rad)) {
      candidates.push_back(wheel);
    }
  }
  return candidates;
}

std::vector<WheelArm> typical_arms() { return {{0.05, 0.5, 5}, {0.11, 2, 20}, {0.11, 3, 60}}; }

}  // namespace steerid
