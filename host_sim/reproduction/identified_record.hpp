// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One record of the experiment, identified twice: by the loop that is flashed, and by batch Gauss-Newton.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "fit/amplitude_fit.hpp"
#include "log/record.hpp"
#include "plant/wheel_arm.hpp"
#include "port/estimate.hpp"
#include "reproduction/recording.hpp"

namespace steerid {

/// J, B, C with one standard deviation each and the state of each.
struct ArmAnswer {
  std::array<double, 3> value{};  ///< SI units
  std::array<double, 3> sd{};
  std::array<ParameterState, 3> state{};

  [[nodiscard]] bool valid(int parameter) const {
    return state[static_cast<std::size_t>(parameter)] == ParameterState::kValid;
  }
  [[nodiscard]] bool all_valid() const { return valid(0) && valid(1) && valid(2); }
  [[nodiscard]] WheelArm wheel() const { return {value[0], value[1], value[2]}; }
  /// Equation 5, only of parameters that are all valid.
  [[nodiscard]] std::optional<NaturalFrequency> frequency() const;
};

struct IdentifiedRecord {
  std::size_t subject = 0;  ///< from 0
  RecordingSettings what;   ///< the true arm among it
  ArmAnswer recursive;      ///< the firmware's loop in float, at the end of the record
  ArmAnswer batch;
  DriverState driver = DriverState::kUnknown;  ///< what the firmware says at the end
  ModelQuality quality;                        ///< of the batch answer; figure 7
  std::optional<double> true_arm_fit_percent;  ///< what the true J, B, C would score: the rest is not the parameters'
  double convergence_factor = 0;               ///< ||[J'J]^-1 H||, equation 27
  int gauss_newton_steps = 0;
};

/// The estimates of the firmware's 100 Hz loop in float over a record, one a tick.
[[nodiscard]] std::vector<Estimate> firmware_estimates(const Record& record);

[[nodiscard]] IdentifiedRecord identify_recording(std::size_t subject, const RecordingSettings& settings,
                                                  const Record& record);

}  // namespace steerid
