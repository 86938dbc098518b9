// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How the estimate keeps through minutes that show nothing, how it follows another arm, and how often it takes the arm
// for another one without cause.
//
//   keeping     20 s of probe, then 120 s of a long curve or of nothing: the farthest that J, B and C go from where
//               they were, in percent
//   following   B doubled and C tripled under a probe, at any phase of it: time until all three are within 15 % to stay
//   resets      hours of mixed driving, one arm all through: how often the change detector rings, with a 95 % interval
//               of the rate (Poisson; Garwood 1936)
//   returning   a wheel that was alone for 20 s (J 0.018 kg m2, B 0.08 Nms/rad, C 1 Nm/rad) is taken by a hand (C 17)
//               under a small probe: how long C is off by more than 15 %, and how long it is so and called valid
//
// Each without torque that no sensor sees and with some of it below 1 Hz, in percent of the rms that the drive applies;
// at rest of the curve's 5 Nm, as of the same driver.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct TrackingStudy {
  std::size_t drives = 100;  ///< in each case
  std::size_t hours = 20;    ///< of mixed driving in each case
  std::size_t changes = 24;  ///< drives of each kind of change (study/arm_changes.hpp); 0: none
  std::uint64_t seed = 1;
  double angle_offset_rad = 0;  ///< of the angle's sensor, in the drives of the changes
};

/// Figures: tables "keeping", "following", "resets" and "returning", and those of study/arm_changes.hpp.
[[nodiscard]] Findings run_tracking_study(const TrackingStudy& study, const StudyProgress& at);

}  // namespace steerid
