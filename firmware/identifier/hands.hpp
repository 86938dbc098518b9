// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether anybody holds the wheel, from the torsion bar: three hypotheses, compared by what each said of the next look.
//
//   held      an arm: J, B, C by the instrument (arm_modes.hpp) and a driver who pulls as he likes
//   released  the wheel alone: its own J and B, no spring, and nobody's torque; what the bar's sensor is off
//   touched   the wheel and a finger or two: a little more of J and B, a spring of a few Nm/rad, and some torque of
//   theirs
//
// What tells is not the spring alone. Without hands nothing is left unexplained but the sensors' noise, which is known
// (sensor_noise.hpp; up to three times as much, since a sensor with a low pass of its own hides some) and ten times
// less than what a driver adds. So whatever moves the wheel shows it, road and assist as well as a probe: released and
// touched are Kalman filters on the measured motion itself, without an instrument: the one of J, B and the offset, with
// the sensors' noise; the other of J, B and C beside a pull, the mean of what it has left in the last eighth of a
// second, with what it has left beyond that in the last two seconds. An arm whose driver is quiet leaves as little: of
// held the noise is that of the last second, where that is less than usual. Where nothing moves all three say the same,
// and what was known before stays.
//
// Hidden Markov model of three states (Rabiner 1989, Proc. IEEE 77), forward recursion; a hypothesis that is entered
// begins with its prior. Rates by hand: hands leave every eight minutes and come back after ten seconds, fingers
// likewise. A quarter to five times those to released, and to and from touched, change the time to tell by less than
// 0.1 s (docs/adr/0007).
//
//   from       to held   to released   to touched
//   held       -         0.002/s       0.002/s
//   released   0.1/s     -             0.02/s
//   touched    0.05/s    0.02/s        -
//
// The sensors' noise behind the common filter of closed_loop_identifier.hpp, seen every fourth tick: torque noise of
// variance s2 leaves 0.051 s2 of white noise once 0.4 of the look before is taken off, angle noise 166 s2 kg2m4/s4 by a
// wheel of 0.035 kg m2. A test works both out from the filter.
//
// A bar's sensor is off by a tenth of an Nm and more, which is ten times its noise. So the third number of released is
// that offset, in the place of the stiffness that an empty wheel does not have; fingers have it in their pull.
//
// Where a wheel with dry friction of its own sticks, the friction bears what is on it (wheel_friction.hpp). That
// explains the torque of released and of touched, and tells as little as the friction may bear: its square is noise to
// both.
//
// Above a torsion bar only: a rim transducer has no wheel above it. Fingers that follow the wheel without a torque of
// their own on a road that does not move it cannot be told from none.
//
// Units: Nm, rad, J, B, C. Cost a look: two corrections of arm_belief.hpp, some 250 multiplications, 12 divisions, 6
// square roots; a tick: SensorNoise twice.
#pragma once

#include "base/exponential.hpp"
#include "base/square_root.hpp"
#include "identifier/arm_belief.hpp"
#include "identifier/parameters.hpp"
#include "identifier/sensor_noise.hpp"

namespace steerid {

/// What one look showed, behind the common filter but not whitened.
template <class Scalar>
struct DirectLook {
  Scalar torque_nm;
  Scalar borne_nm;         ///< of it by the wheel's own friction, if nobody holds it
  Vector3<Scalar> motion;  ///< th'', th', th as measured
};

/// What the arm that holds the wheel made of the same look.
template <class Scalar>
struct HeldLook {
  Scalar likelihood;  ///< over that of no residual and a known arm, for `noise`
  Scalar square;      ///< of the residual, Nm^2
  Scalar noise;       ///< its usual variance, Nm^2
};

template <class Scalar>
class Hands {
 public:
  explicit Hands(const BareWheel<Scalar>& wheel)
      : bare_(&wheel), released_(entering(kReleased)), touched_(entering(kTouched)) {}

  /// Takes in one sample as it came, for the sensors' noise.
  void push(Scalar torque_nm, Scalar angle_rad) {
    torque_noise_.push(torque_nm);
    angle_noise_.push(angle_rad);
  }
  /// The next sample is no neighbour of the one before.
  void break_here() {
    torque_noise_.break_here();
    angle_noise_.break_here();
  }

