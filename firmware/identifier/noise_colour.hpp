// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The colour of what the model does not explain, and the filter that takes it out.
//
// Every driver adds a slow torque that no sensor sees: a second-order process with a corner w_c near 0.3 Hz, at rest R
// times as dense as the sensors' white noise; together 1 + R / (1 + (w / w_c)^2)^2. Weighting all frequencies alike
// would trust the slow part far too much, and print standard deviations that are several times too small. So a
// whitening filter makes the residual white again,
//
//   D(s) = (s + w_c)^2 / (s^2 + 2 zeta w_n s + w_n^2),
//   w_c / w_n = 1 - depth = (1 + R)^-1/4,   zeta^2 = (1 + (1 - depth)^2) / 2,
//
// the noise's spectral factor inverted, which leaves alone what is above w_n. R is not assumed but measured, on the
// residual before the whitening filter, so that nothing feeds back: white noise is what its first difference shows,
// slow torque what a low-pass at 0.5 Hz leaves beyond white noise's share. Of the slow torque a quarter of its density
// at rest is left there (0.24 for the corners above). Until a second has been seen nothing is concluded and nothing
// taken out, and no parameter may count as known. After a second the residual holds one or two independent slow values,
// less what the parameters have taken up of them: R is then taken for thirteen times what shows, for 1.8 times after 15
// s and for 1.4 times after 30 s.
//
// D acts on torque and angle alike, behind the common filter, so that the regression behind it is still one at every
// depth. It changes seldom and in steps: while a change rings out the two sides of the equation differ.
#pragma once

#include <cstdint>

#include "base/square_root.hpp"
#include "identifier/differentiator.hpp"

namespace steerid {

/// D at one depth, 0 <= depth < 1; 0 leaves a signal as it is. In steps of the period T, with q = exp(-w_c T):
///
///   r := keep r + push (x - y),   y := y + r,   D x = x - position_share y - rate_share r
///
/// which is (1 - q/z)^2 over a polynomial of second order, and white behind it is what two lags at w_c make of white
/// noise, R times as dense at rest, and white noise beside it. With h = (1 - q)^2 / (q (1 - depth)^2) and
/// c = (1 - q)^2 / q the coefficients of (z - 2 + 1/z)^0, 1 and 2 on both sides are the same for
///
///   k = (m - sqrt(m^2 - 4)) / 2,   m = (h + sqrt(h^2 + 16 + 8 c)) / 2,   m^2 - 4 = h m + 2 c,
///   keep = k^2,   push = k h.
template <class Scalar>
struct WhiteningShape {
  Scalar keep{1};
  Scalar push{0};
  Scalar position_share{0};
  Scalar rate_share{0};

  static WhiteningShape of_depth(Scalar depth) {
    if (!(depth > Scalar(0))) return WhiteningShape();
    const Scalar left = Scalar(1) - depth;
    const Scalar h = Scalar(kCurve) / (left * left);
    const Scalar m = Scalar(0.5) * (h + square_root(h * h + Scalar(16 + 8 * kCurve)));
    const Scalar root = Scalar(0.5) * (m - square_root(h * m + Scalar(2 * kCurve)));
    WhiteningShape shape;
    shape.keep = root * root;
    shape.push = root * h;
    shape.position_share = Scalar(1) - left * left * root * Scalar(1 / kKept);
    shape.rate_share = (Scalar(1) - shape.keep * Scalar(1 / (kKept * kKept))) / shape.push - shape.position_share;
    return shape;
  }
  /// That of of_depth: h = push / sqrt(keep).
  [[nodiscard, gnu::cold, gnu::noinline]] Scalar depth() const {
    if (!(push > Scalar(0))) return Scalar(0);
    return Scalar(1) - square_root(Scalar(kCurve) * square_root(keep) / push);
  }
  /// What a step of x makes of D x at once.
  [[nodiscard]] Scalar direct() const { return Scalar(1) - push * (position_share + rate_share); }
  /// What is left of a signal at rest, about (1 - depth)^2.
  [[nodiscard]] Scalar at_rest() const { return Scalar(1) - position_share; }
  /// Samples until a disturbance of the filter has died away to a thousandth, exp(-6.9), of what it leaves of a torque
  /// at rest, (1 - depth)^2 >= exp(-6 depth^2). zeta is at least sqrt(1/2).
  [[nodiscard]] int ring_out() const {
    if (!(push > Scalar(0))) return kBehind;
    const Scalar deep = depth();
    return static_cast<int>((Scalar(6.9) + Scalar(6) * deep * deep) * (Scalar(1) - deep) *
                            Scalar(1 / (0.7071 * kCornerStep)));
  }
  /// w_n in 1/s.
  [[nodiscard]] Scalar end(Scalar period_s) const { return Scalar(kCornerStep) / ((Scalar(1) - depth()) * period_s); }
  /// |D|^2, the share of a signal's power that is left at an angular frequency squared, in 1/s2.
  [[nodiscard, gnu::noinline]] Scalar power_left(Scalar frequency_squared, Scalar period_s) const {
    if (!(push > Scalar(0))) return Scalar(1);
    constexpr double kCornerSquared = kCornerStep * kCornerStep;
    const Scalar x = frequency_squared * period_s * period_s;
    const Scalar left = Scalar(1) - depth();
    const Scalar end_squared = Scalar(kCornerSquared) / (left * left);
    const Scalar slow = x + Scalar(kCornerSquared);
    return direct() * slow * slow / (x * (x + Scalar(2 * kCornerSquared)) + end_squared * end_squared);
  }

