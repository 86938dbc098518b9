// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a driver's hands do beyond the arm's inertia, damping and stiffness: the measured torque T_driver.
//
// Holding (passive task, probe): the driver wants the wheel at 0 and co-contracts; that is the arm's stiffness, in the
// model. What is left is a slow restlessness and physiological tremor, small against the disturbance.
//
// Steering (active task): the driver turns the wheel as a sine of about 1 rad at 0.25 Hz (Lv et al. 2018, section V.B)
// from knowledge of the arm, without feedback. With G = (C - J w0^2) + i B w0 the torque is
//   T(t) = fade(t) { a(t) [Re G sin phi(t) + Im G cos phi(t)] + C o(t) } + corrections(t) + tremor(t)
// so that the wheel follows a(t) sin phi(t) + o(t). Amplitude a, phase phi = w0 t + wander and offset o drift smoothly
// and independently, so no two cycles are the same; corrections stand for the sub-movements of a human sine. fade rises
// from 0 to 1 within the first two seconds.
#pragma once

#include <cstdint>

#include "experiment/signal_point.hpp"
#include "experiment/smooth_noise.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

class HoldingDriver {
 public:
  HoldingDriver(std::uint64_t seed, std::uint64_t first_stream);

  SignalPoint next() { return restlessness_.next() + tremor_.next(); }

 private:
  SmoothNoise restlessness_;  // 0.15 Nm below 0.5 Hz
  SmoothNoise tremor_;        // 0.02 Nm around 9 Hz
};

struct SteeringSettings {
  double amplitude_rad = 1.0;  ///< "around 1.0 rad (i.e. 60 degrees)"
  double frequency_hz = 0.25;
  double amplitude_spread = 0.06;  ///< standard deviation over the cycles, relative
  double period_spread = 0.05;     ///< standard deviation of the momentary frequency, relative
  double offset_spread_rad = 0.05;
  double correction_share = 0.03;  ///< rms of the corrections, relative to that of the torque
};

class SteeringDriver {
 public:
  SteeringDriver(const SteeringSettings& settings, const WheelArm& arm, std::uint64_t seed, std::uint64_t first_stream);

  SignalPoint next();

  /// rms of the torque that this driver means to apply.
  [[nodiscard]] double nominal_rms_nm() const;

 private:
  [[nodiscard]] SignalPoint steering(SignalPoint amplitude, SignalPoint wander, SignalPoint offset) const;
  [[nodiscard]] SignalPoint fade() const;

  SteeringSettings settings_;
  double stiffness_nm_per_rad_;
  double in_phase_nm_per_rad_;    // Re G
  double quadrature_nm_per_rad_;  // Im G
  SmoothNoise amplitude_;
  SmoothNoise wander_;
  SmoothNoise offset_;
  SmoothNoise corrections_;
  SmoothNoise tremor_;
  std::int64_t tick_ = 0;
};

}  // namespace steerid