  /// Takes in a look and the one before it.
  [[gnu::noinline]] void look(const DirectLook<Scalar>& now, const DirectLook<Scalar>& before,
                              const HeldLook<Scalar>& held) {
    const Scalar borne = now.borne_nm - before.borne_nm * Scalar(kFromBefore);
    const Scalar may_be_borne = borne * borne;
    const Scalar torque = now.torque_nm - before.torque_nm * Scalar(kFromBefore) - borne;
    const Vector3<Scalar> motion = now.motion - before.motion * Scalar(kFromBefore);
    Scalar least = torque_noise_.variance() * Scalar(kOfTorqueNoise) + angle_noise_.variance() * Scalar(kOfAngleNoise);
    if (least < Scalar(kLeastNoise)) least = Scalar(kLeastNoise);
    const Scalar step = (now.motion(kStiffness) - before.motion(kStiffness)) * Scalar(kWeakest);
    shown_ += (step * step - shown_) * Scalar(kLeftShare);
    // A bar that reads next to nothing while the wheel moves has lost its supply: released finds a wheel of no mass.
    tells_ = shown_ > least * Scalar(kSeen * kLeftShare) &&
             released_.value(kInertia) > bare_->value(kInertia) - Scalar(kFarthest) * bare_->spread(kInertia);

    Scalar weight[kStates];
    for (int j = 0; j < kStates; ++j) {
      Scalar stays(0);
      weight[j] = entered(j, stays);
      if (j == kHeld) continue;
      ArmBelief<Scalar>& belief = j == kReleased ? released_ : touched_;
      belief.blend(entering(j), Scalar(1) - stays);
    }
    weight[kHeld] = weight[kHeld] * of_held(held, least);
    Scalar left(0);
    const Scalar most = least * Scalar(kHidden);
    const Scalar noise = left_released_ < least ? least : left_released_ > most ? most : left_released_;
    const Vector3<Scalar> alone{motion(kInertia), motion(kDamping), Scalar(1 - kFromBefore)};
    weight[kReleased] = weight[kReleased] * of(released_, torque, alone, noise + may_be_borne, least, left);
    left_released_ += (left - left_released_) * Scalar(kLeftShare);
    wander(touched_);
    if (left_touched_ < least) left_touched_ = least;
    const Scalar pull = torque - pull_;
    weight[kTouched] = weight[kTouched] * of(touched_, pull, motion, left_touched_ + may_be_borne, least, left);
    pull_ += (pull - motion.dot(touched_.value)) * Scalar(kPullShare);
    left_touched_ += (left - left_touched_) * Scalar(kLeftShare);

    Scalar total(0);
    for (const Scalar w : weight) total += w;
    const Scalar scale = Scalar(1) / total;
    for (int j = 0; j < kStates; ++j) {
      probability_[j] = weight[j] * scale;
      if (probability_[j] < Scalar(kLeastWeight)) probability_[j] = Scalar(kLeastWeight);
    }
  }

  /// Probability that nobody holds the wheel, and that fingers do: 0 to 1. The first is 0 while nothing moves, and
  /// where what moves has not the mass of a wheel.
  [[nodiscard]] Scalar released() const { return tells_ ? probability_[kReleased] : Scalar(0); }
  [[nodiscard]] Scalar touched() const { return probability_[kTouched]; }
  /// What the bar's sensor is off, if nobody holds the wheel, Nm.
  [[nodiscard]] Scalar bar_off_nm() const { return released_.value(kOffset); }
  /// J, B and C of the wheel as it is without hands, and their variances.
  [[nodiscard]] Scalar wheel(int i) const { return i == kOffset ? bare_->value(i) : released_.value(i); }
  [[nodiscard]] Scalar wheel_variance(int i) const {
    return i == kOffset ? bare_->spread(i) * bare_->spread(i) : released_.covariance(i, i);
  }

 private:
  static constexpr int kHeld = 0, kReleased = 1, kTouched = 2, kStates = 3;
  static constexpr int kOffset = kStiffness;  ///< its place among the numbers of released
  static constexpr double a_look(double per_s) { return per_s * 0.04; }
  static constexpr Scalar kTo[kStates][kStates] = {
      {Scalar(1 - a_look(0.004)), Scalar(a_look(0.002)), Scalar(a_look(0.002))},
      {Scalar(a_look(0.1)), Scalar(1 - a_look(0.12)), Scalar(a_look(0.02))},
      {Scalar(a_look(0.05)), Scalar(a_look(0.02)), Scalar(1 - a_look(0.07))}};
  static constexpr double kFromBefore = 0.4;
  static constexpr double kOfTorqueNoise = 0.051;
  static constexpr double kOfAngleNoise = 166;
  static constexpr double kSeen = 4;                ///< square of two deviations, within the two seconds of kLeftShare
  static constexpr double kWeakest = 3;             ///< Nm/rad: no arm is below (app/driver_state.hpp)
  static constexpr double kOffset_nm = 0.1;         ///< by which a torsion bar's sensor is off
  static constexpr double kLeastNoise = 1e-8;       ///< Nm^2: a tenth of the port's resolution
  static constexpr double kLeastLikely = 12;        ///< square over its variance where a likelihood ends
  static constexpr double kLeastWeight = 1e-6;      ///< no hypothesis is ruled out for longer than a few looks
  static constexpr double kLatelyShare = 1.0 / 50;  ///< 2 s
  static constexpr double kLeftShare = 1.0 / 50;    ///< 2 s
  static constexpr double kPullShare = 0.3;         ///< an eighth of a second
  static constexpr double kFarthest = 2.5;          ///< deviations of a wheel's J
  static constexpr double kHidden = 3;              ///< most of a sensor's noise over what its samples show of it
  /// Of fingers, beside the wheel: J, B and C that they add, and how much those differ.
  static constexpr Triple<Scalar> kFingers{Scalar(0.007), Scalar(0.14), Scalar(2)};
  static constexpr Triple<Scalar> kFingersSpread{Scalar(0.012), Scalar(0.12), Scalar(1.5)};

