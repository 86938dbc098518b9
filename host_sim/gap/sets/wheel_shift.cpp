// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/wheel_shift.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "gap/likelihood/fit_spread.hpp"
#include "gap/likelihood/student.hpp"
#include "gap/model/point.hpp"

namespace steerid::gap {
namespace {

/// Of J, B, C from those that are given.
double shift_of(const Eigen::Vector3d& given, const Eigen::Vector3d& found) {
  double sum = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (!(given[i] > 0)) continue;
    const double change = std::log(std::max(found[i], 1e-6 * given[i]) / given[i]) / kUsualError;
    sum += std::log(1 + change * change);
  }
  return sum;
}

}  // namespace

double shift_at_least(const WheelArm& sim, const Whittle::Fit& fit) {
  const Eigen::Vector3d given = Point{sim}.numbers();
  if (fit.information.rows() < 3) return shift_of(given, fit.x.head<3>());  // judged where it is, not fitted
  const Eigen::MatrixXd covariance = fit.excess(kSeen) * covariance_of(fit.information);
  Eigen::Vector3d nearest;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double reach = kOnceIn370 * std::sqrt(covariance(i, i));
    nearest[i] = std::clamp(given[i], fit.x[i] - reach, fit.x[i] + reach);
  }
  return shift_of(given, nearest);
}

}  // namespace steerid::gap
