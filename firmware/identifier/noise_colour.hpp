// The colour of what the model does not explain, and the filter that takes it out.
//
// Every driver adds a slow torque that no sensor sees. Against the sensors' white noise it is a hump below about 1 Hz.
// Weighting all frequencies alike would then trust the slow part far too much, and print standard deviations that are
// several times too small. So the residual passes a second-order shelf
//
//   D(s) = ((s + (1 - depth) w) / (s + w))^2,   w = 2 pi 2 Hz,
//
// which leaves everything above 2 Hz alone and holds down what is below by (1 - depth)^2. The depth is not assumed but
// estimated: it is driven by the power of the whitened residual below 0.5 Hz against what white noise would have there.
//
// D is applied to the scalar residual and to the scalar that feeds the instrument, never to the regressor: a depth that
// moves would not commute with the derivatives in it.
#pragma once

namespace steerid {

/// One shelf with its two states.
template <class Scalar>
class Shelf {
 public:
  Scalar step(Scalar x, Scalar depth) {
    for (Scalar& slow : slow_) {
      slow += Scalar(kPole) * (x - slow);
      x -= depth * slow;
    }
    return x;
  }
  void reset() {
    slow_[0] = Scalar(0);
    slow_[1] = Scalar(0);
  }

 private:
  static constexpr double kPole = 0.118;  ///< 1 - exp(-2 pi 2 Hz 10 ms)
  Scalar slow_[2] = {};
};

template <class Scalar>
class NoiseColour {
 public:
  /// Takes in one whitened residual. Returns by how much, relatively, the depth's attenuation rose (0 when it fell):
  /// what was learned so far was weighted for a whiter noise than there is, and must be trusted that much less.
  Scalar learn(Scalar residual) {
    slow_ += Scalar(kSlowPole) * (residual - slow_);
    const Scalar rate = samples_ < kMemory ? Scalar(1) / Scalar(++samples_) : Scalar(1.0 / kMemory);
    slow_power_ += rate * (slow_ * slow_ - slow_power_);
    power_ += rate * (residual * residual - power_);
    if (samples_ < kTrusted || power_ < Scalar(kSilent)) return Scalar(0);
    // White noise leaves kSlowPole / (2 - kSlowPole) of its power behind the slow filter. The update follows the
    // logarithm of the ratio, here by its rational approximation 2 (r - 1) / (r + 1), held within one.
    const Scalar expected = power_ * Scalar(kSlowPole / (2.0 - kSlowPole));
    Scalar excess = Scalar(2) * (slow_power_ - expected) / (slow_power_ + expected);
    if (excess > Scalar(1)) excess = Scalar(1);
    if (excess < Scalar(-1)) excess = Scalar(-1);
    const Scalar step = Scalar(kRate) * excess;
    depth_ += step * (Scalar(1) - depth_);
    if (depth_ < Scalar(0)) depth_ = Scalar(0);
    if (depth_ > Scalar(kDeepest)) {
      depth_ = Scalar(kDeepest);
      return Scalar(0);
    }
    return step > Scalar(0) ? step : Scalar(0);
  }

  [[nodiscard]] Scalar depth() const { return depth_; }

  void reset() { *this = NoiseColour(); }

 private:
  static constexpr double kSlowPole = 0.0309;  ///< 1 - exp(-2 pi 0.5 Hz 10 ms)
  static constexpr double kRate = 0.005;       ///< per sample: a factor e in the attenuation takes 2 s
  static constexpr double kDeepest = 0.95;     ///< 1/400 of the power below
  static constexpr int kMemory = 333;          ///< samples
  static constexpr double kSilent = 1e-9;      ///< Nm^2: far below the port's resolution there is nothing to colour
  static constexpr int kTrusted = 100;         ///< samples before anything is concluded

  Scalar slow_{0};
  Scalar slow_power_{0};
  Scalar power_{0};
  Scalar depth_{0};
  int samples_ = 0;
};

}  // namespace steerid
