// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether a fitted J, B and C would stay what they are if the model were wrong in a way that the record shows, and how
// far the torque sensor's own noise may have moved them. Standard deviations know of neither.
//
// Alternatives. Beside J th'' + B th' + C th = T each of these is tried, one at a time, to first order:
//   a delay         the angle comes later than its torque: d th/d delay = -th'
//   a drift between the clocks of angle and torque, as two loggers have it: the angle comes later and later, -t th',
//                   beside a delay
//   dry friction    an opposing torque of one size: the wheel's response to the mean of -sgn(th') from sample to sample
//   a cubic spring  the response to -th^3;  a damping by the square of the rate, the response to -th'|th'|
//   asymmetric stiffness  the response to -th^2, of an arm that is stiffer to one side. Unlike |th|, with which it is
//                   correlated by 0.94 of a normal th, another zero of the angle makes of it another C and offset
// each of them as the log's filter lets it through: the residual has nothing above it, and what whitens the residual
// would make more of an alternative's part there than of all the rest.
// With whitened residual r and the whitened derivatives X of J, B, C, an offset and the states at the start of every
// segment, r = X p + z a + e is a linear least-squares problem: a is the alternative's size, p says where J, B and C
// would go. Its evidence is (n/2) log(S0/S1) - (log n)/2 - log 6 nats: the gain in log likelihood, less Schwarz's price
// of a number (a drift has two) and that of having tried six. An alternative of an impossible sign (a friction that
// pushes) is left out. One `shifts` when its evidence is positive and a parameter that is called valid leaves its 95 %
// interval (its deviation and the bias below together), and `matters` when that moves it by more than 10 % of its
// value: the error above which an answer that is called valid counts as wrong.
//
// Torque noise. White noise of variance s^2 on the log's torque enters model and derivatives alike: it adds
// -E[x_n' y_n] to the product of each derivative x with r, y_n being the wheel's response to it and x_n what it adds to
// x (errors in variables). That is taken off again, or noise would pass for a delay or for damping by the square of the
// rate; and by what it moves the fit its deviation grows. s is the rms of what the torque is off the cubic through
// its neighbours, which lets nothing below some 15 Hz pass, over that of white noise of variance 1 that came through
// the same resampling. Noise that was filtered away before the log is not seen.
//
// Cost: two whitened passes over the record, a few ms a minute of record.
#pragma once

#include <array>
#include <vector>

#include "fit/gauss_newton.hpp"
#include "log/resample.hpp"

namespace steerid {

struct Alternative {
  enum class Kind : std::uint8_t {
    kDelay,
    kClockDrift,
    kDryFriction,
    kCubicSpring,
    kSquareDamping,
    kAsymmetricStiffness
  };
  Kind kind = Kind::kDelay;
  double size = 0;                ///< s, s in a second, Nm, Nm/rad^3, Nms^2/rad^2, Nm/rad^2
  double evidence_nats = 0;       ///< above zero: more likely than without it
  std::array<double, 3> value{};  ///< J, B, C with it
  bool shifts = false;            ///< likelier, and a parameter that is called valid leaves its interval
  bool matters = false;           ///< and by so much that its value counts as wrong
};

struct ModelCheck {
  std::vector<Alternative> alternatives;      ///< that are possible, the likeliest first
  std::array<double, 3> torque_noise_bias{};  ///< that noise on the torque may have put on J, B, C; SI units
  double torque_noise_nm = 0;                 ///< rms, at the log's own rate
};

/// `fit` is the fit_batch() of `resampled.record`.
[[nodiscard]] ModelCheck check_model(const Resampled& resampled, const BatchFit& fit);

/// Fits first.
[[nodiscard]] ModelCheck check_model(const Resampled& resampled, bool torque_offset);

}  // namespace steerid
