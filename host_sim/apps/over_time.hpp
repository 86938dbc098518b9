// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How an answer says how J, B and C went over time (fit/varying_arm.hpp).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/identification.hpp"
#include "fit/model_check.hpp"
#include "fit/varying_arm.hpp"

namespace steerid {

/// Friction, a bent or asymmetric spring or a delay moves an arm that stays as one that changes would, now and then.
/// Where an alternative of `check`, or the arm's own, is likelier than the change it is taken back, and what is
/// returned says why; else empty.
[[nodiscard]] std::string hold_change_against(VaryingArm& arm, const ModelCheck& check);

/// Widens the deviations of one number for the whole record until its 95 % interval holds the course, less the noise of
/// its own, for 95 % of the time: a hand that leaves in the first second makes no other wheel. One that is then not
/// known well enough is `converging`: it is no number of this arm.
void widen(Identification& found, const VaryingArm& arm);

/// A line for the terminal.
[[nodiscard]] std::string over_time_line(const VaryingArm& arm);

/// {"changes":,"likelihood_ratio":} and, of an arm that changes, time_s, damping_nms_per_rad, damping_sd_nms_per_rad,
/// stiffness_nm_per_rad, stiffness_sd_nm_per_rad, five a second, and where J changes too inertia_kgm2 and
/// inertia_sd_kgm2; null where it was not asked.
[[nodiscard]] nlohmann::ordered_json over_time_json(const std::optional<VaryingArm>& arm);

}  // namespace steerid
