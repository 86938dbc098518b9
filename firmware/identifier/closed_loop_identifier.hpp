// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The identifier for a driver whose own torque nobody measures: J, B and C from a torsion bar or a rim transducer.
//
//   T = J th'' + B th' + C th + v     T: - torsion bar or - rim, what the sensor knows of the torque on the wheel
//                                     v: the driver's own, voluntary torque, and the sensors' noise
//
// v is several times as large as T below 0.5 Hz and moves the wheel as well, so that regression of T on the motion
// finds what lies below the sensor, not the arm. Consistent is what correlates with an instrument that is independent
// of v: the motion that the probe has caused (instrument.hpp). Efficient is what is weighted by the spectrum of v: an
// autoregression of what is left unexplained (autoregressive_noise.hpp). And the arm may change at any time
// (arm_modes.hpp). docs/adr/0006 has the comparison with a prediction error method.
//
//   100 Hz   common filter of 4 Hz on T, angle and source; derivatives; the source's Laguerre functions
//    25 Hz   whiten; instrument's regression; three filters of J, B, C and their mixture; variance of the noise
//   2.5 Hz   coefficients of the whitening filter and of the instrument; what may be believed
//
// T itself is the source in the place of a probe where the road makes it: while less than 15 % of the power of the
// whitened T, what the probe has caused taken off, is v. What of v is new in a look is independent of all that was
// before it, and T answers it through the column only; so a regression on the motion that T has caused is nearly as
// consistent as one on the probe's, and a rough road moves the wheel several times as far as a probe of 0.5 Nm does
// (docs/adr/0006).
//
// Where no probe has been asked for lately, T is the source as well. It is independent of v only where there is hardly
// any v: hands that rest. So the deviation then holds, beside chance, the share of the torque that stays unexplained,
// which is the most that a regression on it can be off by.
//
// Where the driver's own torque is known as well, T is all that acts, v is noise, and the motion of a modelled wheel
// takes the instrument's place (modelled_motion.hpp): then this is the identifier of short memory that follows an arm
// which changes, beside the steady one (wheel_identifier.hpp). Until it learns it has the steady one's arm, so that the
// noise which it learns first is noise; and that nobody holds the wheel is told by the arm.
//
// Wheels with another machine behind it, samples of another rate: not for this identifier; its filters are a steering
// wheel's at 100 Hz.
//
// No heap, no exception, no libm, no clock.
#pragma once

#include <cstdint>
#include <memory>

#include "identifier/arm_modes.hpp"
#include "identifier/autoregressive_noise.hpp"
#include "identifier/differentiator.hpp"
#include "identifier/hands.hpp"
#include "identifier/identifier.hpp"
#include "identifier/instrument.hpp"
#include "identifier/modelled_motion.hpp"
#include "identifier/noise_information.hpp"
#include "identifier/parameters.hpp"
#include "identifier/rest_angle.hpp"
#include "identifier/second_order_filter.hpp"
#include "identifier/wheel_friction.hpp"

namespace steerid {

template <class Scalar>
struct ClosedLoopSettings {
  Prior<Scalar> prior{.value = {Scalar(0.1), Scalar(1.5), Scalar(20)}, .spread = {Scalar(0.04), Scalar(1), Scalar(20)}};
  BareWheel<Scalar> wheel{};
  /// Relative standard deviation at which J, B and C count as learned.
  Triple<Scalar> usable{Scalar(0.15), Scalar(0.15), Scalar(0.2)};
  /// Nm/rad: the same for C, whatever its value. A wheel without hands has no C, and so no relative deviation; that it
  /// has none is decided between 0 and the 3 Nm/rad that no arm is below (app/driver_state.hpp), by two deviations.
  /// By a probe alone: without one, who steers has a C near nothing and a small deviation.
  Scalar usable_stiffness{1};
};

template <class Scalar>
inline constexpr ClosedLoopSettings<Scalar> kSteeringColumn{};

/// What the identifier that knows all of the torque says: its arm, and the variance of the torque's noise a sample,
/// Nm^2.
template <class Scalar>
struct SteadyAnswer {
  Vector3<Scalar> arm = Vector3<Scalar>::Constant(Scalar(0));
  Scalar torque_noise{0};
};

template <class Scalar>
class ClosedLoopIdentifier {
 public:
  /// `settings` are not copied, so that they can lie in flash: they have to live as long as the identifier does.
  [[gnu::cold,
    gnu::noinline]] explicit ClosedLoopIdentifier(const ClosedLoopSettings<Scalar>& settings = kSteeringColumn<Scalar>)
      : settings_(&settings), modes_(settings.prior), hands_(settings.wheel) {}
  explicit ClosedLoopIdentifier(const ClosedLoopSettings<Scalar>&& passing) = delete;

