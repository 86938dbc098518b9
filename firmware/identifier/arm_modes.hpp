// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An arm that stays, moves, is exchanged or lets go: four hypotheses of how J, B and C change, and what each look says.
//
// A driver co-contracts within 0.3 to 30 s, takes a hand off or leaves the wheel. No single forgetting rule follows
// that and is accurate while nothing changes. So Kalman filters of the same parameters run side by side, each with
// another random walk, and exchange what they know by how often one mode follows another (interacting multiple model
// estimator: Blom and Bar-Shalom 1988, IEEE Trans. Automatic Control 33; their notation).
//
//   mode      C, B per sqrt(s)   J per sqrt(s)   entered    left
//   stays     1 %                0.1 %           -          to moves 0.1/s, to exchanged 0.02/s, to released 0.002/s
//   moves     25 %               0.1 %           0.1/s      to stays 0.3/s, to exchanged 0.02/s, to released 0.002/s
//   exchanged 100 %              100 %           0.02/s     to stays 2/s, to released 0.002/s
//   released  1 %                0.1 %           0.002/s    to exchanged 0.1/s
//
// Released is the wheel without hands: who enters it has the inertia and damping of the wheel alone and no spring
// (BareWheel), and who leaves it is any driver (Prior). Above the torsion bar that holds whatever the rack does.
//
// The rates are set by hand, without a source: a change every ten seconds that takes three, another grip every minute,
// hands that leave every eight minutes and come back after ten seconds. With 0.03/s to moves and 0.005/s to exchanged
// an arm that stays is more accurate, and more of what is valid on one that moves is wrong; with 0.01/s to released J,
// B and C are valid on 3 to 4 % fewer ticks of arms that stay (docs/adr/0046). What is published is the mixture's mean
// and variance, disagreement of the modes included: where the data do not tell whether the arm has changed, the
// deviation says so.
//
// Each filter is a recursive instrumental variable in symmetric-gain form (Young 2011, chapter 8):
//   e = T - phi' p,  S = s2 + z' P z,  p := p + P z e / S,  P := P - P z z' P / S,  likelihood N(e + z' (q - p); 0, S)
// with e of the mixture's mean q for the likelihood: modes differ by what the instrument shows, not by what noise in
// the measured motion would. A residual of more than three deviations moves p by no more than one of three (Huber's
// weight).
//
// Units: p and P in those of J, B, C; e in Nm; s2 in Nm^2. Cost a look, by counting: some 500 multiplications, 10
// divisions, 6 square roots.
#pragma once

#include "base/exponential.hpp"
#include "base/square_root.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

/// Parameters and their covariance under one hypothesis.
template <class Scalar>
struct ArmBelief {
  Vector3<Scalar> value = Vector3<Scalar>::Constant(Scalar(0));
  Matrix3<Scalar> covariance = Matrix3<Scalar>::Constant(Scalar(0));
};

template <class Scalar>
class ArmModes {
 public:
  static constexpr int kModes = 4;
  static constexpr int kStays = 0;
  static constexpr int kReleased = 3;
  static constexpr double kPeriod_s = 0.04;  ///< from one look to the next

  ArmModes(const Prior<Scalar>& prior, const BareWheel<Scalar>& wheel) : prior_(&prior), wheel_(&wheel) {
    restart(prior.value, prior.spread);
  }

  /// From `value` with independent deviations; an arm that stays.
  void restart(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation) {
    for (int j = 0; j < kModes; ++j) {
      mode_[j] = independent(value, deviation);
      probability_[j] = Scalar(j == kStays ? 1 : 0);
    }
    mix();
  }

