// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The torque that a driver adds and no sensor sees: slow, coloured, below 1 Hz. Many tones of random phase whose power
// falls as that of first-order low-passed noise; the corner is drawn from 0.08 to 0.4 Hz.
#pragma once

#include <cstdint>

#include "blind/signal.hpp"

namespace steerid::blind {

/// Of this rms over its span.
[[nodiscard]] Signal slow_torque(double rms_nm, double from_s, double to_s, std::uint64_t seed);

}  // namespace steerid::blind
