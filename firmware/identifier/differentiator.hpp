// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Value, rate and acceleration of a sampled signal, two samples late, by the five-point central stencil.
//
// The stencil's error is (w T)^4 / 30 for the rate and (w T)^4 / 90 for the acceleration: 0.03 % and 0.01 % at 5 Hz
// and 100 Hz sampling. It amplifies noise, so it is only ever applied behind the common filter. Being late costs
// nothing: whatever stands beside it in the regression is delayed by the same two samples.
//
// It works on the steps from sample to sample, not on the samples. A filter knows by how much it moves before it adds
// that to where it stands; the difference of two places is off by their rounding, which at 100 Hz is fifty times
// coarser beside a step than beside a place, and the acceleration makes 3e4 of it.
#pragma once

#include "identifier/parameters.hpp"

namespace steerid {

/// Where a signal is, and by how much it moved to there since the sample before.
template <class Scalar>
struct Moved {
  Scalar to{0};
  Scalar by{0};
};

template <class Scalar>
class Differentiator {
 public:
  static constexpr int kDelay = 2;   ///< samples between the newest input and what the outputs speak of
  static constexpr int kLength = 5;  ///< samples until every output is made of real ones

  void push(const Moved<Scalar>& x) {
    for (int i = kSteps - 1; i > 0; --i) step_[i] = step_[i - 1];
    step_[0] = x.by;
    newest_ = x.to;
  }
  /// Of a signal whose steps nobody knows better.
  void push(Scalar x) { push({x, x - newest_}); }

  void fill(Scalar x) {
    for (Scalar& step : step_) step = Scalar(0);
    newest_ = x;
  }

  /// (x'', x', x) in units of 1/s2, 1/s, 1: the order of J, B, C. rate_hz = 1 / T.
  [[nodiscard]] Vector3<Scalar> derivatives(Scalar rate_hz) const {
    // (-1 16 -30 16 -1) / 12 and (1 -8 0 8 -1) / 12 of five samples, in the four steps between them.
    const Scalar second = Scalar(15) * (step_[1] - step_[2]) - (step_[0] - step_[3]);
    const Scalar first = Scalar(7) * (step_[1] + step_[2]) - (step_[0] + step_[3]);
    const Scalar twelfth = rate_hz * Scalar(1.0 / 12.0);
    return Vector3<Scalar>(second * twelfth * rate_hz, first * twelfth, newest_ - (step_[0] + step_[1]));
  }

 private:
  static constexpr int kSteps = kLength - 1;
  Scalar newest_{0};
  Scalar step_[kSteps] = {};  ///< the newest first
};

}  // namespace steerid
