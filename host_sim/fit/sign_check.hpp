// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether a record's torques seem to be written the wrong way round.
//
// The contract: positive torque of the driver turns the wheel towards positive angles, positive torque of the motor
// turns it back. A channel with the other sign makes a record that no wheel, or only an absurd one, explains; with the
// sign turned it is an ordinary one. So the record is fitted again with the driver's torque, the motor's and both
// turned round, and a sign is doubted when that leaves less than a quarter of what stays unexplained as it stands, and
// the wheel behind it is a physical one. A wheel with friction, backlash or a reflex misses the linear model in either
// sign about alike, and is not accused. Where one torque is a multiple of the other (an assistance without a probe)
// both signs explain the record equally well: nothing can be said.
//
// Cost: a white fit, and up to three more where that leaves more than a thousandth.
#pragma once

#include <limits>

#include "log/record.hpp"

namespace steerid {

struct SignCheck {
  bool torque_driver = false;  ///< doubtful: should be turned round
  bool torque_motor = false;   ///< likewise
  /// Share of the angle's power that the best wheel leaves as the record stands, and with those channels turned round;
  /// NaN when there is nothing to fit.
  double unexplained = std::numeric_limits<double>::quiet_NaN();
  double unexplained_turned = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool doubtful() const { return torque_driver || torque_motor; }
};

/// `torque_offset` as in FitOptions.
[[nodiscard]] SignCheck check_signs(const Record& record, bool torque_offset);

}  // namespace steerid
