// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An arm that stays, moves or is exchanged: three hypotheses of how J, B and C change, and what each look says.
//
// A driver co-contracts within 0.3 to 30 s or takes a hand off. No single forgetting rule follows that and is accurate
// while nothing changes. So Kalman filters of the same parameters run side by side, each with another random walk, and
// exchange what they know by how often one mode follows another (interacting multiple model estimator: Blom and
// Bar-Shalom 1988, IEEE Trans. Automatic Control 33; their notation).
//
// How far and how often is in arm_walks.hpp. What is published is the mixture's mean and variance, disagreement of the
// modes included: where the data do not tell whether the arm has changed, the deviation says so. That nobody holds the
// wheel is no mode of an arm: hands.hpp.
//
// Each filter is a recursive instrumental variable in symmetric-gain form (arm_belief.hpp). Likelihoods are those of e
// of the mixture's mean q, moved by what the instrument shows of p,
//
//   N(e + z' (q - p); 0, S)
//
// so that modes differ by what the instrument shows, not by what noise in the measured motion would.
//
// Units: those of arm_belief.hpp; s2 in Nm^2. Cost a look, by counting: some 400 multiplications, 8 divisions, 5 square
// roots.
#pragma once

#include "base/exponential.hpp"
#include "base/square_root.hpp"
#include "identifier/arm_belief.hpp"
#include "identifier/arm_walks.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
class ArmModes {
 public:
  static constexpr int kModes = kArmModes;
  static constexpr int kStays = kArmStays;
  static constexpr double kPeriod_s = ArmWalks<Scalar>::kPeriod_s;  ///< from one look to the next

  /// Neither is copied.
  explicit ArmModes(const Prior<Scalar>& prior, const ArmWalks<Scalar>& walks = kWalksByProbe<Scalar>)
      : prior_(&prior), walks_(&walks) {
    restart(prior.value, prior.spread);
  }

  /// From now on by these; they are not copied.
  void assume(const Prior<Scalar>& prior, const ArmWalks<Scalar>& walks) {
    prior_ = &prior;
    walks_ = &walks;
  }
  [[nodiscard]] const Prior<Scalar>& prior() const { return *prior_; }

  /// From `value` with independent deviations; an arm that stays.
  [[gnu::cold, gnu::noinline]] void restart(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation) {
    for (int j = 0; j < kModes; ++j) {
      mode_[j] = ArmBelief<Scalar>::independent(value, deviation);
      probability_[j] = Scalar(j == kStays ? 1 : 0);
    }
    mix();
  }

  /// Whitened torque, measured regressor and instrument, the variance of the noise, and which parameters the motion
  /// does not show, all of one look. Returns e^2 s2 / S averaged over the modes: what the look says of that variance.
  [[gnu::noinline]] Scalar look(Scalar torque_nm, const Vector3<Scalar>& phi, const Vector3<Scalar>& z, Scalar noise,
                                const bool (&dark)[3] = kAllShown) {
    ArmBelief<Scalar> next[kModes];
    Scalar weight[kModes];
    Seen seen[kModes];
    const Scalar residual = torque_nm - phi.dot(value_);
    for (int j = 0; j < kModes; ++j) {
      weight[j] = interact(j, next[j]);
      walk(next[j], walks_->of[j]);
      // By the instrument alone: measured motion has noise in it, of which a smaller arm always leaves less, so that by
      // it an arm at rest would be none.
      const Scalar shown = residual + z.dot(value_ - next[j].value);
      seen[j] = correct(next[j], torque_nm, phi, z, noise, shown, dark);
      next[j].hold(*prior_);
    }
    Scalar least = seen[0].square;
    for (const Seen& one : seen) {
      if (one.square < least) least = one.square;
    }
    if (!walks_->ends_above_likeliest) least = Scalar(0);
    Scalar total(0);
    Scalar squares(0);
    for (int j = 0; j < kModes; ++j) {
      Scalar more = seen[j].square - least;
      if (more > Scalar(kLeastLikely)) more = Scalar(kLeastLikely);
      weight[j] = weight[j] * exponential_of_minus(more * Scalar(0.5)) * square_root(seen[j].narrower);
      squares += weight[j] * seen[j].residual * seen[j].residual * seen[j].narrower;
      total += weight[j];
    }
    likelihood_ = total;
    const Scalar scale = Scalar(1) / total;
    for (int j = 0; j < kModes; ++j) {
      mode_[j] = next[j];
      probability_[j] = weight[j] * scale;
    }
    mix();
    return squares * scale;
  }

  /// Counts what was learned so far by another variance of the noise: `by` times that of before, near 1.
  [[gnu::noinline]] void recount(Scalar by) {
    for (ArmBelief<Scalar>& mode : mode_) mode.recount(by, *prior_);
  }

