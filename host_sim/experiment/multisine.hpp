// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A multisine: a periodic sum of equally strong sines at every multiple of 1/period within a band, the usual probe of
// system identification (Pintelon & Schoukens, System Identification, 2012, chapter 2).
//
//   u(t) = sum_k A cos(2 pi k t / P + phi_k),  low <= k/P <= high,  A = rms sqrt(2/tones)
//
// Phases: Schroeder's (1970) phi_k = -pi k (k - 1)/tones gives a low crest factor (about 1.7) and no chance;
// random phases, uniform from a seed, give another realisation of the same spectrum for every seed (crest about 3).
//
// Values and slopes of one period are worked out once, so that a tick costs one look-up and nothing drifts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "experiment/signal_point.hpp"

namespace steerid {

struct MultisineSettings {
  double rms_nm = 1.5;
  double low_hz = 0.2;     ///< > 0
  double high_hz = 5.0;    ///< up to 20: beyond it the cubic between two ticks is no longer the sine
  double period_s = 10.0;  ///< a whole number of ticks
  std::optional<std::uint64_t> random_phases{};  ///< the seed of random phases; Schroeder's phases without it
};

class Multisine {
 public:
  /// Throws std::invalid_argument when the band holds no multiple of 1/period or the ranges are not kept.
  explicit Multisine(const MultisineSettings& settings);

  SignalPoint next() {
    const SignalPoint point = period_[tick_];
    tick_ = tick_ + 1 == period_.size() ? 0 : tick_ + 1;
    return point;
  }

 private:
  std::vector<SignalPoint> period_;
  std::size_t tick_ = 0;
};

}  // namespace steerid
