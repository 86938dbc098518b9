// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/score.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fit/certainty.hpp"

namespace steerid {
namespace {

/// Wilson's score interval of a share.
Interval wilson(double share, double n) {
  const double z2 = kNormal95 * kNormal95;
  const double centre = (share + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kNormal95 / (1 + z2 / n) * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n));
  return {centre - half, centre + half};
}

/// Where the mean of n chi-squares with 3 degrees of freedom lies in 95 % of cases.
Interval nees_limits(double n) {
  const auto at = [n](double z) {
    const double c = 2 / (9 * 3 * n);
    return 3 * std::pow(1 - c + z * std::sqrt(c), 3);
  };
  return {at(-kNormal95), at(kNormal95)};
}

ParameterScore score_parameter(int i, double truth, double bound,
                               const std::vector<std::optional<MethodAnswer>>& answers) {
  double n = 0;
  double sum = 0;
  double square = 0;
  double fourth = 0;
  double inside = 0;
  bool states_deviation = true;
  for (const std::optional<MethodAnswer>& answer : answers) {
    if (!answer) continue;
    const double error = answer->value(i) - truth;
    ++n;
    sum += error;
    square += error * error;
    fourth += std::pow(error, 4);
    states_deviation = states_deviation && answer->covariance.has_value();
    if (answer->covariance && std::abs(error) <= kNormal95 * std::sqrt((*answer->covariance)(i, i))) ++inside;
  }
  ParameterScore out;
  out.truth = truth;
  out.bound = bound;
  if (n < 2) return out;
  const double mean = sum / n;
  const double mean_square = square / n;
  const double square_error = std::sqrt(std::max(0.0, fourth / n - mean_square * mean_square) / n);
  out.bias_percent = 100 * mean / truth;
  out.bias_error_percent = 100 * std::sqrt(std::max(0.0, mean_square - mean * mean) / n) / truth;
  out.rmse = std::sqrt(mean_square);
  out.ratio = out.rmse / bound;
  out.ratio_95 = {std::sqrt(std::max(0.0, mean_square - kNormal95 * square_error)) / bound,
                  std::sqrt(mean_square + kNormal95 * square_error) / bound};
  if (states_deviation) {
    out.coverage = inside / n;
    out.coverage_95 = wilson(inside / n, n);
  }
  return out;
}

/// e' P^-1 e, with P scaled to a unit diagonal first.
double normalised_square(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::Vector3d scaled = scale.cwiseProduct(error);
  return scaled.dot(correlation.inverse() * scaled);
}

}  // namespace

MethodScore score(const Eigen::Vector3d& truth, const Eigen::Matrix3d& bound,
                  const std::vector<std::optional<MethodAnswer>>& answers) {
  MethodScore out;
  out.drives = answers.size();
  double squares = 0;
  bool states_covariance = true;
  for (const std::optional<MethodAnswer>& answer : answers) {
    if (!answer) continue;
    ++out.answered;
    if (answer->restarts > 0) ++out.restarted;
    states_covariance = states_covariance && answer->covariance.has_value();
    if (answer->covariance) squares += normalised_square(answer->value - truth, *answer->covariance);
  }
  if (out.answered > 0 && states_covariance) {
    out.nees = squares / static_cast<double>(out.answered);
    out.nees_95 = nees_limits(static_cast<double>(out.answered));
  }
  for (int i = 0; i < 3; ++i) {
    out.parameters[static_cast<std::size_t>(i)] = score_parameter(i, truth(i), std::sqrt(bound(i, i)), answers);
  }
  return out;
}

}  // namespace steerid
