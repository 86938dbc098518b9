// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/inertia_limit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "fit/autoregression.hpp"
#include "plant/linear_response.hpp"

namespace steerid {
namespace {

constexpr int kInertia = 0, kDamping = 1, kStiffness = 2;  // of the unknowns
constexpr int kMaxSteps = 10;                              // what J leaves to find, C and an offset, is nearly linear
constexpr double kTolerance = 1e-5;                        // of the cosine: the cost is flat there to 1e-10

constexpr double kCorner_rad_s = 2 * std::numbers::pi * 5;
constexpr int kTerms = 4;  // T, T', T'' and a constant
constexpr int kAngle = kTerms;

/// T, T', T'', one and the angle, all behind the same filter; without the filter's own transient.
Eigen::MatrixXd forced_rows(const Segment& segment) {
  const double dc = kCorner_rad_s * kCorner_rad_s;
  const WheelArm filter{1, 2 * kCorner_rad_s, dc};
  const TorqueSignal angle_signal =
      TorqueSignal::from_samples(segment.time_s, segment.angle_rad, TorqueSignal::Between::kBandLimited);
  const std::vector<WheelState> torque =
      free_run_states(filter, segment.torque, segment.time_s, {segment.net_torque_nm.front() / dc, 0});
  const std::vector<double> angle = free_run(filter, angle_signal, segment.time_s, {segment.angle_rad.front() / dc, 0});
  const double span_s = segment.time_s.back() - segment.time_s.front();
  const double settled_s = segment.time_s.front() + std::min(8 / kCorner_rad_s, span_s / 4);
  const auto first = static_cast<std::size_t>(
      std::lower_bound(segment.time_s.begin(), segment.time_s.end(), settled_s) - segment.time_s.begin());
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(segment.size() - first), kTerms + 1);
  for (std::size_t i = first; i < segment.size(); ++i) {
    const double second =
        segment.net_torque_nm[i] - 2 * kCorner_rad_s * torque[i].rate_rad_s - dc * torque[i].angle_rad;
    rows.row(static_cast<Eigen::Index>(i - first)) << torque[i].angle_rad, torque[i].rate_rad_s, second, 1, angle[i];
  }
  return rows;
}

double power(const std::vector<Eigen::VectorXd>& residuals) {
  double sum = 0;
  for (const Eigen::VectorXd& one : residuals) sum += one.squaredNorm();
  return sum;
}

struct Solution {
  Eigen::Vector<double, kTerms> c = Eigen::Vector<double, kTerms>::Zero();
  Eigen::Matrix<double, kTerms, kTerms> covariance;
};

Solution least_squares(const std::vector<Eigen::MatrixXd>& segments, const Autoregression& noise) {
  constexpr int kAll = Autoregression::kColumns;
  Eigen::Matrix<double, kAll, kAll> gram = Eigen::Matrix<double, kAll, kAll>::Zero();
  double samples = 0;
  for (const Eigen::MatrixXd& segment : segments) {
    Autoregression::Rows rows = Autoregression::Rows::Zero(segment.rows(), kAll);
    rows.leftCols<kTerms + 1>() = segment;
    Autoregression::Rows white = rows;
    if (noise.order() > 0) noise.whiten(rows, white);
    gram += white.transpose() * white;
    samples += static_cast<double>(segment.rows());
  }
  const Eigen::Vector<double, kTerms> scale =
      gram.diagonal().head<kTerms>().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::Matrix<double, kTerms, kTerms> inverse =
      scale.asDiagonal() *
      Eigen::Matrix<double, kTerms, kTerms>(scale.asDiagonal() * gram.topLeftCorner<kTerms, kTerms>() *
                                            scale.asDiagonal())
          .inverse() *
      scale.asDiagonal();
  Solution found;
  found.c = inverse * gram.col(kAngle).head<kTerms>();
  const double left = gram(kAngle, kAngle) - found.c.dot(gram.col(kAngle).head<kTerms>());
  found.covariance = inverse * (std::max(left, 0.0) / std::max(1.0, samples - kTerms - noise.order()));
  return found;
}

/// Share of the filtered angle's power that the forced motion explains.
double explained(const std::vector<Eigen::MatrixXd>& segments, const Solution& found) {
  double power = 0, left = 0;
  for (const Eigen::MatrixXd& rows : segments) {
    const Eigen::VectorXd angle = rows.col(kAngle);
    power += (angle.array() - angle.mean()).square().sum();
    left += (angle - rows.leftCols<kTerms>() * found.c).squaredNorm();
  }
  return 1 - left / power;
}

}  // namespace

InertiaDoubt::InertiaDoubt(OutputError& problem, const Iteration& at, double variance, double period_s)
    : problem_(problem), at_(at), variance_(variance), highest_rad_s_(std::numbers::pi / period_s) {}

bool InertiaDoubt::possible(bool damping_seen) const {
  const double stiffness = at_.x[kStiffness];
  if (!(stiffness > 0)) return false;
  return !damping_seen || stiffness / at_.x[kInertia] > std::pow(highest_rad_s_ / 6, 2);
}

/// Started with enough damping for the model not to ring along with the noise from the first step on.
Iteration InertiaDoubt::with(double inertia, const Iteration& near) {
  const double stiffness = near.x[kStiffness];
  const double damping = std::max(near.x[kDamping], 0.2 * std::sqrt(std::abs(stiffness) * inertia));
  return gauss_newton(problem_, problem_.complete({inertia, damping, stiffness}).x, kMaxSteps, kTolerance, 1);
}

const Iteration& InertiaDoubt::massless() {
  if (!massless_) massless_ = with(at_.x[kStiffness] / std::pow(100 * highest_rad_s_, 2), at_);
  return *massless_;
}

bool InertiaDoubt::is_line(double sd) {
  const double promised = std::pow(at_.x[kInertia] / sd, 2);
  // What the strongest of N lines is worth: exceeded once in e^8 by chance.
  const double strongest_line = 16 + 4 * std::log(static_cast<double>(problem_.samples()));
  (void)problem_.evaluate(at_.x);
  const double left = power(problem_.residuals());
  const double paid = squares(massless()) - squares(at_);
  // A colour that was estimated around a line makes room for it. What is left of the angle itself does not.
  if (power(problem_.residuals()) < left) return true;
  return paid < 0.1 * promised && paid < strongest_line;
}

std::optional<double> largest_inertia(std::span<const Segment> segments, int max_order) {
  std::vector<Eigen::MatrixXd> rows;
  for (const Segment& segment : segments) rows.push_back(forced_rows(segment));
  Solution found = least_squares(rows, {});
  // The residual's colour twice: the second time from a residual that was fitted with the first.
  for (int round = 0; round < 2; ++round) {
    std::vector<Eigen::VectorXd> residuals;
    for (const Eigen::MatrixXd& one : rows) residuals.emplace_back(one.col(kAngle) - one.leftCols<kTerms>() * found.c);
    found = least_squares(rows, Autoregression::fit(residuals, max_order));
  }
  const double c0 = found.c[0];
  const double sd = std::sqrt(found.covariance(2, 2)) / (c0 * c0);
  const double inertia = (found.c[1] * found.c[1] / c0 - found.c[2]) / (c0 * c0);
  const bool spring = c0 > 3 * std::sqrt(found.covariance(0, 0)) && explained(rows, found) > 0.5;
  if (!spring || !std::isfinite(sd) || !(inertia > -10 * sd)) return std::nullopt;
  return std::abs(inertia) + 3 * sd;
}

}  // namespace steerid
