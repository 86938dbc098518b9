// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Colours of what is printed for people: on a terminal only, and not where NO_COLOR is set (https://no-color.org) or
// TERM is "dumb".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace steerid {

enum class Paint : std::uint8_t { kRed, kAmber, kGreen };

/// Whether standard output takes colours.
[[nodiscard]] bool paints();

/// `text` in its colour, or as it is.
[[nodiscard]] std::string painted(Paint paint, std::string_view text);

}  // namespace steerid