  /// Of the last look before it was taken in, over that of no residual and an arm that is known; for the noise that
  /// look() was given.
  [[nodiscard]] Scalar likelihood() const { return likelihood_; }
  /// Mean and variance of the mixture.
  [[nodiscard]] const Vector3<Scalar>& value() const { return value_; }
  [[nodiscard]] const Vector3<Scalar>& variance() const { return variance_; }
  /// Of the arm that stays, moves or is exchanged: 0 to 1, their sum 1.
  [[nodiscard]] Scalar probability(int mode) const { return probability_[mode]; }
  /// Whether every variance is positive and every value within the prior's limits.
  [[nodiscard]] bool sound() const {
    for (int i = 0; i < 3; ++i) {
      if (!(variance_(i) > Scalar(0) && value_(i) >= prior_->lowest(i) && value_(i) <= prior_->highest(i)))
        return false;
    }
    return true;
  }

 private:
  static constexpr bool kAllShown[3] = {};
  /// Square of a residual over S where a likelihood ends: no one look decides.
  static constexpr double kLeastLikely = 12;
  static constexpr double kLeastWeight = 1e-12;

  /// Mode j before the look: what each mode knew, by the probability that it has gone over into j. Returns that of j.
  Scalar interact(int j, ArmBelief<Scalar>& mixed) const {
    Scalar share[kModes];
    Scalar sum(0);
    for (int i = 0; i < kModes; ++i) {
      share[i] = probability_[i] * (i == j ? Scalar(1) + walks_->of[i].to[j] : walks_->of[i].to[j]);
      sum += share[i];
    }
    if (sum < Scalar(kLeastWeight)) sum = Scalar(kLeastWeight);
    const Scalar scale = Scalar(1) / sum;
    for (int i = 0; i < kModes; ++i) {
      share[i] = share[i] * scale;
      mixed.value += mode_[i].value * share[i];
    }
    for (int i = 0; i < kModes; ++i) {
      if (!(share[i] > Scalar(0))) continue;
      const Symmetric3<Scalar>& covariance = mode_[i].covariance;
      const Vector3<Scalar> off = mode_[i].value - mixed.value;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c <= r; ++c) mixed.covariance(r, c) += share[i] * (covariance(r, c) + off(r) * off(c));
      }
    }
    return sum;
  }

  /// What may have changed since the look before. An arm that stiffens damps more by half as much, as if its damping
  /// ratio stayed.
  static void walk(ArmBelief<Scalar>& mode, const ArmWalk<Scalar>& walk) {
    const Scalar inertia = mode.value(kInertia);
    const Scalar damping = mode.value(kDamping);
    const Scalar stiffness = mode.value(kStiffness) > Scalar(1) ? mode.value(kStiffness) : Scalar(1);
    const Scalar with_it = walk.damping_with_it * damping;
    Symmetric3<Scalar>& p = mode.covariance;
    p(kInertia, kInertia) += walk.inertia * inertia * inertia;
    p(kDamping, kDamping) += walk.damping * damping * damping + walk.stiffness * with_it * with_it;
    p(kStiffness, kDamping) += walk.stiffness * with_it * stiffness;
    p(kStiffness, kStiffness) += walk.stiffness * stiffness * stiffness;
  }

  /// One measurement, under one hypothesis.
  struct Seen {
    Scalar residual{0};
    Scalar square{0};    ///< of the residual by the instrument, over S
    Scalar narrower{0};  ///< s2 / S
  };
  static Seen correct(ArmBelief<Scalar>& mode, Scalar torque_nm, const Vector3<Scalar>& phi, const Vector3<Scalar>& z,
                      Scalar noise, Scalar shown, const bool (&dark)[3]) {
    const Scalar residual = torque_nm - phi.dot(mode.value);
    const Scalar gain = mode.correct(residual, z, noise, dark);
    return {residual, shown * shown * gain, noise * gain};
  }

  void mix() {
    value_.setConstant(Scalar(0));
    variance_.setConstant(Scalar(0));
    for (int j = 0; j < kModes; ++j) value_ += mode_[j].value * probability_[j];
    for (int j = 0; j < kModes; ++j) {
      for (int i = 0; i < 3; ++i) {
        const Scalar off = mode_[j].value(i) - value_(i);
        variance_(i) += probability_[j] * (mode_[j].covariance(i, i) + off * off);
      }
    }
    // Probabilities sum to one but for rounding.
    for (int i = 0; i < 3; ++i) {
      if (value_(i) < prior_->lowest(i)) value_(i) = prior_->lowest(i);
      if (value_(i) > prior_->highest(i)) value_(i) = prior_->highest(i);
    }
  }

  const Prior<Scalar>* prior_;
  const ArmWalks<Scalar>* walks_;
  ArmBelief<Scalar> mode_[kModes];
  Scalar probability_[kModes] = {};
  Scalar likelihood_{1};
  Vector3<Scalar> value_;
  Vector3<Scalar> variance_;
};

}  // namespace steerid
