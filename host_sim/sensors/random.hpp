// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A seeded random source that gives the same numbers on every machine and with every library.
//
// Generator: PCG-XSH-RR 64/32 (O'Neill 2014, "PCG: a family of simple fast space-efficient statistically good
// algorithms for random number generation"). `stream` selects one of 2^63 sequences: every source of chance in a
// simulation has its own stream, so that switching one on or off leaves the others as they were.
// uniform(): 52 bits, strictly inside (0, 1): never 0 and never 1.
// normal():  inverse of the normal distribution function at one uniform, from a table of cubics (normal_table.hpp);
//            the table is made of Wichura's algorithm AS 241. std::normal_distribution is not portable and Box-Muller
//            needs libm, whose last bit is not; here only + - * / and sqrt are used, which IEEE 754 fixes to the bit.
#pragma once

#include <cstdint>

#include "sensors/normal_table.hpp"

namespace steerid {

class Random {
 public:
  explicit constexpr Random(std::uint64_t seed, std::uint64_t stream = 0) : increment_((stream << 1U) | 1U) {
    (void)bits();
    state_ += seed;
    (void)bits();
  }

  constexpr std::uint32_t bits() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
  }

  /// Uniform in (0, 1), mean exactly one half.
  constexpr double uniform() {
    const std::uint64_t high = bits();
    const std::uint64_t k = ((high << 32U) | bits()) >> 12U;
    return (static_cast<double>(k) + 0.5) * 0x1p-52;
  }

  /// Standard normal: mean 0, variance 1.
  double normal() {
    const std::uint64_t high = bits();
    return NormalTable::shared().quantile((high << 32U) | bits());
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace steerid
