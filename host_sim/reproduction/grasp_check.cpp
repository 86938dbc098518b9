// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/grasp_check.hpp"

#include <algorithm>
#include <cmath>

namespace steerid {

GraspCheck check_grasp(HandPosition hands, const Recording& recording) {
  GraspCheck check{hands};
  const std::size_t rows = recording.record.size();
  const std::size_t both = grip_angles(hands).size();
  for (std::size_t i = 0; i < rows; ++i) {
    std::array<GraspForce, 2> forces{};
    for (std::size_t hand = 0; hand < both; ++hand) {
      forces[hand] = recording.force[hand][i];
      check.largest_force_n = std::max({check.largest_force_n, std::abs(forces[hand].x_n), std::abs(forces[hand].y_n)});
    }
    const double truth = recording.driver_torque_nm[i];
    const double error = recording.record.torque_driver_nm[i] - truth;
    const double fixed = grasp_moment_nm(hands, forces, 0) - truth;
    check.moment_rms_nm += truth * truth;
    check.error_rms_nm += error * error;
    check.fixed_error_rms_nm += fixed * fixed;
  }
  for (double* sum : {&check.moment_rms_nm, &check.error_rms_nm, &check.fixed_error_rms_nm}) {
    *sum = std::sqrt(*sum / static_cast<double>(rows));
  }
  return check;
}

}  // namespace steerid
