// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The steps of the identifier declared in closed_loop_identifier.hpp, in the order in which a sample meets them.
#pragma once

#include "identifier/closed_loop_identifier.hpp"

namespace steerid {

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::update(Scalar torque_nm, Scalar angle_rad, Scalar probe_nm, bool learn,
                                          const SteadyAnswer<Scalar>& steady) {
  looked_ = false;
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
    borne_filter_.settle_at(Scalar(0));
    measured_.fill(angle_rad);
    for (Scalar& late : torque_late_) late = torque_nm;
    for (Scalar& late : angle_late_) late = angle_rad;
  }
  Scalar late = torque_late_[1];
  if (!torque_known_) {
    hands_.push(torque_nm, angle_rad);
    if (settings_->wheel.friction_nm > Scalar(0)) late = without_friction(late, angle_rad);
  }
  const Scalar torque = torque_filter_.move(torque_known_ ? torque_nm : late).to;
  Moved<Scalar> angle = angle_filter_.move(angle_rad);
  angle.to -= rest_.angle_rad();  // behind the filter: nothing rings
  measured_.push(angle);
  torque_late_[1] = torque_late_[0];
  if (!torque_known_) {
    torque_late_[0] = torque_nm;
    late = torque;
    instrument_.push(source_filter_.move(source).to);
  } else {
    torque_late_[0] = torque;
    if (settling_ > 0) {
      modelled_.start(modes_.value(), angle, measured_, Scalar(kPeriod_s));
    } else {
      modelled_.push(torque, Scalar(kPeriod_s));
    }
  }
  if (!learn) {
    doubtful_ = kRows;
    hands_.break_here();
  }
  if (settling_ > 0) {
    --settling_;
    return;
  }
  // The ticks after a look have nothing else to do.
  if (solving_) {
    solve(steady.torque_noise);
  } else if (resting_) {
    look_at_rest(steady.arm);
  }
  if (--until_look_ > 0) return;
  until_look_ = kTicks;
  choose_source();
  for (int i = kRows - 1; i > 0; --i) row_[i] = row_[i - 1];
  Row& row = row_[0];
  row(kTorque) = late;
  row.template segment<3>(kMeasured) = measured_.derivatives(Scalar(kRate_hz));
  if (torque_known_) {
    row.template segment<3>(kFunctions) = modelled_.derivatives(Scalar(kRate_hz));
  } else {
    for (int i = 0; i < Instrument<Scalar>::kFunctions; ++i) {
      row.template segment<3>(kFunctions + 3 * i) = instrument_.derivatives(i, Scalar(kRate_hz));
    }
  }
  borne_[1] = borne_[0];
  borne_[0] = borne_filter_.filter.position();
  if (rows_ < kRows) ++rows_;
  if (doubtful_ > 0) {
    --doubtful_;
    noise_.break_here();
    return;
  }
  if (rows_ == kRows) look(steady.arm);
}

/// `torque_nm` of two ticks before: as late as the motion will be.
template <class Scalar>
Scalar ClosedLoopIdentifier<Scalar>::without_friction(Scalar torque_nm, Scalar angle_rad) {
  const Scalar friction = settings_->wheel.friction_nm;
  const Scalar share = WheelFriction<Scalar>::share(angle_rad - angle_late_[1]);
  angle_late_[1] = angle_late_[0];
  angle_late_[0] = angle_filter_.last[1];
  borne_filter_.move(WheelFriction<Scalar>::borne(torque_nm - hands_.bar_off_nm(), friction, share));
  return torque_nm - friction * share;
}

