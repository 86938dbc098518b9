// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drive with a known answer: the wheel in its steady state under a probe, as noisy sensors record it.
//
// Truth is in closed form. The probe is a multisine of equally strong tones, T = sum a cos(2 pi f_k t + phi_k); the
// angle of J th'' + B th' + C th = T in its steady state is each tone times G(f) = 1/(C - J w^2 + i B w). Nothing is
// integrated and no signal model is assumed between samples, so a drive shares no code with any estimator.
//
// What the record lacks: white noise on torque and angle, the angle's resolution, and a slow torque of the driver that
// no sensor sees. That torque is a stationary Gaussian process with the one-sided density ~ 1/(1 + (f/0.3 Hz)^2)^n,
// white noise behind n low passes: 99 % of its power lies below 1 Hz with two, 81 % with one. It is made of lines
// 1/64 Hz apart with normal amplitudes: twice a 30 s record's own resolution, so that it repeats within no record.
#pragma once

#include <cstddef>
#include <cstdint>

#include "log/record.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

/// Equally strong tones at multiples of 1/kProbePeriod_s. A record is one period: in one that repeats, the error of
/// the angle's resolution would repeat too, and would not average out.
inline constexpr double kProbePeriod_s = 30.0;
inline constexpr int kFirstTone = 6;   ///< 0.2 Hz
inline constexpr int kLastTone = 150;  ///< 5 Hz
inline constexpr int kTones = kLastTone - kFirstTone + 1;
inline constexpr double kStudyRate_hz = 100.0;

struct SteadyDrive {
  WheelArm wheel;
  double angle_noise_rad = 0;       ///< standard deviation of white noise
  double angle_step_rad = 0;        ///< resolution: the angle is rounded to its multiples; 0 is off
  double torque_noise_nm = 0.03;    ///< standard deviation of white noise
  double unmeasured_torque_nm = 0;  ///< rms of the slow torque that no sensor sees
  int unmeasured_low_passes = 2;    ///< 1 or 2
  double probe_rms_nm = 1.5;
  std::size_t samples = 3000;  ///< a whole number of the probe's periods

  [[nodiscard]] double tone_nm() const;  ///< amplitude of one tone
};

/// The unmeasured torque's power density at `f_hz` per sample: what white noise of that variance would have.
[[nodiscard]] double unmeasured_density(const SteadyDrive& drive, double f_hz);

/// Drive `number` of `seed`: its phases and its noise are the same whatever other drives are made.
[[nodiscard]] Record record_of(const SteadyDrive& drive, std::uint64_t seed, std::uint64_t number);

}  // namespace steerid
