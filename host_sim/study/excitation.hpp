// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is called valid on drives that show some of the parameters, all or none.
//
// Seven drives of the nominal arm with a production wheel's sensors: the paper's passive triangle, one sine of 0.25 Hz,
// a long curve, a straight road with hands that lie still, restless hands, a driver who steers, a full probe. Each
// without torque that no sensor sees, with 2 % and with 10 % of it (of the rms of what the drive applies; on the
// straight road of the probe's), below 1 Hz. Of all ticks, for each parameter:
//
//   valid, converging, holding: the identifier's words; the rest is `starting` or `not excited`
//   wrong        of the valid ones, with the truth outside the 95 % interval; its standard error is over the drives
//   knowable     the Cramer-Rao bound of all samples so far is at most 10 % of the value
//   shown        and so is that of the last 5 s by themselves (drive_information.hpp)
//   overclaimed  valid though not knowable
//   unused       not valid though shown
//
// The bound knows the noise, its colour and that the arm stays the same; the identifier has to find that out.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct ExcitationStudy {
  std::size_t drives = 1000;      ///< over all 21 cases; rounded up to a multiple of them
  double straight_road_s = 3600;  ///< how long the straight road lasts
  std::uint64_t seed = 1;
};

/// Figures: table "ticks", row "triangle, none, J", keys "valid_percent" and so on.
[[nodiscard]] Findings run_excitation_study(const ExcitationStudy& study, const StudyProgress& at);

}  // namespace steerid
