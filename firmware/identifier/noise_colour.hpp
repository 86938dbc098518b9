// The colour of what the model does not explain, and the filter that takes it out.
//
// Every driver adds a slow torque that no sensor sees: a second-order process with a corner w_c near 0.3 Hz, at rest R
// times as dense as the sensors' white noise; together 1 + R / (1 + (w / w_c)^2)^2. Weighting all frequencies alike
// would trust the slow part far too much, and print standard deviations that are several times too small. So a shelf
// makes the residual white again,
//
//   D(s) = ((s + w_c) / (s + w_p))^2,   w_c / w_p = 1 - depth = (1 + R)^-1/4,
//
// which leaves alone what is above w_p. R is not assumed but measured, on the residual before the shelf, so that
// nothing feeds back: white noise is what its first difference shows, slow torque what a low-pass at 0.5 Hz leaves
// beyond white noise's share. Of the slow torque a quarter of its density at rest is left there (0.24 for the corners
// above). Until a second has been seen nothing is concluded and nothing taken out, and no parameter may count as known.
// After a second the residual holds one or two independent slow values, less what the parameters have taken up of
// them: R is then taken for seven times what shows, and for 1.4 times after 15 s.
//
// D acts on torque and angle alike, behind the common filter, so that the regression behind it is still one at every
// depth. It changes seldom and in steps: while a change rings out the two sides of the equation differ.
#pragma once

#include "base/square_root.hpp"

namespace steerid {

/// D at one depth, 0 <= depth < 1; 0 leaves a signal as it is.
template <class Scalar>
struct ShelfShape {
  Scalar depth{0};
  Scalar pole{Scalar(kCorner)};  ///< share of a step that the low-pass at w_p takes in a sample
  Scalar undo{1};                ///< 1 / (1 - depth pole), for the way back

  static ShelfShape of_depth(Scalar depth) {
    const Scalar wanted = Scalar(kCorner) / (Scalar(1) - depth);
    const Scalar pole = wanted < Scalar(kFastest) ? wanted : Scalar(kFastest);
    return {depth, pole, Scalar(1) / (Scalar(1) - depth * pole)};
  }
  /// Samples until a disturbance of the filter has died away to a thousandth, exp(-6.9), of what it leaves of a torque
  /// at rest, (1 - depth)^2 >= exp(-6 depth^2).
  [[nodiscard]] int ring_out() const {
    if (!(depth > Scalar(0))) return kBehind;
    return static_cast<int>((Scalar(6.9) + Scalar(6) * depth * depth) / pole);
  }
  /// w_p in 1/s.
  [[nodiscard]] Scalar end(Scalar period_s) const { return pole / ((Scalar(1) - pole * Scalar(0.5)) * period_s); }
  /// |D|^2, the share of a signal's power that is left at an angular frequency squared, in 1/s2.
  [[nodiscard, gnu::noinline]] Scalar power_left(Scalar frequency_squared, Scalar period_s) const {
    const Scalar highest = end(period_s);
    const Scalar lowest = highest * (Scalar(1) - depth);
    const Scalar left = (frequency_squared + lowest * lowest) / (frequency_squared + highest * highest);
    return left * left;
  }

  static constexpr int kBehind = 5;          ///< samples that stand behind the shelf, in the differentiators
  static constexpr double kCorner = 0.0187;  ///< 1 - exp(-2 pi 0.3 Hz 10 ms)
  static constexpr double kFastest = 0.24;   ///< 4.4 Hz, where the deepest shelf ends
};

/// One shelf with its two states: D = (1 - depth L)^2, L the low-pass at w_p.
template <class Scalar>
class Shelf {
 public:
  Scalar step(Scalar x, const ShelfShape<Scalar>& shape) {
    once_ += shape.pole * (x - once_);
    twice_ += shape.pole * (once_ - twice_);
    return x - shape.depth * (Scalar(2) * once_ - shape.depth * twice_);
  }
  /// At rest at `x`.
  void settle_at(Scalar x) { once_ = twice_ = x; }

 private:
  Scalar once_{0}, twice_{0};
};

/// The shelf undone: what went into it, from what came out.
template <class Scalar>
class Unshelf {
 public:
  Scalar step(Scalar y, const ShelfShape<Scalar>& shape) {
    for (Scalar& slow : slow_) {
      y = (y + shape.depth * (Scalar(1) - shape.pole) * slow) * shape.undo;
      slow += shape.pole * (y - slow);
    }
    return y;
  }

 private:
  Scalar slow_[2] = {};
};

template <class Scalar>
class NoiseColour {
 public:
  /// Takes in one residual as it is before the shelf.
  void learn(Scalar residual) {
    slow_ += Scalar(kSlowPole) * (residual - slow_);
    const Scalar step = residual - before_;
    before_ = residual;
    if (samples_ < kMemory) ++samples_;
    const Scalar rate = Scalar(1) / Scalar(samples_);
    slow_power_ += rate * (slow_ * slow_ - slow_power_);
    white_power_ += rate * (Scalar(0.5) * step * step - white_power_);
  }

  /// Whether the figure stands on all it ever stands on: what changes from here on is the noise, not what is known of
  /// it.
  [[nodiscard]] bool settled() const { return samples_ == kMemory; }

  /// The depth of the shelf that would make the residuals so far white.
  [[nodiscard, gnu::noinline]] Scalar depth() const {
    if (samples_ < kTrusted || !(white_power_ > Scalar(kSilent))) return Scalar(0);
    return depth_for(slow_power_ / (white_power_ * Scalar(kWhiteShare)), Scalar(1) + Scalar(kDoubt) / Scalar(samples_));
  }

  void reset() { *this = NoiseColour(); }

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
  static constexpr double kChance = 1.5;    ///< 15 s hold some 15 independent slow values: a mean square of 1 +- 0.35
  static constexpr double kLeast = 1.75;    ///< below is not worth a change of the filter
  static constexpr double kDeepest = 0.95;  ///< 1/400 of the amplitude: of 1 Nm less than a sensor's noise
  static constexpr double kDoubt = 600;     ///< samples
  static constexpr double kSilent = 1e-9;   ///< Nm^2: far below the port's resolution there is nothing to colour
  static constexpr int kMemory = 1500;      ///< samples
  static constexpr int kTrusted = 100;      ///< samples before anything is concluded

  Scalar slow_{0};
  Scalar before_{0};
  Scalar slow_power_{0};
  Scalar white_power_{0};
  int samples_ = 0;
};

}  // namespace steerid
