// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/wheel_shift.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "gap/likelihood/fit_spread.hpp"
#include "gap/likelihood/prior.hpp"
#include "gap/likelihood/student.hpp"
#include "gap/model/point.hpp"

namespace steerid::gap {

double shift_at_least(const WheelArm& sim, const Whittle::Fit& fit) {
  const Eigen::Vector3d given = Point{sim}.numbers();
  Eigen::VectorXd reach = Eigen::VectorXd::Zero(3);  // of what was judged where it is, not fitted
  if (fit.information.rows() >= 3) {
    reach = kOnceIn370 * (fit.excess(kSeen) * covariance_of(fit.information).diagonal()).cwiseSqrt();
  }
  double sum = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    sum += Prior::of_given(given[i]).cost(std::clamp(given[i], fit.x[i] - reach[i], fit.x[i] + reach[i]));
  }
  return sum;
}

}  // namespace steerid::gap
