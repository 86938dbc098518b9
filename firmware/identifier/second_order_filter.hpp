// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The discrete second-order low-pass y'' = w2 (in - y) - d2 y' at a fixed period, unit gain at rest:
//   v += T (w2 (in - y) - d2 v)   with the damping taken implicitly,   y += T v.
// Stable for w2 T^2 < 4; two states, four multiplications.
//
// It plays two parts. As the *common filter* both sides of the equation of motion pass it, so that whatever it does
// to one side it does to the other: its own discretisation error cancels exactly and needs no care. As the *wheel
// model* it is the free run 1/(J s^2 + B s + C), times C, that makes the instrument; there its error only costs
// efficiency, never accuracy.
#pragma once

#include "identifier/differentiator.hpp"

namespace steerid {

template <class Scalar>
struct SecondOrderCoefficients {
  Scalar stiffness_step{0};  ///< T w2 / (1 + T d2)
  Scalar rate_keep{0};       ///< 1 / (1 + T d2)
};

/// Coefficients for w2 in 1/s2 and d2 in 1/s at period_s.
template <class Scalar>
constexpr SecondOrderCoefficients<Scalar> second_order_coefficients(Scalar w2, Scalar d2, Scalar period_s) {
  const Scalar keep = Scalar(1) / (Scalar(1) + period_s * d2);
  return {period_s * w2 * keep, keep};
}

template <class Scalar>
class SecondOrderFilter {
 public:
  /// Takes in one sample, returns the output after it.
  Scalar step(Scalar in, const SecondOrderCoefficients<Scalar>& c, Scalar period_s) {
    rate_ = c.rate_keep * rate_ + c.stiffness_step * (in - position_);
    position_ += period_s * rate_;
    return position_;
  }

  /// The same with the step that it took.
  Moved<Scalar> move(Scalar in, const SecondOrderCoefficients<Scalar>& c, Scalar period_s) {
    step(in, c, period_s);
    return {position_, period_s * rate_};
  }

  [[nodiscard]] Scalar position() const { return position_; }
  [[nodiscard]] Scalar rate() const { return rate_; }

  /// At rest at `position`: what a constant input leads to.
  void settle_at(Scalar position) {
    position_ = position;
    rate_ = Scalar(0);
  }

 private:
  Scalar position_{0};
  Scalar rate_{0};
};

}  // namespace steerid