  /// Whitened torque, measured regressor and instrument, and the variance of the noise, all of one look. Returns
  /// e^2 s2 / S averaged over the modes: what the look says of that variance.
  [[gnu::noinline]] Scalar look(Scalar torque_nm, const Vector3<Scalar>& phi, const Vector3<Scalar>& z, Scalar noise) {
    ArmBelief<Scalar> next[kModes];
    Scalar weight[kModes];
    Scalar total(0);
    Scalar squares(0);
    const Scalar residual = torque_nm - phi.dot(value_);
    const ArmBelief<Scalar> bare = independent(wheel_->value, wheel_->spread);
    const ArmBelief<Scalar> anyone = independent(prior_->value, prior_->spread);
    for (int j = 0; j < kModes; ++j) {
      weight[j] = interact(j, bare, anyone, next[j]);
      walk(next[j], kWalk[j]);
      // By the instrument alone: measured motion has noise in it, of which a smaller arm always leaves less, so that by
      // it an arm at rest would be none.
      const Scalar shown = residual + z.dot(value_ - next[j].value);
      squares += correct(next[j], torque_nm, phi, z, noise, shown, weight[j]);
      hold(next[j]);
      total += weight[j];
    }
    const Scalar scale = Scalar(1) / total;
    for (int j = 0; j < kModes; ++j) {
      mode_[j] = next[j];
      probability_[j] = weight[j] * scale;
    }
    mix();
    return squares * scale;
  }

  /// Mean and variance of the mixture.
  [[nodiscard]] const Vector3<Scalar>& value() const { return value_; }
  [[nodiscard]] const Vector3<Scalar>& variance() const { return variance_; }
  /// Of the arm that stays, moves, is exchanged or has let go: 0 to 1, their sum 1.
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
  /// Variances a look, of relative changes; and the probability a look of going over into each mode.
  struct Walk {
    Scalar stiffness, damping_with_it, damping, inertia;
    Scalar to[kModes];
  };
  static constexpr double a_look(double per_s) { return per_s * kPeriod_s; }
  static constexpr Walk kWalk[kModes] = {
      {Scalar(a_look(1e-4)),
       Scalar(0.5),
       Scalar(a_look(1e-5)),
       Scalar(a_look(1e-6)),
       {Scalar(a_look(-0.122)), Scalar(a_look(0.1)), Scalar(a_look(0.02)), Scalar(a_look(0.002))}},
      {Scalar(a_look(0.0625)),
       Scalar(0.5),
       Scalar(a_look(6e-3)),
       Scalar(a_look(1e-6)),
       {Scalar(a_look(0.3)), Scalar(a_look(-0.322)), Scalar(a_look(0.02)), Scalar(a_look(0.002))}},
      {Scalar(a_look(1.0)),
       Scalar(0.5),
       Scalar(a_look(0.1)),
       Scalar(a_look(1.0)),
       {Scalar(a_look(2)), Scalar(0), Scalar(a_look(-2.002)), Scalar(a_look(0.002))}},
      {Scalar(a_look(1e-4)),
       Scalar(0),
       Scalar(a_look(1e-5)),
       Scalar(a_look(1e-6)),
       {Scalar(0), Scalar(0), Scalar(a_look(0.1)), Scalar(a_look(-0.1))}},
  };
  static constexpr double kWild = 9;          ///< square of a residual over S: three deviations
  static constexpr double kLeastLikely = 12;  ///< the same where a likelihood ends: no one sample decides
  static constexpr double kWidest = 4;        ///< times the prior's variance: no arm is known less than that
  static constexpr double kLeastWeight = 1e-12;

