// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The identifier of a wheel, whatever its sensors, and whether its arm stays or changes: two identifiers side by side.
//
//   steady    identifier.hpp: long memory, at its bound for an arm that stays; needs all torque that acts
//   follower  closed_loop_identifier.hpp: short memory, follows an arm that changes; needs the driver's torque or a
//   probe
//
// Without the driver's torque the follower answers. With it the steady one does, until the data contradict it: both
// predict each look (25 a second), and the probability that the arm is not the steady one's any more follows from how
// likely the looks are under either (change_probability.hpp), as far as the motion shows B and C. From a half on the
// follower answers for each parameter that it knows; one that it does not know keeps the steady one's value and is not
// valid: a change too fast to be followed is told, not guessed. Once the follower has known an arm for three seconds
// that stays, the steady one goes on with it.
//
// The deviation is that of the mixture. A variance would hold too little of it: what one of the two says with a
// probability of 5 % belongs into an interval of 95 %. So where they differ by d, and the one that does not answer has
// the deviation s and the probability o, the deviation holds that one's whole interval, d / 1.96 + s, by the share
// min(1, o / 5 %), and more as o nears one. In o a change is as likely beforehand as the follower's walks have it
// (arm_walks.hpp). Another answer is dear, so for that one it is ten times less likely; a truth that is left out is
// dear for an interval. So the interval of an arm that stays holds what the last seconds could not exclude. What the
// motion does not show has no other answer.
//
// The follower begins when the steady one has an arm, and judges 2.7 s later, about when that one is first sure of it.
// It begins anew when neither of the two knows the wheel any more: after a fault.
//
// Units: Nm, rad, kg m2, Nms/rad, Nm/rad. Cost and memory: docs/benchmarks.md.
#pragma once

#include "identifier/change_probability.hpp"
#include "identifier/closed_loop_identifier.hpp"
#include "identifier/identifier.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

/// One sample, in Nm and rad.
template <class Scalar>
struct WheelSample {
  Scalar torque_nm{0};  ///< what is known of the torque on arm and wheel (port/equation.hpp)
  Scalar angle_rad{0};
  Scalar probe_nm{0};  ///< what the motor was asked to add for identification

  /// On a straight line from this one (share 0) to `to` (share 1).
  [[nodiscard]] WheelSample towards(const WheelSample& to, Scalar share) const {
    return {torque_nm + (to.torque_nm - torque_nm) * share, angle_rad + (to.angle_rad - angle_rad) * share,
            probe_nm + (to.probe_nm - probe_nm) * share};
  }
};

template <class Scalar>
class WheelIdentifier {
 public:
  /// `settings` are not copied, so that they can lie in flash: they have to live as long as the identifier does.
  explicit WheelIdentifier(const IdentifierSettings<Scalar>& settings = kSteeringWheel<Scalar>,
                           const ClosedLoopSettings<Scalar>& column = kSteeringColumn<Scalar>)
      : steady_(settings), follower_(column) {}
  explicit WheelIdentifier(const IdentifierSettings<Scalar>&& passing,
                           const ClosedLoopSettings<Scalar>& column = kSteeringColumn<Scalar>) = delete;
  WheelIdentifier(const IdentifierSettings<Scalar>& settings, const ClosedLoopSettings<Scalar>&& passing) = delete;

  /// Whether `torque_nm` of a sample holds the driver's own torque. What was learned or restored stays, but for what
  /// the follower learned by the other torque.
  void voluntary_torque_known(bool known) {
    if (known != known_ && begun_) begin_anew();
    known_ = known;
  }

