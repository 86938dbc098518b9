// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The endless drive of a soak: excited, quiet, held, switched off, faulty stretches of the nominal arm, one sample a
// tick.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "sensors/random.hpp"
#include "study/drive_stretch.hpp"
#include "study/virtual_drive.hpp"

namespace steerid {

class SoakDrive {
 public:
  static constexpr WheelArm kArm{0.11, 1.5, 22.7};

  explicit SoakDrive(std::uint64_t seed) : random_(seed, kFaults), wheel_(kArm, seed, kSensors) {}

  Sample next(Stretch stretch) {
    const Torques before{.driver = torque_};
    torque_ = torque(stretch);
    Sample sample = wheel_.sample(before);
    wheel_.advance(before, {.driver = torque_});
    if (stretch == Stretch::kZero) return {.stamp_us = sample.stamp_us, .sequence = sample.sequence};
    if (stretch == Stretch::kFaulty) {
      const auto bits = [this] { return random_.bits(); };
      spoil(sample, bits, [&bits](std::int32_t anything) {
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(anything) * bits());
      });
    }
    return sample;
  }

  bool chance(std::uint32_t one_in) { return random_.bits() % one_in == 0; }

 private:
  static constexpr std::uint64_t kFaults = 997;
  static constexpr SensorDeviation kSensors{.angle_rad = 0.0007, .torque_driver_nm = 0.03, .torque_motor_nm = 0};

  [[nodiscard]] SignalPoint torque(Stretch stretch) const {
    if (stretch == Stretch::kFaulty) return {torque_.value, 0};
    if (stretch == Stretch::kHeld) return {3, 0};
    SignalPoint sum;
    if (stretch != Stretch::kExcited) return sum;
    const double t_s = kTickS * static_cast<double>(wheel_.tick() + 1);
    for (const auto& [amplitude_nm, frequency_hz] : {std::pair{1.5, 0.4}, {1.0, 1.3}, {1.0, 3.1}}) {
      const double rate = 2 * std::numbers::pi * frequency_hz;
      sum += {amplitude_nm * std::sin(rate * t_s), amplitude_nm * rate * std::cos(rate * t_s)};
    }
    return sum;
  }

  Random random_;
  VirtualWheel wheel_;
  SignalPoint torque_{};
};

}  // namespace steerid
