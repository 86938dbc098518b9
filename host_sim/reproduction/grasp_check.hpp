// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Section IV.C: the moment reconstructed from the forces at the grasp, for each hand position.
#pragma once

#include <vector>

#include "reproduction/experiment_run.hpp"

namespace steerid {

struct GraspCheck {
  HandPosition hands;
  double moment_rms_nm = 0;       ///< of the true driver's torque
  double largest_force_n = 0;     ///< of one hand, in either direction
  double error_rms_nm = 0;        ///< reconstructed moment less true torque: transducers and telemetry
  double fixed_error_rms_nm = 0;  ///< the same if the wheel's angle were left out, as figure 3 draws it
};

/// Of a recording in the active task, where the wheel turns by about 1 rad.
[[nodiscard]] GraspCheck check_grasp(HandPosition hands, const Recording& recording);

}  // namespace steerid