  /// Back to the prior, everything forgotten.
  void restart() {
    steady_.restart();
    follower_.forget_rest();
    begin_anew();
  }
  /// After a gap too long to bridge: the filters start again on the next samples, what was learned stays.
  void resettle() {
    steady_.resettle();
    follower_.resettle();
  }
  /// Goes on from what was known at power-off (Identifier::restore), whichever answers.
  void restore(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation, Scalar noise_nm) {
    steady_.restore(value, deviation, noise_nm);
    begin_anew();
    follower_.restore(value, deviation);
  }
  /// Takes in one sample; learn = false lets it through the filters without believing it.
  void update(const WheelSample<Scalar>& sample, bool learn = true);

  /// That the arm is not what the steady identifier says: 0 to 1.
  [[nodiscard]] Scalar changed() const { return known_ ? change_.changed() : Scalar(1); }
  /// Whether the follower answers for this parameter.
  [[nodiscard]] bool follows(int parameter) const {
    return !known_ || (changed() >= Scalar(0.5) && follower_.belief(parameter) == Belief::kValid && shows());
  }

  [[nodiscard]] Vector3<Scalar> value() const { return Vector3<Scalar>(value(0), value(1), value(2)); }
  [[nodiscard]] Scalar value(int parameter) const {
    return follows(parameter) ? follower_.value(parameter) : steady_.value(parameter);
  }
  /// One standard deviation of each parameter; never more than the prior's.
  [[nodiscard]] Vector3<Scalar> standard_deviation() const;
  /// The same of the identifier that answers, had the arm not changed just now.
  [[nodiscard]] Scalar deviation_of_answer(int parameter) const {
    return (follows(parameter) ? follower_.standard_deviation() : steady_.standard_deviation())(parameter);
  }
  [[nodiscard]] Belief belief(int parameter) const {
    if (follows(parameter)) return follower_.belief(parameter);
    const Belief steady = steady_.belief(parameter);
    return changed() >= Scalar(0.5) && steady == Belief::kValid ? Belief::kConverging : steady;
  }
  /// Standard deviation of the whitened residual, Nm.
  [[nodiscard]] Scalar noise_nm() const { return known_ ? steady_.noise_nm() : follower_.noise_nm(); }
  /// That nobody holds the wheel, above a torsion bar and without the driver's torque: 0 to 1.
  [[nodiscard]] Scalar released() const { return follower_.released(); }
  [[nodiscard]] const Prior<Scalar>& prior() const { return steady_.prior(); }
  [[nodiscard]] bool sound() const { return steady_.sound() && follower_.sound(); }

  [[nodiscard]] const Identifier<Scalar>& steady() const { return steady_; }
  [[nodiscard]] const ClosedLoopIdentifier<Scalar>& follower() const { return follower_; }

 private:
  static constexpr double kLook_s = ArmModes<Scalar>::kPeriod_s;
  static constexpr double kChange = 0.01 * kLook_s;
  static constexpr double kReturn = 0.2 * kLook_s;
  /// How many times likelier a change is taken to be for the interval than for the answer: as the walks have it.
  static constexpr double kCautious = kWalksByTorque<double>.of[kArmStays].to[kArmMoves] / kChange;
  /// Share of a look's evidence that counts: an unmeasured torque with a corner of 0.3 Hz is the same for some five
  /// looks, which are not independent then.
  static constexpr double kCounts = 0.2;
  static constexpr std::int8_t kFollowFor = 75;  ///< looks, 3 s: as long as a change takes that the modes expect
  static constexpr double kInterval = 1.96;      ///< deviations, ...
  static constexpr double kOutside = 0.05;       ///< ... and the probability outside of them

  void begin_anew() {
    follower_.restart();
    change_.reset();
    followed_ = 0;
    begun_ = false;
  }
  /// Whether motion fast enough to show B is there: what is slower than that may be a torque that no sensor sees. And
  /// whether it shows C: to a short memory a machine with friction and no spring is another arm every second.
  [[nodiscard]] bool shows() const {
    const Belief damping = steady_.belief(kDamping);
    return (damping == Belief::kValid || damping == Belief::kConverging) &&
           follower_.belief(kStiffness) != Belief::kNotExcited;
  }
  static Scalar at_most(Scalar most, Scalar x) { return x > most ? most : x; }
  /// changed(), had a change been kCautious times as likely beforehand: the same evidence by other odds.
  [[nodiscard]] Scalar may_have_changed() const {
    return Scalar(kCautious) * changed() / (Scalar(1) + Scalar(kCautious - 1) * changed());
  }
  /// What a look of the follower says of the steady one.
  [[gnu::noinline]] void weigh();