  /// Mode j before the look: what each mode knew, by the probability that it has gone over into j. Returns that of j.
  Scalar interact(int j, const ArmBelief<Scalar>& bare, const ArmBelief<Scalar>& anyone,
                  ArmBelief<Scalar>& mixed) const {
    // Hands that let go leave the bare wheel, hands that come are anyone's.
    const auto from = [&](int i) -> const ArmBelief<Scalar>& {
      if (i == j || (i != kReleased && j != kReleased)) return mode_[i];
      return j == kReleased ? bare : anyone;
    };
    Scalar share[kModes];
    Scalar sum(0);
    for (int i = 0; i < kModes; ++i) {
      share[i] = probability_[i] * (i == j ? Scalar(1) + kWalk[i].to[j] : kWalk[i].to[j]);
      sum += share[i];
    }
    if (sum < Scalar(kLeastWeight)) sum = Scalar(kLeastWeight);
    const Scalar scale = Scalar(1) / sum;
    for (int i = 0; i < kModes; ++i) {
      share[i] = share[i] * scale;
      mixed.value += from(i).value * share[i];
    }
    for (int i = 0; i < kModes; ++i) {
      if (!(share[i] > Scalar(0))) continue;
      const Matrix3<Scalar>& covariance = from(i).covariance;
      const Vector3<Scalar> off = from(i).value - mixed.value;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c <= r; ++c) mixed.covariance(r, c) += share[i] * (covariance(r, c) + off(r) * off(c));
      }
    }
    return sum;
  }

  [[nodiscard]] static ArmBelief<Scalar> independent(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation) {
    ArmBelief<Scalar> belief;
    belief.value = value;
    for (int i = 0; i < 3; ++i) belief.covariance(i, i) = deviation(i) * deviation(i);
    return belief;
  }

  /// What may have changed since the look before. An arm that stiffens damps more by half as much, as if its damping
  /// ratio stayed.
  static void walk(ArmBelief<Scalar>& mode, const Walk& walk) {
    const Scalar inertia = mode.value(kInertia);
    const Scalar damping = mode.value(kDamping);
    const Scalar stiffness = mode.value(kStiffness) > Scalar(1) ? mode.value(kStiffness) : Scalar(1);
    const Scalar with_it = walk.damping_with_it * damping;
    Matrix3<Scalar>& p = mode.covariance;
    p(kInertia, kInertia) += walk.inertia * inertia * inertia;
    p(kDamping, kDamping) += walk.damping * damping * damping + walk.stiffness * with_it * with_it;
    p(kStiffness, kDamping) += walk.stiffness * with_it * stiffness;
    p(kStiffness, kStiffness) += walk.stiffness * stiffness * stiffness;
  }

  /// One measurement. `weight` is multiplied by the likelihood of the residual `shown`; returns e^2 s2 / S times the
  /// new weight.
  static Scalar correct(ArmBelief<Scalar>& mode, Scalar torque_nm, const Vector3<Scalar>& phi, const Vector3<Scalar>& z,
                        Scalar noise, Scalar shown, Scalar& weight) {
    Matrix3<Scalar>& p = mode.covariance;
    Vector3<Scalar> pz;
    for (int r = 0; r < 3; ++r) {
      pz(r) = Scalar(0);
      for (int c = 0; c < 3; ++c) pz(r) += (c <= r ? p(r, c) : p(c, r)) * z(c);
    }
    const Scalar spread = noise + z.dot(pz);
    const Scalar gain = Scalar(1) / spread;
    const Scalar residual = torque_nm - phi.dot(mode.value);
    Scalar square = residual * residual * gain;
    // A residual of more than three deviations counts as one of three (Huber 1964).
    const Scalar by = square > Scalar(kWild) ? residual * square_root(Scalar(kWild) / square) : residual;
    mode.value += pz * (gain * by);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c <= r; ++c) p(r, c) -= pz(r) * pz(c) * gain;
    }
    square = shown * shown * gain;
    if (square > Scalar(kLeastLikely)) square = Scalar(kLeastLikely);
    weight = weight * exponential_of_minus(square * Scalar(0.5)) * square_root(noise * gain);
    return weight * residual * residual * noise * gain;
  }

  /// Inside the limits of values and of what may be unknown; a variance that rounding lost is the prior's again.
  void hold(ArmBelief<Scalar>& mode) const {
    for (int i = 0; i < 3; ++i) {
      if (mode.value(i) < prior_->lowest(i)) mode.value(i) = prior_->lowest(i);
      if (mode.value(i) > prior_->highest(i)) mode.value(i) = prior_->highest(i);
      const Scalar widest = prior_->spread(i) * prior_->spread(i) * Scalar(kWidest);
      Scalar& variance = mode.covariance(i, i);
      if (variance > Scalar(0) && variance <= widest) continue;
      const Scalar shrink = variance > widest ? square_root(widest / variance) : Scalar(0);
      for (int k = 0; k < 3; ++k) {
        if (k != i) mode.covariance(k > i ? k : i, k > i ? i : k) *= shrink;
      }
      variance = widest;
    }
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
  const BareWheel<Scalar>* wheel_;
  ArmBelief<Scalar> mode_[kModes];
  Scalar probability_[kModes] = {};
  Vector3<Scalar> value_;
  Vector3<Scalar> variance_;
};

}  // namespace steerid
