// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The faults campaign: every defect of a sensor and of the bus, and mixtures of two, at random onsets and for random
// lengths, under a probe; one fault in three is a loose contact of less than half a second.
//
//   detected    from the onset to the first tick that is not `valid`
//   misled      time beyond 2 s after the onset, while the fault lasts, on which a parameter is `valid` and wrong
//   recovery    from the fault's end until the answer is valid and not wrong, to stay
//   counters    drives whose counters are not exactly what the bus did, where that can be counted off
//   unsound     ticks with a number that is not finite, a covariance that is not positive, an output
//               out of its range, or `valid` and `fault` at once
//
// Wrong: farther from the truth than three standard deviations and three percent. A fault is asked to mislead for 2 s
// at most and to be gone 5 s after its end, but for those that three channels cannot show (FaultClass::kNotVisible):
// their figures are told and nothing is asked of them but soundness.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct FaultStudy {
  std::size_t drives = 20;  ///< of each defect; ten times as many mixtures
  std::uint64_t seed = 1;
  double unmeasured_percent = 0;  ///< rms of slow torque that no sensor sees, of the probe's
};

/// Figures: table "faults", row "refused, Loss30"; the mixtures are row "mixture, two of these".
[[nodiscard]] Findings run_fault_study(const FaultStudy& study, const StudyProgress& at);

}  // namespace steerid
