// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What many drives with a known answer say of a method. Every figure carries the interval that so many drives leave.
//
//   bias      mean error over the true value; its standard error beside it
//   rmse      root mean square error; over the Cramer-Rao bound: `ratio`. Interval: mean square +- 1.96 of its standard
//             error, from the errors' own fourth moment, so that a few wild drives widen it
//   coverage  share of drives whose 95 % interval, value +- 1.96 sd, holds the truth; interval by Wilson (1927)
//   NEES      mean of e' P^-1 e, e the three errors and P their stated covariance: 3 when P is true (Bar-Shalom et al.
//             2001, section 5.4). Over n drives n NEES is chi-square with 3 n degrees of freedom; limits by Wilson and
//             Hilferty (1931)
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "study/estimators.hpp"

namespace steerid {

struct Interval {
  double low = 0;
  double high = 0;
};

struct ParameterScore {
  double truth = 0;
  double bound = 0;  ///< Cramer-Rao standard deviation
  double bias_percent = 0;
  double bias_error_percent = 0;  ///< standard error of the bias
  double rmse = 0;
  double ratio = 0;  ///< rmse / bound
  Interval ratio_95;
  std::optional<double> coverage;  ///< 0 to 1; nothing where the method states no deviation
  Interval coverage_95;
};

struct MethodScore {
  std::array<ParameterScore, 3> parameters;  ///< J, B, C
  std::size_t drives = 0;
  std::size_t answered = 0;   ///< drives on which the method found a wheel; the figures are of these
  std::size_t restarted = 0;  ///< drives on which the recursive identifier started again at least once
  std::optional<double> nees;
  Interval nees_95;  ///< where the mean lies in 95 % of such studies when the covariance is true
};

[[nodiscard]] MethodScore score(const Eigen::Vector3d& truth, const Eigen::Matrix3d& bound,
                                const std::vector<std::optional<MethodAnswer>>& answers);

}  // namespace steerid
