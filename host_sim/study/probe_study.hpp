// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the task's own probe costs and reaches (firmware/app/probe.hpp), beside a flat one of a fixed size that is there
// all the time.
//
//   probe      columns drawn as in `study column`, arms that stay, a driver who holds still or means 0.03, 0.1 or 0.2
//   rad
//              rms; the task asks the EPS for what it needs, or the EPS adds 0.2 to 5 Hz of 1 or 0.5 Nm rms
//   delivered  the task's own probe by an EPS that delivers it 5 to 30 ms late, smaller, or clipped
//
// Reached: from when on J, B and C have once had deviations of less than a tenth. Felt: root mean square of the
// difference that the probe makes to the hand's torque on the rim, by the same drive without it; the driver means the
// same in both.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct ProbeStudy {
  std::size_t drives = 12;  ///< of 300 s in each case: an hour
  std::uint64_t seed = 1;
};

/// Figures: tables "probe" and "delivered".
[[nodiscard]] Findings run_probe_study(const ProbeStudy& study, const StudyProgress& at);

}  // namespace steerid
