// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What another simulator's prediction holds beside the run of the nearest simulation of the library.
//
// The nearest simulation stands in the place of the other simulator, whose laws the library may not have. What it
// misses of the prediction is no difference between the wheel and that simulator: it is taken off the measured angle,
// so that a prediction that is the measured angle is compared as one, however little of it was understood. To first
// order in the difference the comparison is then that with the other simulator itself.
#pragma once

#include <vector>

namespace steerid::gap {

/// Of the angles at `time_s`, which rise, those at other stamps of the same clock, s: that of the nearest, 0 where none
/// lies within half a sample of 100 Hz.
[[nodiscard]] std::vector<double> angles_at(const std::vector<double>& stamps_s, const std::vector<double>& time_s,
                                            const std::vector<double>& angle_rad);

/// Empty where there is no prediction. Stamps rise, s of the log's clock; rad.
struct PredictionRemainder {
  std::vector<double> time_s{};
  std::vector<double> angle_rad{};
};

}  // namespace steerid::gap
