// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Lines for the log: to standard error, one a call, with the level before it where systemd reads them ("<4>...", see
// sd-daemon(3)). Nothing allocates; what is longer than kLongest characters is cut.
#pragma once

namespace steerid::linux_ecu {

enum class Level : char { kError = '3', kWarning = '4', kNotice = '5', kInfo = '6' };

inline constexpr int kLongest = 400;

/// printf's rules.
[[gnu::format(printf, 2, 3)]] void log(Level level, const char* format, ...);

}  // namespace steerid::linux_ecu