  /// Back to the prior, everything forgotten but where the arm rests; the driver's torque is not known. In place: a
  /// whole one beside this would be the deepest stack.
  [[gnu::cold, gnu::noinline]] void restart() {
    const ClosedLoopSettings<Scalar>& settings = *settings_;
    const RestAngle<Scalar> rest = rest_;
    std::construct_at(this, settings);
    rest_ = rest;
  }

  /// After a gap too long to bridge: the filters start again on the next samples, what was learned stays.
  void resettle() {
    settling_ = kSettle;
    rows_ = 0;
    noise_.break_here();
    hands_.break_here();
  }

  /// Beside another identifier, which knows all of the torque: everything is forgotten. Until it learns the arm is what
  /// assume() says.
  void begin(const Prior<Scalar>& prior) {
    restart();
    torque_known_ = true;
    modes_.assume(prior, kWalksByTorque<Scalar>);
  }
  /// The measured angle at which the arm pulls with no torque, rad, where all torque is known; 0 before.
  [[nodiscard]] Scalar rest_rad() const { return rest_.angle_rad(); }
  /// It outlasts begin(), since it is the sensor's.
  void forget_rest() { rest_ = RestAngle<Scalar>(); }
  void assume(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation) { modes_.restart(value, deviation); }
  /// Whether the arm is learned, and not only the noise.
  [[nodiscard]] bool learns() const { return learned() > 0; }
  /// Whether J, B or C is valid.
  [[nodiscard]] bool knows() const {
    for (const Belief belief : belief_) {
      if (belief == Belief::kValid) return true;
    }
    return false;
  }

  /// Goes on from what was known at power-off, trusted a tenth as much: another driver may sit there now.
  void restore(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation) {
    restart();
    modes_.restart(value, deviation * Scalar(10));
    for (Belief& belief : belief_) belief = Belief::kHolding;
    for (bool& known : known_once_) known = true;
  }

  /// Takes in one sample: T and the probe in Nm, the angle in rad. learn = false lets it through the filters without
  /// believing it. What is no number or beyond Identifier::kLargest is a gap.
  /// `steady` is needed where all torque is known, after begin().
  void update(Scalar torque_nm, Scalar angle_rad, Scalar probe_nm, bool learn = true,
              const SteadyAnswer<Scalar>& steady = {});

