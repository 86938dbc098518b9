// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How large a driver's unmeasured slow torque is, as a share of the applied torque's rms. Whoever holds a wheel adds
// some torque that no sensor sees, below 1 Hz: up to 2 % of what is applied, and part of the floor. From 5 % on it is a
// cause of its own, `unmeasured_torque`.
#pragma once

namespace steerid::gap {

/// The most that every driver has, estimated on a minute.
inline constexpr double kUsualSlowShare = 0.022;

/// The least that is a cause.
inline constexpr double kCauseSlowShare = 0.05;

/// As far from the one as from the other by its logarithm: what is larger is a cause.
inline constexpr double kSlowShareBetween = 0.033;

/// Beyond it the driver is steering, not restless.
inline constexpr double kSteeringSlowShare = 0.25;

}  // namespace steerid::gap
