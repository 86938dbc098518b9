// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The instrument: what of the wheel's motion a source that the driver does not know has caused.
//
// In the closed loop of driver, torsion bar and column the measured torque and the measured motion both contain what
// the driver does on his own account, and least squares finds the column instead of the arm. The probe is independent
// of the driver: what it has caused is the part of the motion that may be regressed on (two-stage method, Van den Hof
// and Schrama 1993, Automatica 29). That part is
//
//   th_z(k) = g1 w1(k) + ... + g4 w4(k),   w: Laguerre functions of the source behind the common filter
//
// A Laguerre basis of four with its pole at 15 rad/s spans wheels of 1 to 6 Hz on any column well enough; whatever it
// misses costs efficiency, never consistency (Wahlberg 1991, IEEE Trans. Automatic Control 36). So does a probe that is
// delivered late, smaller or bent: it still causes motion, which is all that is asked. The coefficients g come from
// least squares of the measured angle on w, both whitened, over the later half of what there was, 40 s at most; they
// are those of before, so that the noise of now is not in them.
//
// Cost: a tick at 100 Hz 4 states, 12 products; beside it that of RunningLeastSquares of 4.
#pragma once

#include "identifier/differentiator.hpp"
#include "identifier/running_least_squares.hpp"

namespace steerid {

template <class Scalar>
class Instrument {
 public:
  static constexpr int kFunctions = 4;
  using Functions = typename RunningLeastSquares<Scalar, kFunctions>::Vector;

  /// Takes in the source behind the common filter, at 100 Hz.
  void push(Scalar source) {
    Scalar in = source * Scalar(kInput);
    for (int i = 0; i < kFunctions; ++i) {
      const Scalar before = function_(i);
      function_(i) = Scalar(kPole) * before + in;
      moved_[i].push(function_(i));
      // The next section's all-pass (q^-1 - pole) / (1 - pole q^-1), by what this one was and is.
      in = before - Scalar(kPole) * function_(i);
    }
  }
  /// Second derivative, first derivative and value of function i, in 1/s2, 1/s and 1 of the source's unit, two ticks
  /// late.
  [[nodiscard]] Vector3<Scalar> derivatives(int i, Scalar rate_hz) const { return moved_[i].derivatives(rate_hz); }
  /// What function i counts for in the motion that the source has caused.
  [[nodiscard]] const Functions& coefficient() const { return regression_.coefficient(); }

  /// Takes in the measured angle and the functions, both whitened; means are those of about so many samples.
  void learn(Scalar whitened_angle, const Functions& whitened, Scalar samples) {
    regression_.push(whitened_angle, whitened, samples);
  }
  /// Works the coefficients out anew. Without a source they are zero.
  void solve() { regression_.solve(); }

 private:
  static constexpr double kPole = 0.8607;   ///< exp(-15/s 10 ms)
  static constexpr double kInput = 0.5091;  ///< sqrt(1 - pole^2), so that all functions have the source's power

  RunningLeastSquares<Scalar, kFunctions> regression_;
  Functions function_ = Functions::Constant(Scalar(0));
  Differentiator<Scalar> moved_[kFunctions];
};

}  // namespace steerid
