// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a textbook would try first, each in its usual form: the yardsticks beside the project's own methods.
//
//   central differences    th' = (th+ - th-)/2T, th'' = (th+ - 2 th + th-)/T^2, then least squares of the torque. The
//                          second difference carries 6 s^2/T^4 of noise: J is dragged towards zero.
//   state-variable filter  torque and angle both pass 1/(s + 2 pi 5 Hz)^2, whose states give the derivatives; least
//                          squares (Young 1964; Garnier and Wang 2008, section 1.3). The regressor still carries noise.
//   discrete ARX           th[k] = -a1 th[k-1] - a2 th[k-2] + b0 T[k] + b1 T[k-1] + b2 T[k-2] by least squares; poles
//                          mapped back by the logarithm, s = log(z)/T, and C from the gain at rest.
//
// The first two state sigma^2 (Phi' Phi)^-1, as least squares does; mapped back, ARX states nothing here.
#pragma once

#include <optional>

#include "log/record.hpp"
#include "study/estimators.hpp"

namespace steerid {

/// All expect equal sampling. Nothing when the record is too short or the answer is no wheel.
[[nodiscard]] std::optional<MethodAnswer> central_differences(const Record& record);
[[nodiscard]] std::optional<MethodAnswer> state_variable_filter(const Record& record);
[[nodiscard]] std::optional<MethodAnswer> arx(const Record& record);

}  // namespace steerid
