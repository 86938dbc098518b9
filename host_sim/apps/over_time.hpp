// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How an answer says how B and C went over time (fit/varying_arm.hpp).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "fit/model_check.hpp"
#include "fit/varying_arm.hpp"

namespace steerid {

/// Friction, a bent spring or a delay moves an arm that stays as one that changes would, now and then. Where an
/// alternative of `check` is likelier than the change it is taken back, and what is returned says why; else empty.
[[nodiscard]] std::string hold_change_against(VaryingArm& arm, const ModelCheck& check);

/// A line for the terminal.
[[nodiscard]] std::string over_time_line(const VaryingArm& arm);

/// {"changes":,"likelihood_ratio":} and, of an arm that changes, time_s, damping_nms_per_rad, damping_sd_nms_per_rad,
/// stiffness_nm_per_rad, stiffness_sd_nm_per_rad, five a second; null where it was not asked.
[[nodiscard]] nlohmann::ordered_json over_time_json(const std::optional<VaryingArm>& arm);

}  // namespace steerid
