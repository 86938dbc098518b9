// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The blind generator's own source of chance: xoshiro256** (Blackman and Vigna 2018), seeded by SplitMix64. Written
// apart from the one of the simulated sensors, so that a flaw in either does not hide itself.
//
// Every part of a case draws from its own stream, Draw(seed, stream), so that a part can be left out without changing
// what the others draw.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace steerid::blind {

class Draw {
 public:
  explicit Draw(std::uint64_t seed, std::uint64_t stream = 0) {
    std::uint64_t word = seed + 0x632be59bd9b4e019ULL * (stream + 1);
    for (std::uint64_t& s : state_) {
      word += 0x9e3779b97f4a7c15ULL;
      std::uint64_t z = word;
      z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
      z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
      s = z ^ (z >> 31U);
    }
  }

  std::uint64_t bits() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17U;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// In [0, 1).
  double share() { return 0x1p-53 * static_cast<double>(bits() >> 11U); }
  double between(double low, double high) { return low + (high - low) * share(); }
  /// Equally likely in every octave.
  double log_between(double low, double high) { return low * std::pow(high / low, share()); }
  bool chance(double probability) { return share() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  /// A whole number from low to high, both included.
  int whole(int low, int high) { return low + static_cast<int>(share() * (high - low + 1)); }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(share() * static_cast<double>(count)); }
  template <class T>
  const T& one_of(std::span<const T> choices) {
    return choices[index(choices.size())];
  }

  /// Standard normal, by Marsaglia's polar method.
  double normal() {
    for (;;) {
      const double u = between(-1, 1);
      const double v = between(-1, 1);
      const double s = u * u + v * v;
      if (s > 0 && s < 1) return u * std::sqrt(-2 * std::log(s) / s);
    }
  }

 private:
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace steerid::blind
