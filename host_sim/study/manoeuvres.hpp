// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The drives on which the identifier's behaviour over time is measured.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

#include "experiment/multisine.hpp"
#include "experiment/smooth_noise.hpp"
#include "experiment/triangle.hpp"
#include "experiment/virtual_driver.hpp"
#include "study/virtual_drive.hpp"

namespace steerid {

// Streams of chance, apart from those of the sensors.
enum ManoeuvreStream : std::uint64_t {
  kSlowStream = 950,
  kUnmeasuredStream = 960,
  kDriverStream = 970,
  kMixedStream = 990
};

/// The paper's disturbance: a motor torque of 0.025 Hz and 5 Nm, the driver's hands perfectly still.
inline Manoeuvre triangle() {
  return [wave = Triangle(5.0, 4000)](const VirtualWheel&) mutable { return Torques{.motor = wave.next()}; };
}

/// One sine of motor torque.
inline Manoeuvre sine(double amplitude_nm, double frequency_hz) {
  return [=, tick = std::int64_t{0}](const VirtualWheel&) mutable {
    const double rate = 2 * std::numbers::pi * frequency_hz;
    const double phase = rate * static_cast<double>(++tick) * kTickS;
    return Torques{.motor = {amplitude_nm * std::sin(phase), amplitude_nm * rate * std::cos(phase)}};
  };
}

/// Nothing at all: a straight road and hands that lie still on the wheel.
inline Manoeuvre straight_road() {
  return [](const VirtualWheel&) { return Torques{}; };
}

/// The full probe: 0.2 to 5 Hz with phases drawn from the seed.
inline Manoeuvre probe(std::uint64_t seed, double rms_nm = 1.5) {
  return [tones = Multisine({.rms_nm = rms_nm, .random_phases = seed})](const VirtualWheel&) mutable {
    return Torques{.motor = tones.next()};
  };
}

/// A long curve: a constant driver's torque that comes on within two seconds, and slow changes of it.
inline Manoeuvre curve(double torque_nm, double slow_rms_nm, std::uint64_t seed) {
  return [=, slow = SmoothNoise({.rms = slow_rms_nm, .corner_hz = 0.1}, seed, kSlowStream),
          tick = std::int64_t{0}](const VirtualWheel&) mutable {
    const double u = static_cast<double>(tick++) * kTickS / 2.0;
    SignalPoint driver = slow.next();
    driver +=
        u < 1 ? SignalPoint{torque_nm * u * u * (3 - 2 * u), torque_nm * 3 * u * (1 - u)} : SignalPoint{torque_nm, 0.0};
    return Torques{.driver = driver};
  };
}

/// A driver who steers on purpose, as in the paper's active task.
inline Manoeuvre steering(const WheelArm& arm, std::uint64_t seed) {
  return [driver = SteeringDriver({}, arm, seed, kDriverStream)](const VirtualWheel&) mutable {
    return Torques{.driver = driver.next()};
  };
}

/// Hands that hold the wheel at 0: slow restlessness and tremor, all of it measured.
inline Manoeuvre holding(std::uint64_t seed) {
  return [driver = HoldingDriver(seed, kDriverStream)](const VirtualWheel&) mutable {
    return Torques{.driver = driver.next()};
  };
}

inline Manoeuvre together(Manoeuvre first, Manoeuvre second) {
  return [first = std::move(first), second = std::move(second)](const VirtualWheel& wheel) {
    Torques sum = first(wheel);
    const Torques more = second(wheel);
    sum.driver += more.driver;
    sum.motor += more.motor;
    sum.unmeasured += more.unmeasured;
    return sum;
  };
}

/// Torque that no sensor sees, slow and coloured as a driver's is.
inline Manoeuvre unmeasured(double rms_nm, std::uint64_t seed) {
  return [noise = SmoothNoise({.rms = rms_nm, .corner_hz = 0.3}, seed, kUnmeasuredStream)](
             const VirtualWheel&) mutable { return Torques{.unmeasured = noise.next()}; };
}

}  // namespace steerid
