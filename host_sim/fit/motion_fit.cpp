// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/motion_fit.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "fit/gaussian_taps.hpp"
#include "log/record_quality.hpp"

namespace steerid {
namespace {

constexpr double kPeriodS = 0.01;
constexpr double kSigmaS = 0.03;

const GaussianTaps& taps() {
  static const GaussianTaps all(kSigmaS, kPeriodS);
  return all;
}

double through(const std::vector<double>& of_taps, std::span<const double> x, std::size_t i) {
  return taps().at(of_taps, x, i);
}

/// Calls `take` for every sample with the taps' reach on both sides.
template <class Take>
void each_inner_sample(const Record& record, Take take) {
  const std::size_t reach = taps().reach();
  for (const GapFreeRows rows : gap_free_rows(record)) {
    for (std::size_t i = rows.begin + reach; i + reach < rows.end; ++i) take(i);
  }
}

double product(const std::vector<double>& one, const std::vector<double>& other) {
  return std::inner_product(one.begin(), one.end(), other.begin(), 0.0);
}

/// Variance of white noise in the angle: what is left of it in sixth differences, where a wheel's motion is not.
double angle_noise(const Record& record) {
  constexpr std::array<double, 7> kDifference = {1, -6, 15, -20, 15, -6, 1};
  constexpr double kSquares = 924;
  double sum = 0;
  double samples = 0;
  each_inner_sample(record, [&](std::size_t i) {
    double difference = 0;
    for (std::size_t k = 0; k < kDifference.size(); ++k) difference += kDifference[k] * record.angle_rad[i + k - 3];
    sum += difference * difference;
    samples += 1;
  });
  return samples > 0 ? sum / samples / kSquares : 0;
}

}  // namespace

MotionFit fit_motion(const Record& record, std::span<const double> torque_nm, bool spring,
                     std::span<const double> beside_nm) {
  const bool beside = !beside_nm.empty();
  const Eigen::Index unknowns = 3 + (spring ? 1 : 0) + (beside ? 1 : 0);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  double squares = 0;
  double sum = 0;
  MotionFit fit;
  each_inner_sample(record, [&](std::size_t i) {
    Eigen::VectorXd row(unknowns);
    row[0] = through(taps().second, record.angle_rad, i);
    row[1] = through(taps().first, record.angle_rad, i);
    row[2] = 1;
    if (spring) row[3] = through(taps().smooth, record.angle_rad, i);
    if (beside) row[unknowns - 1] = through(taps().smooth, beside_nm, i);
    const double torque = through(taps().smooth, torque_nm, i);
    normal += row * row.transpose();
    right += row * torque;
    squares += torque * torque;
    sum += torque;
    ++fit.samples;
  });
  const auto samples = static_cast<double>(fit.samples);
  const double noise = samples * angle_noise(record);
  normal(0, 0) -= noise * product(taps().second, taps().second);
  normal(1, 1) -= noise * product(taps().first, taps().first);
  if (spring) {
    normal(3, 3) -= noise * product(taps().smooth, taps().smooth);
    normal(0, 3) -= noise * product(taps().second, taps().smooth);
    normal(3, 0) = normal(0, 3);
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  // Not positive: the angle is noise and nothing else.
  if (fit.samples < taps().smooth.size() || !solver.isPositive() || !(solver.rcond() > 1e-14)) return {};
  const Eigen::VectorXd found = solver.solve(right);
  const Eigen::MatrixXd inverse = solver.solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
  const double left = std::max(0.0, squares - found.dot(right)) / samples;
  const double power = squares / samples - sum * sum / samples / samples;
  // White noise behind the Gaussian is alike over so many samples.
  const double alike = 2 * std::sqrt(std::numbers::pi) * kSigmaS / kPeriodS;
  const auto number = [&](Eigen::Index i) {
    return FittedNumber{found[i], std::sqrt(std::max(0.0, inverse(i, i) * left * alike))};
  };
  fit.inertia = number(0);
  fit.damping = number(1);
  if (spring) fit.stiffness = number(3);
  if (beside) fit.gain = number(unknowns - 1);
  fit.torque_rms_nm = std::sqrt(std::max(0.0, power));
  fit.residual_rms_nm = std::sqrt(left);
  fit.explained = power > 0 ? 1 - left / power : 0;
  return fit;
}

std::vector<double> smoothed_rate_rad_s(const Record& record) {
  std::vector<double> rate(record.size(), 0.0);
  each_inner_sample(record, [&](std::size_t i) { rate[i] = through(taps().first, record.angle_rad, i); });
  return rate;
}

double smoothed_correlation(const Record& record, std::span<const double> one, std::span<const double> other) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  each_inner_sample(record, [&](std::size_t i) {
    const double x = through(taps().smooth, one, i);
    const double y = through(taps().smooth, other, i);
    n += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
  });
  const double power = (aa - a * a / n) * (bb - b * b / n);
  return n > 0 && power > 0 ? (ab - a * b / n) / std::sqrt(power) : 0;
}

std::vector<double> explained_torque_nm(const Record& record) {
  if (!record.has(kTorqueBarValid) || !record.has(kTorqueRimValid)) return record.net_torque_nm();
  std::vector<double> between = record.torque_rim_nm;
  for (std::size_t i = 0; i < between.size(); ++i) between[i] -= record.torque_bar_nm[i];
  return between;
}

}  // namespace steerid
