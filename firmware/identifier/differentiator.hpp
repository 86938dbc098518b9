// Value, rate and acceleration of a sampled signal, two samples late, by the five-point central stencil.
//
// The stencil's error is (w T)^4 / 30 for the rate and (w T)^4 / 90 for the acceleration: 0.03 % and 0.01 % at 5 Hz
// and 100 Hz sampling. It amplifies noise, so it is only ever applied behind the common filter. Being late costs
// nothing: whatever stands beside it in the regression is delayed by the same two samples.
#pragma once

#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
class Differentiator {
 public:
  static constexpr int kDelay = 2;   ///< samples between the newest input and what the outputs speak of
  static constexpr int kLength = 5;  ///< samples until every output is made of real ones

  void push(Scalar x) {
    for (int i = kLength - 1; i > 0; --i) x_[i] = x_[i - 1];
    x_[0] = x;
  }

  void fill(Scalar x) {
    for (Scalar& value : x_) value = x;
  }

  /// (x'', x', x) in units of 1/s2, 1/s, 1: the order of J, B, C. rate_hz = 1 / T.
  [[nodiscard]] Vector3<Scalar> derivatives(Scalar rate_hz) const {
    const Scalar outer = x_[0] + x_[4];
    const Scalar inner = x_[1] + x_[3];
    const Scalar second = (Scalar(16) * inner - outer - Scalar(30) * x_[2]) * Scalar(1.0 / 12.0);
    const Scalar first = (Scalar(8) * (x_[1] - x_[3]) - (x_[0] - x_[4])) * Scalar(1.0 / 12.0);
    return Vector3<Scalar>(second * rate_hz * rate_hz, first * rate_hz, x_[2]);
  }

 private:
  Scalar x_[kLength] = {};
};

}  // namespace steerid