  /// Probability of state j before the look; `stays` is the share of it that was there already.
  Scalar entered(int j, Scalar& stays) const {
    Scalar sum(0);
    for (int i = 0; i < kStates; ++i) sum += probability_[i] * kTo[i][j];
    stays = probability_[j] * kTo[j][j] / sum;
    return sum;
  }
  [[nodiscard, gnu::noinline]] ArmBelief<Scalar> entering(int j) const {
    Vector3<Scalar> value = bare_->value;
    if (j == kReleased) {
      value(kOffset) = Scalar(0);
      const Vector3<Scalar> spread{bare_->spread(kInertia), bare_->spread(kDamping), Scalar(kOffset_nm)};
      return ArmBelief<Scalar>::independent(value, spread);
    }
    for (int i = 0; i < 3; ++i) value(i) += kFingers(i);
    return ArmBelief<Scalar>::independent(value, kFingersSpread);
  }
  /// Fingers press now more, now less: variances a look.
  static void wander(ArmBelief<Scalar>& belief) {
    static constexpr Triple<Scalar> kWander{Scalar(a_look(1e-4)), Scalar(a_look(1e-2)), Scalar(a_look(1e-2))};
    for (int i = 0; i < 3; ++i) {
      const Scalar size = i == kStiffness && belief.value(i) < Scalar(1) ? Scalar(1) : belief.value(i);
      belief.covariance(i, i) += kWander(i) * size * size;
    }
  }

  /// Likelihood of a look over that of a residual of nothing in noise of variance `least`.
  [[gnu::noinline]] static Scalar of(ArmBelief<Scalar>& belief, Scalar torque, const Vector3<Scalar>& motion,
                                     Scalar noise, Scalar least, Scalar& left) {
    const Scalar residual = torque - motion.dot(belief.value);
    const Scalar gain = belief.correct(residual, motion, noise);
    left = residual * residual * noise * gain;
    Scalar square = residual * residual * gain;
    if (square > Scalar(kLeastLikely)) square = Scalar(kLeastLikely);
    return exponential_of_minus(square * Scalar(0.5)) * square_root(least * gain);
  }
  Scalar of_held(const HeldLook<Scalar>& held, Scalar least) {
    Scalar quiet = lately_ < held.noise ? lately_ : held.noise;
    if (quiet < least) quiet = least;
    lately_ += (held.square - lately_) * Scalar(kLatelyShare);
    const auto square = [&held](Scalar noise) {
      const Scalar x = held.square / noise;
      return x < Scalar(kLeastLikely) ? x : Scalar(kLeastLikely);
    };
    return held.likelihood * exponential_of_minus((square(quiet) - square(held.noise)) * Scalar(0.5)) *
           square_root(least / quiet);
  }

  const BareWheel<Scalar>* bare_;
  SensorNoise<Scalar> torque_noise_, angle_noise_;
  ArmBelief<Scalar> released_, touched_;
  Scalar probability_[kStates] = {Scalar(1), Scalar(0), Scalar(0)};
  Scalar shown_{0};     ///< mean square of what the weakest arm would make of the motion of the last two seconds, Nm^2
  bool tells_ = false;  ///< the wheel moves, and is one
  Scalar lately_{0};    ///< mean square of what the last second left of an arm, Nm^2
  Scalar left_released_{0};  ///< mean square of what the last two seconds left unexplained, Nm^2
  Scalar left_touched_{0};
  Scalar pull_{0};  ///< of fingers, and what the sensor is off, Nm: the mean of the last eighth of a second
};

}  // namespace steerid