  /// Those of the arm, or of the wheel where nobody holds it, by how likely that is.
  [[nodiscard, gnu::noinline]] Vector3<Scalar> value() const {
    Vector3<Scalar> all = modes_.value();
    for (int i = 0; i < 3; ++i) {
      all(i) += (hands_.wheel(i) - all(i)) * hands_.released();
      if (all(i) < modes_.prior().lowest(i)) all(i) = modes_.prior().lowest(i);
    }
    return all;
  }
  [[nodiscard]] Scalar value(int parameter) const { return value()(parameter); }
  /// One standard deviation of each parameter; never more than the prior's.
  [[nodiscard, gnu::noinline]] Vector3<Scalar> standard_deviation() const;
  [[nodiscard]] Belief belief(int parameter) const { return belief_[parameter]; }
  /// Standard deviation of the whitened residual, Nm.
  [[nodiscard]] Scalar noise_nm() const { return square_root(noise_variance_); }
  /// Root mean square of what no sensor explains, behind the common filter, Nm: mostly the driver's own torque.
  [[nodiscard]] Scalar unmeasured_nm() const { return square_root(noise_.power()); }
  /// Root mean square of the probe, Nm, with which `asked` deviations of J, B and C would be reached from nothing
  /// within 30 s, by what its motion has shown of late; 0 where there was too little of a probe to say, or where the
  /// torque is the source in its place.
  [[nodiscard, gnu::cold, gnu::noinline]] Scalar probe_needed_nm(const Vector3<Scalar>& asked) const;
  /// Whether the probe is the instrument's source; otherwise the torque is.
  [[nodiscard]] bool by_probe() const { return by_probe_; }
  [[nodiscard]] const Prior<Scalar>& prior() const { return modes_.prior(); }
  [[nodiscard]] const ArmModes<Scalar>& modes() const { return modes_; }
  [[nodiscard]] const Hands<Scalar>& hands() const { return hands_; }
  /// Whether the last update() took in a look that shows something, late enough to be judged by.
  [[nodiscard]] bool looked() const { return looked_; }
  /// What that look says against the steady identifier's arm, as the logarithm of a ratio of likelihoods: that of the
  /// residual which this one predicted over that of the other's, by the instrument. Both with the variance that two
  /// arms leave which differ by no more than kAlike: a change that small is none.
  [[nodiscard]] Scalar evidence() const { return evidence_; }
  /// That nobody holds the wheel: 0 to 1, and 0 before anything may be believed. Above a torsion bar only.
  [[nodiscard]] Scalar released() const { return judges() ? hands_.released() : Scalar(0); }
  [[nodiscard]] bool sound() const { return modes_.sound() && noise_variance_ > Scalar(0); }

 private:
  static constexpr double kPeriod_s = 0.01;
  static constexpr double kRate_hz = 100;
  /// The common filter: J is seen up to 6 Hz, where the angle's noise begins to be dearer than what it shows.
  static constexpr double kCorner = 631.65;            ///< (2 pi 4 Hz)^2, 1/s2
  static constexpr double kDamping_per_s = 35.19;      ///< 1.4 times 2 pi 4 Hz, 1/s
  static constexpr std::int8_t kTicks = 4;             ///< from one look to the next
  static constexpr std::int8_t kSettle = 50;           ///< ticks until filters and functions have come to rest
  static constexpr std::int16_t kSolveEvery = 10;      ///< looks between two solutions of the regressions
  static constexpr std::int16_t kNoiseFrom = 12;       ///< looks before what is unexplained teaches the noise
  static constexpr std::int16_t kInstrumentFrom = 31;  ///< looks before the source's motion is learned
  /// Looks before the arm is learned: 2.5 s, the driver's own torque must have a colour. Where that torque is known the
  /// noise needs its variance only: to a quarter, sqrt(2/30), within 1.2 s.
  static constexpr std::int16_t kLearnFrom = 62;
  static constexpr std::int16_t kLearnFromKnown = 30;
  static constexpr std::int16_t kJudgeAfter = 25;          ///< looks of learning before anything is valid
  static constexpr std::int16_t kInstrumentMemory = 1000;  ///< looks: 40 s
  static constexpr std::int16_t kNoiseMemory = 750;        ///< looks: 30 s
  static constexpr std::int16_t kRoadMemory = 150;         ///< looks: 6 s
  static constexpr std::int16_t kVarianceMemory = 500;     ///< looks: 20 s
  static constexpr double kWild = 9;
  static constexpr double kAlike = 0.05;  ///< of a parameter: half of what the steady identifier calls usable
  static constexpr double kRecent = 0.1;  ///< a look: the last 0.4 s
  /// Share of the torque that is the driver's own (docs/adr/0006): from half of it down the torque is the source in the
  /// place of a probe, and stays it below the whole.
  static constexpr double kDriversShare = 0.15;
  static constexpr double kRateMemory = 0.005;  ///< a look: 8 s
  static constexpr double kEvens = 0.5;         ///< probability
  static constexpr double kGone = 0.98;
  static constexpr std::int8_t kGoneFor = 12;     ///< looks, half a second
  static constexpr double kFirstNoise = 1e-3;     ///< Nm^2, before anything is known
  static constexpr double kLeastNoise = 1e-8;     ///< Nm^2: a tenth of the port's resolution
  static constexpr double kProbeAsked = 1e-4;     ///< Nm^2, mean square over 5 s: 10 mNm are no probe
  static constexpr double kProbeTells = 2.5e-3;   ///< Nm^2: of 50 mNm rms, what the probe shows is more than chance
  static constexpr std::int16_t kToldFrom = 100;  ///< looks, the memory of what the instrument shows
  /// Looks within which an asked deviation is to be reached, 30 s, over how many times more the variance of J and C is
  /// because the others have to be found too: 2.9 in closed form for the task's own probe and an arm of 20 Nm/rad
  /// (docs/column.md).
  static constexpr double kAskedWithin = 750 / 2.5;
  static constexpr double kShownWithin = 250;  ///< looks: what is shown within 10 s is excited

