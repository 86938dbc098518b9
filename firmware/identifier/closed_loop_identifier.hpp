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
// (arm_modes.hpp). docs/adr/0046 has the comparison with a prediction error method.
//
//   100 Hz   common filter of 4 Hz on T, angle and source; derivatives; the source's Laguerre functions
//    25 Hz   whiten; instrument's regression; three filters of J, B, C and their mixture; variance of the noise
//   2.5 Hz   coefficients of the whitening filter and of the instrument; what may be believed
//
// Where no probe has been asked for lately, T itself is the source. It is independent of v only where there is hardly
// any v: hands that rest. So the deviation then holds, beside chance, the share of the torque that stays unexplained,
// which is the most that a regression on it can be off by.
//
// Wheels with another machine behind it, samples of another rate: not for this identifier; its filters are a steering
// wheel's at 100 Hz.
//
// No heap, no exception, no libm, no clock.
#pragma once

#include <cstdint>

#include "identifier/arm_modes.hpp"
#include "identifier/autoregressive_noise.hpp"
#include "identifier/differentiator.hpp"
#include "identifier/hands.hpp"
#include "identifier/identifier.hpp"
#include "identifier/instrument.hpp"
#include "identifier/parameters.hpp"
#include "identifier/second_order_filter.hpp"

namespace steerid {

template <class Scalar>
struct ClosedLoopSettings {
  Prior<Scalar> prior{.value = {Scalar(0.1), Scalar(1.5), Scalar(20)}, .spread = {Scalar(0.04), Scalar(1), Scalar(20)}};
  BareWheel<Scalar> wheel{};
  /// Relative standard deviation at which J, B and C count as learned.
  Triple<Scalar> usable{Scalar(0.15), Scalar(0.15), Scalar(0.2)};
  /// Nm/rad: the same for C, whatever its value. A wheel without hands has no C, and so no relative deviation; that it
  /// has none is decided between 0 and the 3 Nm/rad that no arm is below (app/driver_state.hpp), by two deviations.
  Scalar usable_stiffness{1};
};

template <class Scalar>
inline constexpr ClosedLoopSettings<Scalar> kSteeringColumn{};

template <class Scalar>
class ClosedLoopIdentifier {
 public:
  /// `settings` are not copied, so that they can lie in flash: they have to live as long as the identifier does.
  explicit ClosedLoopIdentifier(const ClosedLoopSettings<Scalar>& settings = kSteeringColumn<Scalar>)
      : settings_(&settings), modes_(settings.prior), hands_(settings.wheel) {}
  explicit ClosedLoopIdentifier(const ClosedLoopSettings<Scalar>&& passing) = delete;

  /// Back to the prior, everything forgotten. Part by part: a whole one beside this would be the deepest stack.
  void restart() {
    resettle();
    instrument_ = Instrument<Scalar>();
    noise_ = AutoregressiveNoise<Scalar>();
    modes_.restart(settings_->prior.value, settings_->prior.spread);
    hands_ = Hands<Scalar>(settings_->wheel);
    shown_.setConstant(Scalar(0));
    noise_variance_ = Scalar(kFirstNoise);
    torque_power_ = probe_power_ = Scalar(0);
    looks_ = sourced_ = 0;
    until_look_ = kTicks;
    until_solved_ = kSolveEvery;
    doubtful_ = gone_ = 0;
    solving_ = by_probe_ = false;
    for (bool& known : known_once_) known = false;
    for (Belief& belief : belief_) belief = Belief::kStarting;
  }

