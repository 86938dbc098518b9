// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What of a signal is faster than a given frequency: the signal less its low pass, a centred windowed sinc (Kaiser). No
// phase, no delay, the same for torque and angle, so that T = J th'' + B th' + C th holds of what is left.
//
//   from `from_hz` on         within 1e-3 of what it was
//   below from_hz - 0.5 Hz   60 dB down
//
// The filter reaches 3.6 s to both sides; at the ends of a stretch the signal goes on as its own mirror image through
// the last sample.
#pragma once

#include <vector>

#include "log/record.hpp"

namespace steerid::gap {

inline constexpr double kTransition_hz = 0.5;

/// `signal` has one value a sample, at 100 Hz. Samples that are not finite stay so, and count as zero for the others.
/// All of it where `from_hz` is zero.
[[nodiscard]] std::vector<double> fast_part(std::vector<double> signal, double from_hz);

/// What a model makes of a record's fast part holds what the filter lets pass below `from_hz`, too; this takes off what
/// is slower than anything that is left in the record: what a wheel without a spring, or one that changes, makes of its
/// own. All of it where `from_hz` is zero.
[[nodiscard]] std::vector<double> without_drift(std::vector<double> signal, double from_hz);

/// Of the torques that drive a simulation and of the angle; every stretch between gaps by itself.
[[nodiscard]] Record fast_part(Record record, double from_hz);

}  // namespace steerid::gap