  static constexpr int kRows = AutoregressiveNoise<Scalar>::kOrder + 1;
  /// What is whitened together, one row a look: T; th'', th', th measured; the same of each of the source's functions.
  /// Where all torque is known the modelled motion stands in the first function's place.
  static constexpr int kTorque = 0, kMeasured = 1, kFunctions = 4;
  static constexpr int kColumns = kFunctions + 3 * Instrument<Scalar>::kFunctions;
  using Row = Eigen::Matrix<Scalar, kColumns, 1>;

  static constexpr SecondOrderCoefficients<Scalar> kCommon{
      Scalar(kPeriod_s * kCorner / (1 + kPeriod_s * kDamping_per_s)), Scalar(1 / (1 + kPeriod_s * kDamping_per_s))};

  [[gnu::noinline]] void look(const Vector3<Scalar>& steady);
  [[gnu::noinline]] void look_at_rest(const Vector3<Scalar>& steady);
  [[gnu::noinline]] void solve(Scalar torque_noise);
  void compare(const Vector3<Scalar>& steady, const Vector3<Scalar>& z, Scalar residual, Scalar noise);
  [[gnu::noinline]] Row whitened() const;
  [[nodiscard]] DirectLook<Scalar> direct(int looks_ago) const {
    const Row& row = row_[looks_ago];
    return {row(kTorque), borne_[looks_ago], row.template segment<3>(kMeasured)};
  }
  [[nodiscard]] Vector3<Scalar> by_source(const Row& white, Scalar whitened_angle);
  [[nodiscard]] Vector3<Scalar> by_free_wheel(const Row& white);
  /// Whether somebody holds the wheel, more likely than not: only then noise and instrument are an arm's.
  [[nodiscard]] bool held() const { return hands_.released() < Scalar(kEvens); }
  void choose_source();
  [[nodiscard, gnu::noinline]] Scalar without_friction(Scalar torque_nm, Scalar angle_rad);
  /// The common filter behind a mean of three samples, (1 2 1) / 4: without its zeros at half the rate, the sensors'
  /// noise above 12.5 Hz would come back below it, since one sample in four is looked at.
  struct SmoothedFilter {
    Moved<Scalar> move(Scalar in) {
      const Scalar smooth = (in + last[0] + last[0] + last[1]) * Scalar(0.25);
      last[1] = last[0];
      last[0] = in;
      return filter.move(smooth, kCommon, Scalar(kPeriod_s));
    }
    void settle_at(Scalar position) {
      last[0] = last[1] = position;
      filter.settle_at(position);
    }
    SecondOrderFilter<Scalar> filter;
    Scalar last[2] = {};
  };
  [[gnu::noinline]] void judge();
  /// Looks that the arm was learned from; below 1 none.
  [[nodiscard]] std::int32_t learned() const { return looks_ - (torque_known_ ? kLearnFromKnown : kLearnFrom); }
  [[nodiscard]] bool judges() const { return learned() > kJudgeAfter; }
  /// Where nothing is unmeasured, what is left is noise, or no arm of this kind explains it.
  [[nodiscard]] bool fits() const {
    return !torque_known_ || !(recent_power_ > Scalar(Identifier<Scalar>::kDoubtful) * noise_variance_);
  }
  /// Memory of a mean that must forget what the prior left unexplained: half of what there was, at most so many looks.
  [[nodiscard]] Scalar half_of_the_looks(std::int32_t most) const {
    const std::int32_t half = kNoiseFrom + looks_ / 2;
    return Scalar(half < most ? half : most);
  }
  /// Whether there is a probe and the driver's torque is not known, so that the probe may be the source.
  [[nodiscard]] bool probed() const { return probe_power_ > Scalar(kProbeAsked) && !torque_known_; }
  /// Of `power` the share that is `part`; all of it where there is no power.
  [[nodiscard]] static Scalar share_of(Scalar part, Scalar power) {
    return power > Scalar(kLeastNoise) ? part / power : Scalar(1);
  }
  /// Of what is new in the torque beside the probe's part, the share that no arm explains: the driver's own.
  [[nodiscard]] Scalar drivers_share() const { return judges() ? share_of(noise_variance_, recent_power_) : Scalar(1); }
  /// The most that the estimate can be off by for want of a source that is independent of the driver, squared.
  [[nodiscard]] Scalar unexplained_share() const {
    return probed() || torque_known_ || !learns() ? Scalar(0) : share_of(noise_.power(), torque_power_);
  }