  /// After a gap too long to bridge: the filters start again on the next samples, what was learned stays.
  void resettle() {
    settling_ = kSettle;
    rows_ = 0;
    noise_.break_here();
    hands_.break_here();
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
  void update(Scalar torque_nm, Scalar angle_rad, Scalar probe_nm, bool learn = true);

  /// Those of the arm, or of the wheel where nobody holds it, by how likely that is.
  [[nodiscard]] Vector3<Scalar> value() const {
    Vector3<Scalar> all = modes_.value() + (hands_.wheel().value - modes_.value()) * hands_.released();
    for (int i = 0; i < 3; ++i) {
      if (all(i) < settings_->prior.lowest(i)) all(i) = settings_->prior.lowest(i);
    }
    return all;
  }
  [[nodiscard]] Scalar value(int parameter) const { return value()(parameter); }
  /// One standard deviation of each parameter; never more than the prior's.
  [[nodiscard]] Vector3<Scalar> standard_deviation() const;
  [[nodiscard]] Belief belief(int parameter) const { return belief_[parameter]; }
  /// Standard deviation of the whitened residual, Nm.
  [[nodiscard]] Scalar noise_nm() const { return square_root(noise_variance_); }
  /// Root mean square of what no sensor explains, behind the common filter, Nm: mostly the driver's own torque.
  [[nodiscard]] Scalar unmeasured_nm() const { return square_root(noise_.power()); }
  /// Whether the probe is the instrument's source; otherwise the torque is.
  [[nodiscard]] bool by_probe() const { return by_probe_; }
  [[nodiscard]] const Prior<Scalar>& prior() const { return settings_->prior; }
  [[nodiscard]] const ArmModes<Scalar>& modes() const { return modes_; }
  [[nodiscard]] const Hands<Scalar>& hands() const { return hands_; }
  /// That nobody holds the wheel: 0 to 1, and 0 before anything may be believed. Above a torsion bar only.
  [[nodiscard]] Scalar released() const { return looks_ > kJudgeFrom ? hands_.released() : Scalar(0); }
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
  static constexpr std::int16_t kLearnFrom = 62;  ///< looks before the arm is learned: 2.5 s, the noise must be known
  static constexpr std::int16_t kJudgeFrom = 87;  ///< looks before anything is valid
  static constexpr std::int16_t kInstrumentMemory = 1000;  ///< looks: 40 s
  static constexpr std::int16_t kNoiseMemory = 750;        ///< looks: 30 s
  static constexpr std::int16_t kVarianceMemory = 500;     ///< looks: 20 s
  static constexpr double kWild = 9;
  static constexpr double kEvens = 0.5;  ///< probability
  static constexpr double kGone = 0.98;
  static constexpr std::int8_t kGoneFor = 12;  ///< looks, half a second
  static constexpr double kFirstNoise = 1e-3;  ///< Nm^2, before anything is known
  static constexpr double kLeastNoise = 1e-8;  ///< Nm^2: a tenth of the port's resolution
  static constexpr double kProbeAsked = 1e-4;  ///< Nm^2, mean square over 5 s: 10 mNm are no probe
  static constexpr double kShownWithin = 250;  ///< looks: what is shown within 10 s is excited

  static constexpr int kRows = AutoregressiveNoise<Scalar>::kOrder + 1;
  /// What is whitened together, one row a look: T; th'', th', th measured; the same of each of the source's functions.
  static constexpr int kTorque = 0, kMeasured = 1, kFunctions = 4;
  static constexpr int kColumns = kFunctions + 3 * Instrument<Scalar>::kFunctions;
  using Row = Eigen::Matrix<Scalar, kColumns, 1>;

  static constexpr SecondOrderCoefficients<Scalar> kCommon{
      Scalar(kPeriod_s * kCorner / (1 + kPeriod_s * kDamping_per_s)), Scalar(1 / (1 + kPeriod_s * kDamping_per_s))};

  [[gnu::noinline]] void look();
  [[gnu::noinline]] void solve();
  [[gnu::noinline]] Row whitened() const;
  [[nodiscard]] DirectLook<Scalar> direct(int looks_ago) const {
    const Row& row = row_[looks_ago];
    return {row(kTorque), row.template segment<3>(kMeasured)};
  }
  void choose_source();
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
  /// Memory of a mean that must forget what the prior left unexplained: half of what there was, at most so many looks.
  [[nodiscard]] Scalar half_of_the_looks(std::int32_t most) const {
    const std::int32_t half = kNoiseFrom + looks_ / 2;
    return Scalar(half < most ? half : most);
  }
  /// The most that the estimate can be off by for want of a source that is independent of the driver, squared.
  [[nodiscard]] Scalar unexplained_share() const {
    if (by_probe_ || looks_ <= kLearnFrom) return Scalar(0);  // before that nothing was learned from any source
    return torque_power_ > Scalar(kLeastNoise) ? noise_.power() / torque_power_ : Scalar(1);
  }

  const ClosedLoopSettings<Scalar>* settings_;
  SmoothedFilter torque_filter_, angle_filter_, source_filter_;
  Differentiator<Scalar> measured_;
  Instrument<Scalar> instrument_;
  AutoregressiveNoise<Scalar> noise_;
  ArmModes<Scalar> modes_;
  Hands<Scalar> hands_;
  Row row_[kRows] = {};  ///< the newest first
  Scalar torque_late_[Differentiator<Scalar>::kDelay] = {};
  Vector3<Scalar> shown_ = Vector3<Scalar>::Constant(Scalar(0));  ///< mean square of the whitened instrument
  Scalar noise_variance_{Scalar(kFirstNoise)};
  Scalar torque_power_{0};
  Scalar probe_power_{0};
  std::int16_t looks_ = 0;
  std::int16_t sourced_ = 0;  ///< looks since the source is what it is
  std::int8_t settling_ = kSettle;
  std::int8_t until_look_ = kTicks;
  std::int8_t until_solved_ = kSolveEvery;
  std::int8_t rows_ = 0;  ///< of those in row_ that follow each other without a gap
  std::int8_t doubtful_ = 0;
  std::int8_t gone_ = 0;  ///< looks, kGoneFor at most
  bool solving_ = false;
  bool by_probe_ = false;
  bool known_once_[3] = {};  ///< valid at some look since the start, or restored
  Belief belief_[3] = {Belief::kStarting, Belief::kStarting, Belief::kStarting};
};

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::update(Scalar torque_nm, Scalar angle_rad, Scalar probe_nm, bool learn) {
  const auto plausible = [](Scalar x) {
    return x <= Scalar(Identifier<Scalar>::kLargest) && x >= Scalar(-Identifier<Scalar>::kLargest);
  };
  if (!plausible(torque_nm) || !plausible(angle_rad) || !plausible(probe_nm)) {
    resettle();
    return;
  }
  probe_power_ += (probe_nm * probe_nm - probe_power_) * Scalar(0.002);
  const Scalar source = by_probe_ ? probe_nm : torque_nm;
  if (settling_ == kSettle) {
    torque_filter_.settle_at(torque_nm);
    angle_filter_.settle_at(angle_rad);
    source_filter_.settle_at(source);
    measured_.fill(angle_rad);
    for (Scalar& late : torque_late_) late = torque_nm;
  }
  hands_.push(torque_nm, angle_rad);
  const Scalar torque = torque_filter_.move(torque_nm).to;
  const Moved<Scalar> angle = angle_filter_.move(angle_rad);
  instrument_.push(source_filter_.move(source).to);
  measured_.push(angle);
  const Scalar late = torque_late_[1];
  torque_late_[1] = torque_late_[0];
  torque_late_[0] = torque;
  if (!learn) {
    doubtful_ = kRows;
    hands_.break_here();
  }
  if (settling_ > 0) {
    --settling_;
    return;
  }
  // The tick after a look has nothing else to do.
  if (solving_) solve();
  if (--until_look_ > 0) return;
  until_look_ = kTicks;
  choose_source();
  for (int i = kRows - 1; i > 0; --i) row_[i] = row_[i - 1];
  Row& row = row_[0];
  row(kTorque) = late;
  row.template segment<3>(kMeasured) = measured_.derivatives(Scalar(kRate_hz));
  for (int i = 0; i < Instrument<Scalar>::kFunctions; ++i) {
    row.template segment<3>(kFunctions + 3 * i) = instrument_.derivatives(i, Scalar(kRate_hz));
  }
  if (rows_ < kRows) ++rows_;
  if (doubtful_ > 0) {
    --doubtful_;
    noise_.break_here();
    return;
  }
  if (rows_ == kRows) look();
}

template <class Scalar>
typename ClosedLoopIdentifier<Scalar>::Row ClosedLoopIdentifier<Scalar>::whitened() const {
  Row white = row_[0];
  for (int i = 1; i < kRows; ++i) white -= row_[i] * noise_.coefficient(i - 1);
  return white;
}

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::look() {
  if (looks_ < INT16_MAX) ++looks_;
  const Row white = whitened();
  const Vector3<Scalar> phi = white.template segment<3>(kMeasured);
  const Scalar torque = white(kTorque);
  // By the coefficients of now in all of its history: a change of them is no motion.
  Vector3<Scalar> z = Vector3<Scalar>::Constant(Scalar(0));
  typename Instrument<Scalar>::Functions functions;
  for (int i = 0; i < Instrument<Scalar>::kFunctions; ++i) {
    const Vector3<Scalar> function = white.template segment<3>(kFunctions + 3 * i);
    z += function * instrument_.coefficient()(i);
    functions(i) = function(kStiffness);
  }
  // Before the noise has a colour the driver's own torque would be all that this sees.
  const bool held = hands_.released() < Scalar(kEvens);
  if (looks_ > kInstrumentFrom && held) {
    if (sourced_ < 2 * kInstrumentMemory) ++sourced_;
    instrument_.learn(phi(kStiffness), functions, Scalar(std::int32_t{kNoiseFrom + sourced_ / 2}));
  }
  const Scalar unexplained = row_[0](kTorque) - row_[0].template segment<3>(kMeasured).dot(modes_.value());
  if (looks_ > kNoiseFrom && held) noise_.push(unexplained, half_of_the_looks(kNoiseMemory));
  torque_power_ += (row_[0](kTorque) * row_[0](kTorque) - torque_power_) / half_of_the_looks(kNoiseMemory);

  Scalar square = torque - phi.dot(modes_.value());
  square = square * square;
  if (looks_ > kLearnFrom) {
    square = modes_.look(torque, phi, z, noise_variance_);
    hands_.look(direct(0), direct(1), {modes_.likelihood(), square, noise_variance_});
    // Hands that come back may be anyone's.
    if (hands_.released() > Scalar(kGone)) {
      if (gone_ < kGoneFor) ++gone_;
    } else if (hands_.released() < Scalar(kEvens)) {
      if (gone_ == kGoneFor) modes_.restart(settings_->prior.value, settings_->prior.spread);
      gone_ = 0;
    }
    for (int i = 0; i < 3; ++i) shown_(i) += (z(i) * z(i) - shown_(i)) * Scalar(0.01);
    if (looks_ > kJudgeFrom && square > Scalar(kWild) * noise_variance_) square = Scalar(kWild) * noise_variance_;
  }
  // What the prior left unexplained says little of the noise.
  const std::int32_t kept = looks_ > kLearnFrom ? looks_ - kLearnFrom + kNoiseFrom : kNoiseFrom;
  const Scalar before = noise_variance_;
  // The noise is what a driver leaves, and a wheel that nobody holds says nothing of it.
  noise_variance_ += (Scalar(1) - hands_.released()) * (square - noise_variance_) /
                     Scalar(kept < kVarianceMemory ? kept : std::int32_t{kVarianceMemory});
  if (noise_variance_ < Scalar(kLeastNoise)) noise_variance_ = Scalar(kLeastNoise);
  // As long as the variance is the mean of all that there was, it is that of the first looks as well: what the prior
  // left unexplained was taken for noise then. Later another variance means that the driver does something else.
  if (looks_ > kLearnFrom && kept < kVarianceMemory) modes_.recount(noise_variance_ / before);
  if (--until_solved_ == 0) solving_ = true;
}

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::solve() {
  solving_ = false;
  until_solved_ = kSolveEvery;
  if (looks_ > kNoiseFrom) noise_.solve();
  instrument_.solve();
  judge();
}

/// The probe, as long as there is one; what was learned of the other source's motion does not serve.
template <class Scalar>
void ClosedLoopIdentifier<Scalar>::choose_source() {
  const bool probed = probe_power_ > Scalar(kProbeAsked);
  if (probed == by_probe_) return;
  by_probe_ = probed;
  instrument_ = Instrument<Scalar>();
  sourced_ = 0;
  resettle();
}

template <class Scalar>
Vector3<Scalar> ClosedLoopIdentifier<Scalar>::standard_deviation() const {
  const Scalar share = unexplained_share();
  const Scalar gone = hands_.released();
  Vector3<Scalar> deviation;
  for (int i = 0; i < 3; ++i) {
    const Scalar most = settings_->prior.spread(i);
    const Scalar arm = modes_.value()(i);
    const Scalar off = hands_.wheel().value(i) - arm;
    const Scalar of_arm = modes_.variance()(i) + share * arm * arm;
    deviation(i) =
        square_root(of_arm + gone * (hands_.wheel().covariance(i, i) - of_arm) + gone * (Scalar(1) - gone) * off * off);
    if (deviation(i) > most) deviation(i) = most;
  }
  return deviation;
}

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::judge() {
  if (looks_ <= kJudgeFrom) return;
  const Vector3<Scalar> deviation = standard_deviation();
  // No wheel is without inertia. Where the data fix it at its limit the model does not hold: a torque the wrong way
  // round, another channel than was said. Damping and stiffness mean nothing then either.
  const bool absurd = value(kInertia) - settings_->prior.lowest(kInertia) < Scalar(2) * deviation(kInertia);
  for (int i = 0; i < 3; ++i) {
    Scalar usable = settings_->usable(i) * value(i);
    if (i == kStiffness && usable < settings_->usable_stiffness) usable = settings_->usable_stiffness;
    const bool excited = shown_(i) * usable * usable * Scalar(kShownWithin) > noise_variance_;
    // A deviation that the prior holds says that nothing was learned, however little it is of a large value.
    if (!absurd && deviation(i) <= usable && deviation(i) < settings_->prior.spread(i)) {
      belief_[i] = Belief::kValid;
      known_once_[i] = true;
    } else {
      belief_[i] = excited ? Belief::kConverging : known_once_[i] ? Belief::kHolding : Belief::kNotExcited;
    }
  }
}

}  // namespace steerid
