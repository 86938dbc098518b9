// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// When a record does not show the inertia: whether a fitted J is one, and how large it can be at most.
//
// A fit whose wheel rings above the band of the torque may have found no inertia but a line in the noise: a hardly
// damped model with a free start rings along with it through the whole record, and its frequency, sqrt(C/J), is known
// as sharply as the record is long. Nothing in the covariance says so. The cost does: to do without a true inertia
// costs as much as its standard deviation promises, to do without a line no more than what one line of the noise is
// worth.
//
// "Without" is the massless wheel: J so small that it rings a hundred times above what samples can hold. Costs are
// those of the whitened problem, profiled: J fixed, everything else fitted again.
//
// How large J can be is asked of the forced motion alone, where a line cannot get in. Far below its resonance a wheel
// is
//
//   th = c0 T + c1 T' + c2 T'',   C = 1/c0,   B = -c1/c0^2,   J = (c1^2/c0 - c2)/c0^2        (1/(J s^2 + B s + C) in s)
//
// and c is found by least squares on signals that both pass 1/(s + 2 pi 5 Hz)^2, the residual's colour whitened.
#pragma once

#include <optional>
#include <span>

#include "fit/iteration.hpp"
#include "fit/output_error.hpp"
#include "fit/segments.hpp"

namespace steerid {

class InertiaDoubt {
 public:
  /// `at` is the fit, `variance` that of its whitened residual. The problem's rows move with every call.
  InertiaDoubt(OutputError& problem, const Iteration& at, double variance, double period_s);

  /// Whether the fitted J, of standard deviation `sd`, may be a line: there is a spring, and the wheel rings above a
  /// sixth of the highest frequency that samples can hold, or its damping is not `damping_seen`.
  [[nodiscard]] bool possible(bool damping_seen) const;

  /// True when J stands on a line in the noise. One run, after which massless() has the problem's rows.
  [[nodiscard]] bool is_line(double sd);

  /// The fit without inertia.
  [[nodiscard]] const Iteration& massless();

 private:
  [[nodiscard]] Iteration with(double inertia, const Iteration& near);
  [[nodiscard]] double squares(const Iteration& run) const { return 2 * run.equations.cost / variance_; }

  OutputError& problem_;
  const Iteration& at_;
  double variance_;
  double highest_rad_s_;
  std::optional<Iteration> massless_;
};

/// The largest J that the record allows: three standard deviations above the size of its estimate from the forced
/// motion, which the torque sensor's noise can push below zero. Nothing where the forced motion explains less than half
/// of the angle, without a spring that holds the torque, or when the estimate is far below zero: then something else is
/// wrong.
[[nodiscard]] std::optional<double> largest_inertia(std::span<const Segment> segments, int max_order);

}  // namespace steerid