  const ClosedLoopSettings<Scalar>* settings_;
  SmoothedFilter torque_filter_, angle_filter_, source_filter_;
  SmoothedFilter borne_filter_;  ///< what the wheel's friction bears
  Differentiator<Scalar> measured_;
  Instrument<Scalar> instrument_;
  ModelledMotion<Scalar> modelled_;  ///< where all torque is known, in place of the instrument
  AutoregressiveNoise<Scalar> noise_;
  ArmModes<Scalar> modes_;
  Hands<Scalar> hands_;
  RestAngle<Scalar> rest_;
  Row row_[kRows] = {};                                           ///< the newest first
  Scalar torque_late_[Differentiator<Scalar>::kDelay] = {};       ///< filtered where all torque is known
  Scalar borne_[2] = {};                                          ///< at the last looks, the newest first
  Scalar angle_late_[2] = {};                                     ///< those before the angle filter's last two
  Vector3<Scalar> shown_ = Vector3<Scalar>::Constant(Scalar(0));  ///< mean square of the whitened instrument
  Scalar evidence_{0};                                            ///< of the last look
  /// Nm^2, whitened. Where all torque is known that of the residual, which the last looks speak of; from the bar that
  /// of the torque, by the probe without what that has caused.
  Scalar recent_power_{0};
  Scalar noise_variance_{Scalar(kFirstNoise)};
  Scalar torque_power_{0};
  Scalar probe_power_{0};
  Scalar rate_power_{0};  ///< rad2/s2, of the measured motion
  std::int16_t looks_ = 0;
  std::int16_t sourced_ = 0;  ///< looks since the source is what it is
  std::int8_t settling_ = kSettle;
  std::int8_t until_look_ = kTicks;
  std::int8_t until_solved_ = kSolveEvery;
  std::int8_t rows_ = 0;  ///< of those in row_ that follow each other without a gap
  std::int8_t doubtful_ = 0;
  std::int8_t gone_ = 0;  ///< looks, kGoneFor at most
  bool solving_ = false;
  bool resting_ = false;  ///< the last look is to be taken in by rest_
  bool by_probe_ = false;
  bool torque_known_ = false;
  bool looked_ = false;
  bool known_once_[3] = {};  ///< valid at some look since the start, or restored
  Belief belief_[3] = {Belief::kStarting, Belief::kStarting, Belief::kStarting};
};

}  // namespace steerid

#include "identifier/closed_loop_update.hpp"