  Identifier<Scalar> steady_;
  ClosedLoopIdentifier<Scalar> follower_;
  ChangeProbability<Scalar> change_;
  std::int8_t followed_ = 0;  ///< looks in a row that the follower has answered with an arm that stays
  bool known_ = true;
  bool begun_ = false;
};

template <class Scalar>
void WheelIdentifier<Scalar>::update(const WheelSample<Scalar>& sample, bool learn) {
  if (known_) {
    steady_.rests_at(follower_.rest_rad());
    steady_.update(sample.torque_nm, sample.angle_rad, learn);
    // The steady one searches from the prior, or has an arm taken back, where what it knew did not explain the samples.
    // If the follower does, the arm has changed. If it knows nothing either, a sensor was at fault, and what it made of
    // that is of no use.
    const bool lost = steady_.phase() == Phase::kSearching || steady_.recovered();
    if (begun_ && lost && !follower_.knows()) begin_anew();
    if (!begun_) {
      if (steady_.phase() < Phase::kRefining) return;
      begun_ = true;
      follower_.begin(prior());
    }
    if (!follower_.learns()) follower_.assume(steady_.value(), steady_.standard_deviation());
  }
  follower_.update(sample.torque_nm, sample.angle_rad, sample.probe_nm, learn,
                   {steady_.value(), steady_.torque_noise().variance()});
  if (follower_.looked()) weigh();
}

template <class Scalar>
void WheelIdentifier<Scalar>::weigh() {
  change_.take(shows() ? follower_.evidence() * Scalar(kCounts) : Scalar(0), Scalar(kChange), Scalar(kReturn));
  const bool stays = follower_.modes().probability(ArmModes<Scalar>::kStays) > Scalar(0.5);
  const bool known = follows(kInertia) && follows(kDamping) && follows(kStiffness);
  if (!stays || !known || steady_.phase() != Phase::kWatching) {
    followed_ = 0;
    return;
  }
  if (++followed_ < kFollowFor) return;
  followed_ = 0;
  steady_.go_on_with(follower_.value(), follower_.standard_deviation());
}

template <class Scalar>
Vector3<Scalar> WheelIdentifier<Scalar>::standard_deviation() const {
  if (!known_) return follower_.standard_deviation();
  const Vector3<Scalar> steady = steady_.standard_deviation();
  const Vector3<Scalar> follower = follower_.standard_deviation();
  const Vector3<Scalar> difference = follower_.value() - steady_.value();
  Vector3<Scalar> deviation;
  for (int i = 0; i < 3; ++i) {
    const bool follows_it = follows(i);
    const Scalar answer = follows_it ? follower(i) : steady(i);
    if (!follows_it && steady_.belief(i) == Belief::kNotExcited) {
      deviation(i) = answer;
      continue;
    }
    const Scalar apart = difference(i) < Scalar(0) ? Scalar(0) - difference(i) : difference(i);
    const Scalar reach = apart + Scalar(kInterval) * (follows_it ? steady(i) : follower(i));
    const Scalar other = follows_it ? Scalar(1) - changed() : may_have_changed();
    const Scalar most = Scalar(1 / (kInterval * kInterval));
    const Scalar share = at_most(other > most ? other : most, other * Scalar(1 / (kInterval * kInterval * kOutside)));
    deviation(i) = at_most(prior().spread(i), square_root(answer * answer + share * reach * reach));
  }
  return deviation;
}

}  // namespace steerid
