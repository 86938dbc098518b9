// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a verdict can be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace steerid::gap {

/// All ids a ranking holds, in the vocabulary's order: none, parameters, the effects, unknown.
[[nodiscard]] const std::vector<std::string>& verdict_ids();

/// Whether an id is an effect's: none, parameters and unknown are not.
[[nodiscard]] bool names_effect(std::string_view id);

}  // namespace steerid::gap
