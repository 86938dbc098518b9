// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What sensors and a driver's own slow torque leave of the angle, as a spectrum with few numbers:
//
//   S(f) = v_angle + |H(f)|^2 (v_torque + v_slow / (1 + (f/f0)^2)^n),   H = 1/(J s^2 + B s + C)
//
// v_angle and v_torque are white; the slow torque that no sensor sees ends at f0, and falls off with the fourth power
// of frequency (n = 2; f0 one of 0.1, 0.2, 0.4, 0.8 Hz, the noise model of gap/likelihood/noise_floor.hpp) or with the
// square (n = 1; 0.1 or 0.4 Hz). A free autoregression needs ten to thirty coefficients for the wheel's resonance in
// that; estimated from one record, they make B's standard deviation up to a tenth too small (docs/adr/0009).
//
// The shares are those of the largest conditional likelihood of the residual (Box, Jenkins and Reinsel, Time Series
// Analysis, 2008, section 7.1), worked out from lagged products. Each part's autocovariance is that of a linear system
// driven by white noise, exact: its state's covariance solves Lyapunov's equation and decays with the system's
// exponential. The sum's autocovariance becomes a long autoregression by Levinson's recursion.
#pragma once

#include <optional>
#include <vector>

#include "fit/autoregression.hpp"
#include "fit/lagged_products.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

/// The angle's autocovariance at the lags 0 .. last_lag periods when `wheel` is moved by white torque (per sample
/// variance one) that has passed `poles` low passes 1/(1 + s/(2 pi corner_hz)). The wheel must come to rest by itself:
/// J, B and C positive.
[[nodiscard]] std::vector<double> angle_autocovariance(const WheelArm& wheel, double corner_hz, int poles,
                                                       double period_s, int last_lag);

/// The noise that explains the residual best. Nothing where `wheel` does not come to rest by itself, or where segments
/// are too short to tell.
[[nodiscard]] std::optional<Autoregression> wheel_noise(const LaggedProducts& residual, const WheelArm& wheel,
                                                        double period_s);

}  // namespace steerid
