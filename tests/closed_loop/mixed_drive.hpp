// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The soak's drive on a wheel of the test's own, for the comparison of number types.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "port/sample.hpp"
#include "study/drive_stretch.hpp"

namespace steerid::test {

inline constexpr double kTurn = 6.283185307179586;

/// A wheel of the test's own: J th'' + B th' + C th = T in steps of 0.25 ms, T on a straight line over the tick.
struct Wheel {
  double angle = 0;
  double rate = 0;
  void step(double from_nm, double to_nm) {
    for (int i = 0; i < 40; ++i) {
      const double torque = from_nm + (to_nm - from_nm) * (i + 0.5) / 40;
      rate += 0.00025 * (torque - 1.5 * rate - 22.7 * angle) / 0.11;
      angle += 0.00025 * rate;
    }
  }
};

class MixedDrive {
 public:
  explicit MixedDrive(std::uint64_t seed) : random_(seed) {}

  Sample next(Stretch stretch) {
    const double t_s = 0.01 * static_cast<double>(tick_);
    const double before = torque_;
    Sample sample;
    sample.stamp_us = tick_++ * kTickPeriodUs;
    switch (stretch) {
      case Stretch::kExcited:
        torque_ = 1.5 * std::sin(kTurn * 0.4 * t_s) + std::sin(kTurn * 1.3 * t_s) + std::sin(kTurn * 3.1 * t_s);
        break;
      case Stretch::kQuiet:
        torque_ = 0;
        break;
      case Stretch::kHeld:
        torque_ = 3;
        break;
      case Stretch::kZero:
        return sample;  // to the bit, as from sensors that are switched off
      case Stretch::kFaulty:
        break;
    }
    wheel_.step(before, torque_);
    sample.angle_urad = integer(wheel_.angle * 1e6 + 700 * normal_(random_));
    sample.torque_driver_mnm = integer(torque_ * 1e3 + 30 * normal_(random_));
    if (stretch == Stretch::kFaulty) {
      const auto bits = [this] { return random_(); };
      spoil(sample, bits, [&bits](std::int32_t) { return static_cast<std::int64_t>(bits()); });
    }
    return sample;
  }

  bool chance(int one_in) { return random_() % static_cast<unsigned>(one_in) == 0; }

 private:
  static std::int32_t integer(double x) { return static_cast<std::int32_t>(std::lround(x)); }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Wheel wheel_;
  double torque_ = 0;
  std::int64_t tick_ = 0;
};

}  // namespace steerid::test
