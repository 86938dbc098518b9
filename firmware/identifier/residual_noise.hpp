// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The noise of the steady identifier's residual, and what a deviation claims by it.
//
//   variance   s2 := s2 + (e2 - s2) / n
//   scores     w := w + 0.025 (e z - w)
//   by scores  u2 := u2 + (79 mean(w^2 / mean(z^2)) - u2) 50 / n
//   claimed    max(0.72 s2, u2 + min((u2 - s2) / 4, s2 / 2))
//
// e2 is e^2 / (1 + z' P z) of the whitened residual e; n = 1, 2, ... 2000. The scores are of z, the model's rate and
// its angle, below 0.4 Hz; u2 is what they say of the variance, twice a second and in the mean of rate and angle.
//
// White noise of variance s2 makes a score of s2 mean(z^2) 0.025 / (2 - 0.025), so that u2 is s2. Noise that is denser
// where motion shows the arm, as what a whitening filter of the wrong shape leaves, makes more of it, and a deviation
// must not claim less. A score is one number: of 40 the mean square scatters by a fifth. s2 hardly does, but is above
// its density where motion shows an arm by up to a third: hence 0.72. The low pass takes in what lies beside the
// motion's frequencies as well, which is nearer to the whole: a quarter of what the two differ is added. Friction
// leaves them ten times as dense, and is no noise: hence at most half of s2.
//
// Another claim is another class with these members, named in identifier.hpp.
//
// Units: Nm^2. Cost a sample: some 10 multiplications, a division. 20 bytes in float.
#pragma once

#include <cstdint>

#include "identifier/window_information.hpp"

namespace steerid {

template <class Scalar>
class ResidualNoise {
 public:
  static constexpr double kLeast = 1e-6;      ///< Nm^2: a millinewton metre, the port's resolution
  static constexpr double kWild = 9;          ///< square of a residual over its variance: three standard deviations
  static constexpr std::int8_t kEvery = 50;   ///< samples from one learn_from_scores() to the next
  static constexpr std::int16_t kFirm = 100;  ///< samples that a variance stands on before a wild one cannot move it

  /// Of the residual, never less than kLeast.
  [[nodiscard]] Scalar variance() const { return variance_; }
  /// What a deviation is made of.
  [[nodiscard]] Scalar claimed() const {
    const Scalar least = Scalar(kLeastOfVariance) * variance_;
    const Scalar most = Scalar(kMostBeside) * variance_;
    const Scalar beside = Scalar(kBeside) * (by_scores_ - variance_);
    const Scalar claimed = by_scores_ + (beside < most ? beside : most);
    return claimed > least ? claimed : least;
  }

  /// The least that there can be.
  void forget() { variance_ = Scalar(kLeast); }
  /// Known without residuals of it.
  void assume(Scalar variance) {
    variance_ = variance;
    by_scores_ = variance;
    forget_scores();  // what a fault left would count as noise for 20 s
  }
  /// With the next residual. The variance of now stands for it until then; scores have said nothing.
  void begin_anew() {
    stands_on(0);
    by_scores_ = Scalar(0);
  }
  /// From now on the variance counts for as many residuals.
  void stands_on(std::int16_t samples) { samples_ = samples; }
  void stands_on_at_most(std::int16_t samples) {
    if (samples_ > samples) samples_ = samples;
  }
  void forget_scores() { rate_score_ = angle_score_ = Scalar(0); }

  /// One e2, and what it is of the variance. `bounded`: the parameters have come to rest, a wild one is not noise
  /// alone. Once the variance is firm a single wild one must not move it much. Before, it would pass for noise,
  /// whatever it is, before the change detector hears of it.
  void learn(Scalar normalised, Scalar square, bool bounded) {
    if (samples_ < kMemory) ++samples_;
    if (bounded && normalised > Scalar(kWild)) {
      square = samples_ < kFirm ? variance_ : Scalar(kWild) * variance_;
    }
    variance_ += (square - variance_) / Scalar(samples_);
    if (variance_ < Scalar(kLeast)) variance_ = Scalar(kLeast);
  }
  /// One residual and the model's rate and angle.
  void score(Scalar residual, Scalar rate, Scalar angle) {
    rate_score_ += Scalar(kScorePole) * (residual * rate - rate_score_);
    angle_score_ += Scalar(kScorePole) * (residual * angle - angle_score_);
  }
  /// Every kEvery samples, of the motion in the window. `claimed`: what deviations claim now. The low pass forgets
  /// within 0.4 s, so that this score is another one than the last. A single one is worth little, and what a fault
  /// leaves in the filters is no noise. `least_square`: below it there is no motion.
  void learn_from_scores(const WindowInformation<Scalar>& window, Scalar claimed, Scalar least_square) {
    Scalar seen = Scalar(kScoreWhite) *
                  window.over_the_motion(rate_score_ * rate_score_, angle_score_ * angle_score_, least_square);
    if (samples_ < kEvery || !(seen > Scalar(0))) {
      by_scores_ = variance_;
      return;
    }
    const Scalar most = Scalar(kWildScore) * claimed;
    if (seen > most) seen = most;
    by_scores_ += (seen - by_scores_) * Scalar(int{kEvery}) / Scalar(samples_);
  }

 private:
  static constexpr std::int16_t kMemory = 2000;  ///< samples, 20 s
  static constexpr double kScorePole = 0.025;    ///< 1 - exp(-2 pi 0.4 Hz 10 ms)
  static constexpr double kScoreWhite = (2 - kScorePole) / kScorePole;
  static constexpr double kLeastOfVariance = 0.72;
  static constexpr double kBeside = 0.25;
  static constexpr double kMostBeside = 0.5;
  static constexpr double kWildScore = 16;  ///< square of a score over its variance: four standard deviations

  Scalar variance_{0};
  Scalar rate_score_{0}, angle_score_{0};
  Scalar by_scores_{0};       ///< variance of white noise that would make as much of the scores
  std::int16_t samples_ = 0;  ///< that the variance stands on
};

}  // namespace steerid
