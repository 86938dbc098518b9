// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the identifier declared in identifier.hpp looks at twice a second: filters, the instrument's wheel, what the
// motion shows, and the state of each parameter.
#pragma once

#include "identifier/identifier.hpp"

namespace steerid {

/// A filter that changes does not commute with the derivatives behind it: until the change has rung out the two sides
/// of the equation differ by it. So it changes seldom, never during a search, whose parameters come and go, and nothing
/// is learned meanwhile.
template <class Scalar>
void Identifier<Scalar>::retune(Scalar rho_squared) {
  const bool started = common_.rate_keep > Scalar(0);
  if (started && searching_ > 0) return;
  // What is found in a fault would tune it to no wheel, and the arm that was known would leave more behind it than it
  // did. After a second a misfit may be another arm all the same.
  const bool lost = known_.asked() && !another_arm_ && refined_ < kLearnColourFrom;
  const CommonFilter<Scalar> wanted = common_filter(lost ? known_.value(settings_->prior) : p_.value(), rho_squared);
  // While another arm is suspected none would be noticed that rings later than F.
  if (!started || (!change_.suspicious() && !wanted.near(common_filter_now(), Scalar(kRetune)))) {
    common_ = wanted.at(settings_->period_s);
    ring_for(wanted.ring_out(settings_->period_s));
  }
  // What another whitening filter makes of what was learned hangs on the frequencies of the motion.
  if (searching_ > 0 || window_.samples() < WindowInformation<Scalar>::kTellsFrequency) return;
  const WhiteningShape<Scalar> before = whitening_;
  const Scalar whole = Scalar(1) - before.depth();
  const Scalar left = Scalar(1) - colour_.depth();
  if (whole < Scalar(kRetune) * left && left < Scalar(kRetune) * whole) return;
  whitening_ = WhiteningShape<Scalar>::of_depth(Scalar(1) - left);
  weigh_anew_what_was_learned_behind(before);
  if (left < whole) forget_what_is_worth_less_than_the_prior();
  window_.reset();  // its motion is the one behind the whitening filter of before
  if (known_.asked()) inverse_whitening_ = InverseWhiteningFilter<Scalar>();  // what it holds may be a fault's
  // Where the whitening filter jumps to the model comes too late by itself. One that is softer than its wheel may be
  // (free_wheel.hpp) would fall from there to a rest of its own: it comes down to what a deeper whitening filter leaves
  // meanwhile.
  model_waits_ = left > whole || p_(kStiffness) > FreeWheel<Scalar>::softest(p_.value());
  ring_for(whitening_.ring_out());
  noise_.stands_on_at_most(kNoiseKept);
  noise_.forget_scores();
}

/// What still rings from before goes on.
template <class Scalar>
void Identifier<Scalar>::ring_for(int samples) {
  if (ringing_ < samples) ringing_ = static_cast<std::int16_t>(samples);
}

/// Variances are kept relative to the residual's. Over the motion that shows a parameter that becomes as many times
/// less dense as the whitening filter leaves less now, or denser as it leaves more; what is known, in units of the
/// parameter, stays.
template <class Scalar>
void Identifier<Scalar>::weigh_anew_what_was_learned_behind(const WhiteningShape<Scalar>& before) {
  Vector3<Scalar> denser = window_.frequency_squared();
  for (Scalar& x : denser) {
    x = before.power_left(x, settings_->period_s) / whitening_.power_left(x, settings_->period_s);
  }
  covariance_.scale_each(denser);
}

/// Value and variance: what a J or B that nobody knows does to C is bounded by what they can be. C is spared: slow
/// motion, which the whitening filter takes out, has shown it, and a C that is off makes a slow residual, which would
/// deepen the whitening filter again.
template <class Scalar>
void Identifier<Scalar>::forget_what_is_worth_less_than_the_prior() {
  const Vector3<Scalar> variance = covariance_.variance() * noise_.variance();
  Vector3<Scalar> share = Vector3<Scalar>::Constant(Scalar(1));
  for (int i = 0; i < kStiffness; ++i) {
    const Scalar spread = settings_->prior.spread(i);
    if (!(variance(i) > spread * spread)) continue;
    p_.set(i, settings_->prior.value(i));
    share(i) = spread * spread / variance(i);
  }
  covariance_.scale_each(share);
}

template <class Scalar>
void Identifier<Scalar>::refresh() {
  until_refresh_ = kRefresh;
  p_.fold();
  if (refined_ > kLearnColourFrom && ringing_ == 0) {
    noise_.learn_from_scores(window_, claimed_variance(), Scalar(kLeastAngleNoise));
  }
  // What is held keeps its variance in its own units, whatever becomes of the noise.
  const Scalar variance = noise_.variance();
  if (variance < noise_at_last_refresh_) covariance_.scale_held(noise_at_last_refresh_ / variance, held_);
  noise_at_last_refresh_ = variance;
  // Before the sensors have shown their noise, or while one may be at fault: 0.03 Nm over 0.0007 rad, a usual torque
  // sensor and a usual encoder.
  Scalar rho_squared(1800);
  if (!known_.asked() && torque_noise_.known() && angle_noise_.variance() > Scalar(0)) {
    rho_squared = torque_noise_.variance() / angle_noise_.variance();
  }
  retune(rho_squared);
  model_.become(p_.value(), settings_->period_s);
  NoiseInformation<Scalar> pretended;
  if (torque_noise_.known()) {
    pretended = pretended_by_the_torque_noise();
    if (searching_ == 0 && window_.samples() >= kEnough) {
      held_ = held_by(window_.noise_share(pretended), Scalar(1.0 / kShown));
    }
  }
  judge_all(pretended);
  remember();
}

/// Per sample, once the sensor has shown its noise.
template <class Scalar>
NoiseInformation<Scalar> Identifier<Scalar>::pretended_by_the_torque_noise() const {
  // The residual is white and holds the torque's noise at its full density; 1.5 leaves room for chance. A torque that
  // is rich above 5 Hz looks noisier than that.
  const Scalar most = noise_.variance() * Scalar(1.5);
  Scalar noise = torque_noise_.variance() < most ? torque_noise_.variance() : most;
  if (noise < Scalar(kLeastTorqueNoise)) noise = Scalar(kLeastTorqueNoise);
  const CommonFilter<Scalar> filter = common_filter_now();
  return noise_information(p_.value(), filter.corner, filter.rate, noise, settings_->period_s, whitening_);
}

template <class Scalar>
void Identifier<Scalar>::judge_all(const NoiseInformation<Scalar>& pretended) {
  Vector3<Scalar> known;
  for (int i = 0; i < 3; ++i) known(i) = noise_.variance() / (settings_->prior.spread(i) * settings_->prior.spread(i));
  const auto unexcited = Scalar(1e12);
  Vector3<Scalar> bound = window_.bound(unexcited, pretended, known);
  // A J or B that is held does not learn, so nothing that the window shows confirms it. C that is held does no harm:
  // any motion that goes on shows it again.
  if (holds(held_, kInertia)) bound(kInertia) = unexcited;
  if (holds(held_, kDamping)) bound(kDamping) = unexcited;
  const Scalar claimed = claimed_variance();
  Vector3<Scalar> variance = covariance_.variance();
  for (int i = 0; i < 3; ++i) variance(i) *= claimed;
  // No wheel is without inertia: where the data fix it, and fix it at its limit, the model does not hold (torque the
  // wrong way round, swapped channels), and damping and stiffness mean nothing either.
  const Scalar lowest = settings_->prior.lowest(kInertia);
  const Scalar room = p_(kInertia) - lowest;
  const bool absurd = variance(kInertia) < lowest * lowest && room * room < Scalar(4) * variance(kInertia);
  const bool credible = !absurd && !doubtful();
  for (int i = 0; i < 3; ++i) judge(i, variance(i), bound(i) * noise_.variance(), credible);
}

template <class Scalar>
void Identifier<Scalar>::judge(int parameter, Scalar variance, Scalar window_bound, bool credible) {
  if (searching_ > 0 && belief_[parameter] == Belief::kStarting) return;
  // Before kColourFrom the noise, and with it the variance, is a guess.
  // A value within two standard deviations of its limit is what the limit made of it, not what the data say.
  const Scalar room = p_(parameter) - settings_->prior.lowest(parameter);
  const Scalar usable = settings_->usable * p_(parameter);
  const Scalar limit = usable * usable;
  const bool learned =
      searching_ == 0 && refined_ >= kWatchFrom && credible && variance <= limit && Scalar(4) * variance < room * room;
  // Leaving the excited state takes four times the bound that entering it does, so that it does not flicker.
  const bool was_excited = belief_[parameter] == Belief::kValid || belief_[parameter] == Belief::kConverging;
  // A window that has only begun says nothing yet.
  const bool excited = searching_ == 0 && window_.samples() < kEnough
                           ? was_excited
                           : window_bound <= (was_excited ? Scalar(4) * limit : limit);
  if (learned) {
    belief_[parameter] = excited ? Belief::kValid : Belief::kHolding;
  } else {
    const bool known_once = belief_[parameter] == Belief::kHolding && searching_ == 0;
    belief_[parameter] = excited ? Belief::kConverging : known_once ? Belief::kHolding : Belief::kNotExcited;
  }
}

/// Deviations speak of another noise than that of now, or the noise is far more than the arm leaves that is kept: what
/// was found in a fault takes up some of the fault, and the rest for noise.
template <class Scalar>
bool Identifier<Scalar>::doubtful() const {
  Scalar usual = noise_.variance();
  const Scalar kept = known_.variance();
  if (kept > Scalar(0) && kept < usual) usual = kept;
  const Scalar most = Scalar(kDoubtful) * usual;
  return recent_residual_ > (most > Scalar(kMisfitResidual) ? most : Scalar(kMisfitResidual));
}

/// At rest the residual is not that of a drive; C is what any motion shows.
template <class Scalar>
void Identifier<Scalar>::remember() {
  const auto known = [this](int i) { return belief_[i] == Belief::kValid || belief_[i] == Belief::kHolding; };
  known_.age();
  if (doubtful()) {
    known_.ask();
  } else if (belief_[kStiffness] == Belief::kValid && known(kDamping) && known(kInertia)) {
    known_.offer(p_, noise_.variance(), settings_->prior);
  }
}

}  // namespace steerid
