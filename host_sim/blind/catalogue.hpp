// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// All kinds, by id.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "blind/kind.hpp"

namespace steerid::blind {

[[nodiscard]] std::span<const Kind* const> vocabulary();  ///< 22 effects that a diagnosis knows by name
[[nodiscard]] std::span<const Kind* const> outside();     ///< effects that it does not know

/// Throws std::invalid_argument when there is none.
[[nodiscard]] const Kind& kind_called(std::string_view id);

/// Of the vocabulary, as opposed to an effect outside it.
[[nodiscard]] bool is_known(std::string_view id);

}  // namespace steerid::blind
