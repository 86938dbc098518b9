// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The embedded Runge-Kutta pair of Dormand and Prince, order 5 with an error estimate of order 4, and its continuous
// extension of order 4 (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, section II.6).
//
// It only knows a smooth right side. Whoever has corners stops at them: locate them on the continuous extension with
// within(), take the state there, and restart().
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace steerid::blind {

class DormandPrince {
 public:
  /// rates(time, state, slope): fills `slope`.
  using Rates = std::function<void(double time, std::span<const double> state, std::span<double> slope)>;

  DormandPrince(std::size_t states, Rates rates, double relative_tolerance, double absolute_tolerance);

  /// Tries a step. The answer is the error over the tolerance: a step above 1 must be tried again with
  /// better_step(). It changes nothing but what end() and within() say.
  double attempt(double time, std::span<const double> state, double step);

  /// The step that would have met the tolerance, by the last attempt's error; at most five times, at least a fifth.
  [[nodiscard]] static double better_step(double step, double error);

  /// The state at the end of the last attempt.
  [[nodiscard]] std::span<const double> end() const { return end_; }
  /// The state at a fraction 0 to 1 of the last attempt.
  void within(double fraction, std::span<double> state) const;

  /// The next attempt starts where the last one ended, and the right side is the same: its first slope is known.
  void go_on() { slope_[0].swap(slope_[6]), first_known_ = true; }
  /// The next attempt starts anywhere else, or the right side has changed.
  void restart() { first_known_ = false; }

 private:
  Rates rates_;
  double relative_;
  double absolute_;
  bool first_known_ = false;
  double step_ = 0;
  std::array<std::vector<double>, 7> slope_;
  std::vector<double> start_;
  std::vector<double> stage_;
  std::vector<double> end_;
};

}  // namespace steerid::blind
