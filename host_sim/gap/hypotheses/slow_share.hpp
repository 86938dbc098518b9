// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How large a driver's unmeasured slow torque is, as a share of the applied torque's rms. Whoever holds a wheel adds
// some torque that no sensor sees, below 1 Hz: up to 2 % of what is applied, and part of the floor. From 5 % on it is a
// cause of its own, `unmeasured_torque`.
#pragma once

namespace steerid::gap {

/// By then nothing of it is left: the lines and the band of which it can be a part end here.
inline constexpr double kSlowTop_hz = 2;

/// The most that every driver has, estimated on a minute.
inline constexpr double kUsualSlowShare = 0.022;

/// What such a torque leaves of a difference of friction on average.
inline constexpr double kMeanSlowShare = 0.01;

/// The most that a single tone below kSlowToneEnd_hz may have and be taken for such a torque, whose colours are no
/// tones.
inline constexpr double kSlowToneShare = 0.025;
inline constexpr double kSlowToneEnd_hz = 1.1;

/// The least that is a cause.
inline constexpr double kCauseSlowShare = 0.05;

/// As far from the usual as from a cause by its logarithm: what is larger is a cause.
inline constexpr double kSlowShareBetween = 0.033;

/// What a cause is expected to have before the record is looked at.
inline constexpr double kExpectedCauseShare = 0.08;

/// Sizes that are looked at: a scan in steps of that ratio.
inline constexpr double kSmallestSlowShare = 0.0007;
inline constexpr double kLargestSlowShare = 0.7;
inline constexpr double kSlowShareStep = 1.2;

/// Beyond it the driver is steering, not restless.
inline constexpr double kSteeringSlowShare = 0.25;

}  // namespace steerid::gap
