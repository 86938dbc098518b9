// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The spectrum of what no sensor explains, as an autoregression, and the whitening filter that it makes.
//
//   v(k) = a1 v(k-1) + ... + a6 v(k-6) + e(k),   e white
//
// v is the unmeasured part of the torque: the driver's own torque, which is large below 0.5 Hz and falls by some 40 dB
// a decade, and the noise of both sensors, which rises behind the common filter. An autoregression of order 6 at 25 Hz
// holds both; of 3 it costs a tenth of the accuracy, of 7 it gains nothing. An estimate that is weighted by it is the
// refined instrumental variable with an autoregressive noise model (Young 2011, Recursive Estimation and Time-Series
// Analysis, chapter 7).
//
// The filter is finite: whitened(k) = x(k) - a1 x(k-1) - ... - a6 x(k-6), worked out from the raw history of every
// signal. So the coefficients may change at any time: nothing rings, and the equation holds behind any of them.
//
// Units: v in Nm. Cost: that of RunningLeastSquares of 6.
#pragma once

#include "identifier/running_least_squares.hpp"

namespace steerid {

template <class Scalar>
class AutoregressiveNoise {
 public:
  static constexpr int kOrder = 6;

  /// Takes in one value of what is unexplained; means are those of about so many samples, 1 and more.
  void push(Scalar unexplained_nm, Scalar samples) {
    power_ += (unexplained_nm * unexplained_nm - power_) / samples;
    if (followed_ == kOrder) regression_.push(unexplained_nm, before_, samples);
    if (followed_ < kOrder) ++followed_;
    for (int i = kOrder - 1; i > 0; --i) before_(i) = before_(i - 1);
    before_(0) = unexplained_nm;
  }

  /// What comes next is no neighbour of what came before. What was learned stays.
  void break_here() { followed_ = 0; }

  /// Works the coefficients out anew; before anything was learned they are zero, and whiten nothing.
  void solve() { regression_.solve(); }

  /// a(i + 1), i from 0 to kOrder - 1.
  [[nodiscard]] Scalar coefficient(int i) const { return regression_.coefficient()(i); }
  /// Mean square of what is unexplained, Nm^2.
  [[nodiscard]] Scalar power() const { return power_; }

 private:
  RunningLeastSquares<Scalar, kOrder> regression_;
  typename RunningLeastSquares<Scalar, kOrder>::Vector before_ =
      RunningLeastSquares<Scalar, kOrder>::Vector::Constant(Scalar(0));  ///< the newest first
  Scalar power_{0};
  signed char followed_ = 0;
};

}  // namespace steerid