template <class Scalar>
typename ClosedLoopIdentifier<Scalar>::Row ClosedLoopIdentifier<Scalar>::whitened() const {
  Row white = row_[0];
  for (int i = 1; i < kRows; ++i) white -= row_[i] * noise_.coefficient(i - 1);
  return white;
}

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::look(const Vector3<Scalar>& steady) {
  if (looks_ < INT16_MAX) ++looks_;
  const Scalar rate = row_[0](kMeasured + kDamping);
  rate_power_ += (rate * rate - rate_power_) * Scalar(kRateMemory);
  const Row white = whitened();
  const Vector3<Scalar> phi = white.template segment<3>(kMeasured);
  const Scalar torque = white(kTorque);
  const Vector3<Scalar> z = torque_known_ ? by_free_wheel(white) : by_source(white, phi(kStiffness));
  const Scalar unexplained = row_[0](kTorque) - row_[0].template segment<3>(kMeasured).dot(modes_.value());
  if (looks_ > kNoiseFrom && held()) noise_.push(unexplained, half_of_the_looks(kNoiseMemory));
  torque_power_ += (row_[0](kTorque) * row_[0](kTorque) - torque_power_) / half_of_the_looks(kNoiseMemory);
  if (!torque_known_) {  // the probe's own part is left to the probe
    const Scalar by_road = by_probe_ ? torque - z.dot(modes_.value()) : torque;
    recent_power_ += (by_road * by_road - recent_power_) / half_of_the_looks(kRoadMemory);
  }

  Scalar square = torque - phi.dot(modes_.value());
  square = square * square;
  resting_ = torque_known_ && (!learns() || (square < Scalar(kWild) * noise_variance_ && fits()));
  if (learns()) {
    // An unmeasured torque that comes, or an arm that multiplies the angle's noise: more noise is not another arm.
    const bool more = torque_known_ && recent_power_ > noise_variance_;
    const Scalar noise = more ? recent_power_ : noise_variance_;
    if (torque_known_) compare(steady, z, torque - phi.dot(modes_.value()), noise);
    looked_ = torque_known_ && judges() && modelled_.shows_something();
    square = modes_.look(torque, phi, z, noise, modelled_.dark());
    if (torque_known_) {
      recent_power_ += (square - recent_power_) * Scalar(kRecent);
      judge();
    } else {
      hands_.look(direct(0), direct(1), {modes_.likelihood(), square, noise_variance_});
    }
    // Hands that come back may be anyone's.
    if (hands_.released() > Scalar(kGone)) {
      if (gone_ < kGoneFor) ++gone_;
    } else if (held()) {
      if (gone_ == kGoneFor) modes_.restart(settings_->prior.value, settings_->prior.spread);
      gone_ = 0;
    }
    for (int i = 0; i < 3; ++i) shown_(i) += (z(i) * z(i) - shown_(i)) * Scalar(0.01);
    if (judges() && square > Scalar(kWild) * noise_variance_) square = Scalar(kWild) * noise_variance_;
  }
  // What the prior left unexplained says little of the noise.
  const std::int32_t kept = learns() ? learned() + kNoiseFrom : kNoiseFrom;
  const Scalar before = noise_variance_;
  // The noise is what a driver leaves, and a wheel that nobody holds says nothing of it.
  noise_variance_ += (Scalar(1) - hands_.released()) * (square - noise_variance_) /
                     Scalar(kept < kVarianceMemory ? kept : std::int32_t{kVarianceMemory});
  if (noise_variance_ < Scalar(kLeastNoise)) noise_variance_ = Scalar(kLeastNoise);
  // As long as the variance is the mean of all that there was, it is that of the first looks as well: what the prior
  // left unexplained was taken for noise then. Later another variance means that the driver does something else.
  if (!torque_known_ && learns() && kept < kVarianceMemory) modes_.recount(noise_variance_ / before);
  if (--until_solved_ == 0) solving_ = true;
}

/// By the steady identifier's J and B: what these are off by has no mean.
template <class Scalar>
void ClosedLoopIdentifier<Scalar>::look_at_rest(const Vector3<Scalar>& steady) {
  resting_ = false;
  const Row& row = row_[0];
  const Scalar spring = row(kTorque) - row(kMeasured) * steady(kInertia) - row(kMeasured + kDamping) * steady(kDamping);
  rest_.look(row(kMeasured + kStiffness), spring, steady(kStiffness), noise_variance_);
}

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::solve(Scalar torque_noise) {
  solving_ = false;
  until_solved_ = kSolveEvery;
  if (looks_ > kNoiseFrom) noise_.solve();
  if (torque_known_) {
    modelled_.compare(noise_information(modes_.value(), Scalar(kCorner), Scalar(kDamping_per_s), torque_noise,
                                        Scalar(kPeriod_s), WhiteningShape<Scalar>()));
  } else {
    instrument_.solve();
    judge();
  }
}

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::compare(const Vector3<Scalar>& steady, const Vector3<Scalar>& z, Scalar residual,
                                           Scalar noise) {
  Scalar variance = noise;
  for (int i = 0; i < 3; ++i) {
    const Scalar alike = z(i) * steady(i) * Scalar(kAlike);
    variance += alike * alike;
  }
  const Scalar more = z.dot(modes_.value() - steady);
  evidence_ = more * (more + residual + residual) / (variance + variance);
}

