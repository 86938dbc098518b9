// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What an endless drive is made of, and what a faulty stretch of it does to a sample.
#pragma once

#include <cstdint>
#include <utility>

#include "port/sample.hpp"

namespace steerid {

enum class Stretch : std::uint8_t {
  kExcited,  ///< three sines, 0.4, 1.3 and 3.1 Hz
  kQuiet,
  kHeld,    ///< 3 Nm
  kZero,    ///< to the bit, as from sensors that are switched off
  kFaulty,  ///< the torque of before, and five samples in eight spoiled: anything on a channel, a stamp, the valid bits
};

/// Spoils five samples in eight. `bits` gives 32 random bits or more; `any_stamp` a stamp, made of 32 of them if it
/// likes.
template <class Bits, class AnyStamp>
void spoil(Sample& sample, const Bits& bits, const AnyStamp& any_stamp) {
  const auto anything = static_cast<std::int32_t>(bits());
  switch (bits() % 8) {
    case 0:
      sample.angle_urad = anything;
      break;
    case 1:
      sample.torque_driver_mnm = anything % 50'000;
      break;
    case 2:
      sample.stamp_us = any_stamp(anything);
      break;
    case 3:
      sample.valid_bits = static_cast<std::uint8_t>(anything);
      break;
    case 4:
      std::swap(sample.angle_urad, sample.torque_driver_mnm);
      break;
    default:
      break;
  }
}

}  // namespace steerid