  static constexpr int kBehind = 5;  ///< samples that stand behind the whitening filter, in the differentiators
  static constexpr double kCornerStep = 0.018850;  ///< w_c T = 2 pi 0.3 Hz 10 ms
  static constexpr double kKept = 0.981327;        ///< q = exp(-w_c T)
  static constexpr double kCurve = (1 - kKept) * (1 - kKept) / kKept;
};

/// One whitening filter with its two states.
template <class Scalar>
class WhiteningFilter {
 public:
  Scalar step(Scalar x, const WhiteningShape<Scalar>& shape) {
    rate_ = shape.keep * rate_ + shape.push * (x - position_);
    position_ += rate_;
    return x - shape.position_share * position_ - shape.rate_share * rate_;
  }
  Moved<Scalar> step(const Moved<Scalar>& x, const WhiteningShape<Scalar>& shape) {
    const Scalar before = rate_;
    const Scalar left = step(x.to, shape);
    return {left, x.by - shape.position_share * rate_ - shape.rate_share * (rate_ - before)};
  }
  /// At rest at `x`.
  void settle_at(Scalar x) {
    position_ = x;
    rate_ = Scalar(0);
  }

 private:
  Scalar position_{0};
  Scalar rate_{0};  ///< a sample
};

/// The whitening filter undone: what went into it, from what came out.
template <class Scalar>
class InverseWhiteningFilter {
 public:
  Scalar step(Scalar y, const WhiteningShape<Scalar>& shape) {
    const Scalar coasting = shape.keep * rate_ - shape.push * position_;
    const Scalar x = (y + shape.position_share * (position_ + coasting) + shape.rate_share * coasting) / shape.direct();
    rate_ = coasting + shape.push * x;
    position_ += rate_;
    return x;
  }

 private:
  Scalar position_{0};
  Scalar rate_{0};
};

template <class Scalar>
class NoiseColour {
 public:
  /// Takes in one residual as it is before the whitening filter.
  void learn(Scalar residual) {
    slow_ += Scalar(kSlowPole) * (residual - slow_);
    const Scalar step = residual - before_;
    before_ = residual;
    if (samples_ < kMemory) ++samples_;
    const Scalar rate = Scalar(1) / Scalar(samples_);
    slow_power_ += rate * (slow_ * slow_ - slow_power_);
    white_power_ += rate * (Scalar(0.5) * step * step - white_power_);
  }

  /// Mean square of the residual's slow part, Nm^2.
  [[nodiscard]] Scalar slow_power() const { return slow_power_; }

  /// The depth of the whitening filter that would make the residuals so far white.
  [[nodiscard, gnu::noinline]] Scalar depth() const {
    if (samples_ < kTrusted || !(white_power_ > Scalar(kSilent))) return Scalar(0);
    return depth_for(slow_power_ / (white_power_ * Scalar(kWhiteShare)), Scalar(1) + Scalar(doubt_) / Scalar(samples_));
  }

  /// By how much more than it looks the noise may be where motion shows an arm, as long as its slow part stands on a
  /// few independent values: the less the faster the motion, whose angular frequency is given, squared, in 1/s2. Before
  /// kTrusted nothing is known of it.
  [[nodiscard]] Scalar caution(Scalar frequency_squared) const {
    if (samples_ < kTrusted) return Scalar(1);
    const Scalar more = Scalar(doubt_) / Scalar(samples_);
    return Scalar(1) + Scalar(kCaution) * more * more / (frequency_squared + Scalar(kSlowCorner));
  }

  void reset() { *this = NoiseColour(); }
  /// For another arm of the same driver, whose slow torque is no news: what little is seen at first is doubted less.
  void start_anew() {
    reset();
    doubt_ = kDoubtAnew;
  }

 private:
  /// `ratio`: power behind the low-pass over what white noise alone would leave there; `doubt` >= 1: how many times
  /// denser than it looks the slow torque may be.
  static Scalar depth_for(Scalar ratio, Scalar doubt) {
    if (!(ratio > Scalar(kLeast))) return Scalar(0);
    const Scalar density = Scalar(1) + Scalar(kDensityOfPower) * doubt * (ratio - Scalar(kChance));
    const Scalar depth = Scalar(1) - Scalar(1) / square_root(square_root(density));
    return depth < Scalar(kDeepest) ? depth : Scalar(kDeepest);
  }

  static constexpr double kSlowPole = 0.0309;                           ///< 1 - exp(-2 pi 0.5 Hz 10 ms)
  static constexpr double kWhiteShare = kSlowPole / (2.0 - kSlowPole);  ///< of white noise's power, behind the low-pass
  static constexpr double kDensityOfPower = 4;                          ///< 1 / 0.24
  static constexpr double kChance = 1.5;     ///< 30 s hold some 30 independent slow values: a mean square of 1 +- 0.26
  static constexpr double kLeast = 1.75;     ///< below is not worth a change of the filter
  static constexpr double kDeepest = 0.965;  ///< 1/800 of the amplitude: of 1 Nm a millinewton metre
  static constexpr std::int16_t kDoubt = 1200;     ///< samples
  static constexpr std::int16_t kDoubtAnew = 300;  ///< samples
  static constexpr double kSlowCorner = 3.553;     ///< (2 pi 0.3 Hz)^2, 1/s2
  static constexpr double kCaution = 5.5;          ///< 1/s2: 1.5 times as much for a motion at rest
  static constexpr double kSilent = 1e-9;          ///< Nm^2: far below the port's resolution there is nothing to colour
  static constexpr int kMemory = 3000;             ///< samples
  static constexpr int kTrusted = 100;             ///< samples before anything is concluded

  Scalar slow_{0};
  Scalar before_{0};
  Scalar slow_power_{0};
  Scalar white_power_{0};
  std::int16_t samples_ = 0;
  std::int16_t doubt_ = kDoubt;
};

}  // namespace steerid