/// What of the motion the source has caused. By the coefficients of now in all of its history: a change of them is no
/// motion.
template <class Scalar>
Vector3<Scalar> ClosedLoopIdentifier<Scalar>::by_source(const Row& white, Scalar whitened_angle) {
  Vector3<Scalar> z = Vector3<Scalar>::Constant(Scalar(0));
  typename Instrument<Scalar>::Functions functions;
  for (int i = 0; i < Instrument<Scalar>::kFunctions; ++i) {
    const Vector3<Scalar> function = white.template segment<3>(kFunctions + 3 * i);
    z += function * instrument_.coefficient()(i);
    functions(i) = function(kStiffness);
  }
  // Before the noise has a colour the driver's own torque would be all that this sees.
  if (looks_ > kInstrumentFrom && held()) {
    if (sourced_ < 2 * kInstrumentMemory) ++sourced_;
    instrument_.learn(whitened_angle, functions, Scalar(std::int32_t{kNoiseFrom + sourced_ / 2}));
  }
  return z;
}

/// What of the modelled motion is more than the torque's noise makes of it.
template <class Scalar>
Vector3<Scalar> ClosedLoopIdentifier<Scalar>::by_free_wheel(const Row& white) {
  modelled_.look(row_[0].template segment<3>(kFunctions), modes_.value(), Scalar(kPeriod_s));
  Vector3<Scalar> z = white.template segment<3>(kFunctions);
  for (int i = 0; i < 3; ++i) {
    if (modelled_.dark()[i]) z(i) = Scalar(0);
  }
  return z;
}

/// The probe, as long as there is one and the road does not move the wheel; what was learned of the other source's
/// motion does not serve.
template <class Scalar>
void ClosedLoopIdentifier<Scalar>::choose_source() {
  const Scalar most = by_probe_ ? Scalar(kDriversShare / 2) : Scalar(kDriversShare);
  const bool by_probe = probed() && !(drivers_share() < most);
  if (by_probe == by_probe_) return;
  by_probe_ = by_probe;
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
    const Scalar most = modes_.prior().spread(i);
    const Scalar arm = modes_.value()(i);
    const Scalar off = hands_.wheel(i) - arm;
    Scalar of_arm = modes_.variance()(i) + share * arm * arm;
    if (i == kDamping) of_arm += WheelFriction<Scalar>::damping_variance(settings_->wheel.friction_nm, rate_power_);
    deviation(i) =
        square_root(of_arm + gone * (hands_.wheel_variance(i) - of_arm) + gone * (Scalar(1) - gone) * off * off);
    if (deviation(i) > most) deviation(i) = most;
  }
  return deviation;
}

/// Information adds up: n looks whose instrument has the mean square m, in noise of variance s2, make a deviation of
/// sqrt(s2 / (n m)), and m goes with the probe's power.
template <class Scalar>
Scalar ClosedLoopIdentifier<Scalar>::probe_needed_nm(const Vector3<Scalar>& asked) const {
  Scalar least = shown_(0) * asked(0) * asked(0);
  for (int i = 1; i < 3; ++i) {
    const Scalar shown = shown_(i) * asked(i) * asked(i);
    if (shown < least) least = shown;
  }
  if (!by_probe_ || sourced_ < kToldFrom || !(probe_power_ > Scalar(kProbeTells)) || !(least > Scalar(0)))
    return Scalar(0);
  return square_root(probe_power_ * noise_variance_ / (least * Scalar(kAskedWithin)));
}

template <class Scalar>
void ClosedLoopIdentifier<Scalar>::judge() {
  if (!judges()) return;
  const Vector3<Scalar> now = value();
  const Vector3<Scalar> deviation = standard_deviation();
  // No wheel is without inertia. Where the data fix it at its limit the model does not hold: a torque the wrong way
  // round, another channel than was said. Damping and stiffness mean nothing then either.
  const bool absurd = now(kInertia) - modes_.prior().lowest(kInertia) < Scalar(2) * deviation(kInertia);
  for (int i = 0; i < 3; ++i) {
    Scalar usable = (torque_known_ ? kSteeringWheel<Scalar>.usable : settings_->usable(i)) * now(i);
    if (i == kStiffness && by_probe_ && usable < settings_->usable_stiffness) usable = settings_->usable_stiffness;
    const bool excited = shown_(i) * usable * usable * Scalar(kShownWithin) > noise_variance_;
    // A deviation that the prior holds says that nothing was learned, however little it is of a large value.
    if (fits() && !absurd && deviation(i) <= usable && deviation(i) < modes_.prior().spread(i)) {
      belief_[i] = Belief::kValid;
      known_once_[i] = true;
    } else {
      belief_[i] = excited ? Belief::kConverging : known_once_[i] ? Belief::kHolding : Belief::kNotExcited;
    }
  }
}

}  // namespace steerid
