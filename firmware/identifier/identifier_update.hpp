// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The steps of the identifier declared in identifier.hpp, in the order in which a sample meets them. What is examined
// twice a second is in identifier_refresh.hpp.
#pragma once

#include "identifier/identifier.hpp"

namespace steerid {

template <class Scalar>
void Identifier<Scalar>::restart() {
  p_ = Vector3<Scalar>(settings_->prior.value);
  noise_.forget();
  colour_.reset();
  known_ = KnownArm<Scalar>();
  hand_over_.reset();
  search_anew(kSearch);
  resettle();
  refresh();
  for (Belief& belief : belief_) belief = Belief::kStarting;
}

template <class Scalar>
void Identifier<Scalar>::restore(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation, Scalar noise_nm) {
  restart();
  const Scalar variance = noise_nm * noise_nm;
  const auto least = Scalar(ResidualNoise<Scalar>::kLeast);
  believe(value, deviation, variance < least ? least : variance);
  start_refining();
  refresh();
  for (Belief& belief : belief_) belief = Belief::kHolding;
}

/// Without a search, with a residual of this variance.
template <class Scalar>
void Identifier<Scalar>::believe(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation, Scalar variance) {
  p_ = value;
  noise_.assume(variance);
  covariance_ = UdCovariance<Scalar>(deviation);
  covariance_.scale(Scalar(1) / variance);
  searching_ = 0;
}

template <class Scalar>
void Identifier<Scalar>::resettle() {
  settling_ = kSettle;
  torque_noise_.break_here();
  angle_noise_.break_here();
}

template <class Scalar>
void Identifier<Scalar>::open_covariance() {
  covariance_ = UdCovariance<Scalar>(settings_->prior.spread);
  covariance_.scale(Scalar(kOpen));
}

/// What was taken for it may have been a fault's.
template <class Scalar>
void Identifier<Scalar>::forget_sensor_noise() {
  torque_noise_ = SensorNoise<Scalar>();
  angle_noise_ = SensorNoise<Scalar>();
}

/// With nothing learned, of the sensors' noise either.
template <class Scalar>
void Identifier<Scalar>::search_anew(std::uint8_t samples) {
  forget_sensor_noise();
  open_covariance();
  search(samples);
}

template <class Scalar>
void Identifier<Scalar>::search(std::uint8_t samples) {
  searching_ = samples;
  window_.reset();
  held_ = Held::kNone;
  another_arm_ = false;
  refined_ = 0;
  noise_.begin_anew();
  change_.reset();
  for (Belief& belief : belief_) {
    if (belief == Belief::kValid) belief = Belief::kConverging;
  }
}

template <class Scalar>
void Identifier<Scalar>::update(Scalar torque_nm, Scalar angle_rad, bool learn) {
  const auto plausible = [](Scalar x) { return x <= Scalar(kLargest) && x >= Scalar(-kLargest); };
  if (!plausible(torque_nm) || !plausible(angle_rad)) {
    resettle();
    return;
  }
  recovered_ = false;
  const bool searched = searching_ > 0;
  const Scalar late = torque_late_[Differentiator<Scalar>::kDelay - 1];  // as `measured_` will be
  if (!take_in(torque_nm, angle_rad, learn)) return;
  if (known_.asked() && learn && took_back(late)) {
    refresh();
  } else if (searched && searching_ == 0) {
    start_refining();
    refresh();
  }
  if (--until_refresh_ > 0) return;
  if (refined_ > kColourFrom && misfits()) {
    // What was taken for the sensors' noise was the fault's.
    search_anew(kSearchAgain);
    known_.ask();
  }
  refresh();
}

/// Filters, and learns from what comes out of them; false while they fill.
template <class Scalar>
bool Identifier<Scalar>::take_in(Scalar torque_nm, Scalar angle_rad, bool learn) {
  if (learn) {
    torque_noise_.push(torque_nm);
    angle_noise_.push(angle_rad);
  } else {
    torque_noise_.break_here();
    angle_noise_.break_here();
  }
  if (settling_ == kSettle) {
    // Starting at the first sample instead of at zero leaves nothing to decay but the rates.
    torque_filter_.settle_at(torque_nm);
    angle_filter_.settle_at(angle_rad);
    torque_whitening_.settle_at(torque_nm);
    angle_whitening_.settle_at(angle_rad);
    const Scalar left = whitening_.at_rest();
    measured_.fill(left * angle_rad);
    for (Scalar& late : torque_late_) late = left * torque_nm;
  }
  const Scalar torque = torque_filter_.step(torque_nm, common_, settings_->period_s);
  const Scalar late = torque_late_[1];
  torque_late_[1] = torque_late_[0];
  torque_late_[0] = torque_whitening_.step(torque, whitening_);
  Moved<Scalar> angle = angle_whitening_.step(angle_filter_.move(angle_rad, common_, settings_->period_s), whitening_);
  angle.to -= whitening_.at_rest() * rest_;  // behind the filters: what is subtracted may change, and nothing rings
  measured_.push(angle);
  if (settling_ > 0 || searching_ > 0 || model_waits_) {
    // It starts from where the wheel is.
    model_.start_at(angle.to, settings_->rate_hz * angle.by);
    modelled_ = measured_;
  } else {
    // Behind the whitening filter, because the wheel is another one after every refresh: what a slow motion of 1 rad
    // jumps by then would pass a whitening filter behind it whole, and would be a hundred times what the whitening
    // filter leaves of the motion itself.
    modelled_.push(model_.move(torque_late_[0], settings_->period_s));
  }

  if (settling_ > 0) {
    --settling_;
    ringing_ = 0;
    model_waits_ = false;
    return false;
  }
  if (ringing_ > 0) {
    if (--ringing_ == 0) model_waits_ = false;
  } else if (learn) {
    recent_torque_ += (torque * torque - recent_torque_) * Scalar(0.01);
    learn_from(late, measured_.derivatives(settings_->rate_hz), modelled_.derivatives(settings_->rate_hz));
  }
  return true;
}

template <class Scalar>
inline void Identifier<Scalar>::learn_from(Scalar torque, const Vector3<Scalar>& measured,
                                           const Vector3<Scalar>& modelled) {
  const bool refining = searching_ == 0;
  const Vector3<Scalar>& z = refining ? modelled : measured;
  const Scalar residual = torque - measured.dot(p_.value());
  recent_whitened_ += (torque * torque - recent_whitened_) * Scalar(0.01);

  const auto correction = covariance_.observe(z, residual, held_);
  const Scalar square = residual * residual / Scalar(correction.spread);
  const Scalar normalised = square / noise_.variance();
  if (refined_ >= kWatchFrom && held_ == Held::kNone &&
      change_.surprised(normalised, square, recent_whitened_, unmeasured_square())) {
    ++changes_;
    open_covariance();
    search(kSearchAgain);
    another_arm_ = true;
    forgetting_.forget_all(Scalar(SearchHandOver<Scalar>::kForgettingAnother));
    known_.ask();
    // Found without the whitening filter first, which leaves little of a steering motion; the colour was learned in
    // part from an arm that was not the model's any more.
    colour_.start_anew();
    whitening_ = WhiteningShape<Scalar>();
    ringing_ = WhiteningShape<Scalar>::kBehind;
    return;
  }
  recent_residual_ += (square - recent_residual_) * Scalar(0.01);
  p_.add(correction);
  window_.push(z);
  if (!inside()) bring_inside();
  learn_noise(normalised, square);
  if (refining || another_arm_) {
    const Scalar floor_square = settings_->memory_floor * settings_->memory_floor / noise_.variance();
    forgetting_.forget(covariance_, p_, z, floor_square, held_);
  }
  if (!refining) {
    // What F holds of the arm of before is in the first samples, as many as F remembers.
    forgetting_.fade(Scalar(0.75) + Scalar(0.25) * common_.rate_keep);
    --searching_;
    return;
  }
  const Scalar coloured = inverse_whitening_.step(residual, whitening_);
  noise_.score(residual, z(kDamping), z(kStiffness));
  // A wild residual says that the arm may be another one, nothing of the noise.
  if (refined_ > kLearnColourFrom && normalised < Scalar(ResidualNoise<Scalar>::kWild)) colour_.learn(coloured);
}

/// No wheel of this kind explains what comes in: a sensor is at fault, or was until now.
template <class Scalar>
bool Identifier<Scalar>::misfits() const {
  // With so much torque something must show, unless the model has gone astray; in a window long enough for the torque
  // of before it to be forgotten.
  const bool astray =
      held_ == Held::kAll && refined_ >= kWatchFrom && window_.samples() >= WindowInformation<Scalar>::kBlock;
  const Scalar share = astray ? Scalar(kAstray) : Scalar(kMisfit);
  const Scalar most = share * recent_torque_;
  return most > Scalar(kMisfitResidual) && recent_residual_ > most;
}

template <class Scalar>
void Identifier<Scalar>::take_over_what_was_shown() {
  Scalar angle_noise = angle_noise_.variance();
  if (angle_noise < Scalar(kLeastAngleNoise)) angle_noise = Scalar(kLeastAngleNoise);
  const CommonFilter<Scalar> filter = common_filter_now();
  const NoiseInformation<Scalar> noise =
      angle_noise_information(filter.corner, filter.rate, angle_noise, settings_->period_s);
  held_ = hand_over_.take_over(p_, covariance_, window_.noise_share(noise), recent_residual_, recent_torque_,
                               noise_.variance(), settings_->prior);
}

/// What the search found is where refining starts.
template <class Scalar>
void Identifier<Scalar>::start_refining() {
  covariance_.scale(SearchHandOver<Scalar>::variance_factor(another_arm_));
  // Another arm is searched for only while the motion shows everything; after a restore there was no search.
  if (window_.samples() > 0 && !another_arm_) take_over_what_was_shown();
  window_.reset();
  forgetting_.forget_all(Scalar(SearchHandOver<Scalar>::kForgetting));
  refined_ = 0;
  noise_.stands_on(0);
}

/// Takes back the arm that was known if it has explained enough, to its noise: the fault is over, or what was taken for
/// another arm was none. Nothing needs to be searched for or watched then.
template <class Scalar>
bool Identifier<Scalar>::took_back(Scalar torque) {
  const Vector3<Scalar> value = known_.value(settings_->prior);
  known_.compare(torque, torque - measured_.derivatives(settings_->rate_hz).dot(value));
  if (!known_.explains()) return false;
  believe(value, value * Scalar(kTakenBack), known_.variance());
  noise_at_last_refresh_ = noise_.variance();
  recent_residual_ = noise_.variance();
  forgetting_.forget_all(Scalar(0));
  held_ = Held::kNone;
  another_arm_ = false;
  change_.reset();
  refined_ = kWatchFrom;
  noise_.stands_on(ResidualNoise<Scalar>::kFirm);
  model_waits_ = true;
  ringing_ = 1;
  // Until the window is long enough to say of each.
  for (Belief& belief : belief_) belief = Belief::kConverging;
  known_.taken_back();
  recovered_ = true;
  // Whitening filter and colour stay: behind them the arm explains what comes in.
  forget_sensor_noise();
  inverse_whitening_ = InverseWhiteningFilter<Scalar>();
  return true;
}

template <class Scalar>
void Identifier<Scalar>::go_on_with(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation) {
  believe(value, deviation, noise_.variance());
  for (int i = 0; i < 3; ++i) p_.set(i, nearest_inside(i));
  forgetting_.forget_all(Scalar(0));
  held_ = Held::kNone;
  change_.reset();
  model_waits_ = true;
  ringing_ = 1;
}

template <class Scalar>
bool Identifier<Scalar>::inside() const {
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    if (!(p_(i) >= settings_->prior.lowest(i) && p_(i) <= settings_->prior.highest(i))) return false;
  }
  return true;
}

template <class Scalar>
Scalar Identifier<Scalar>::nearest_inside(int parameter) const {
  const Scalar value = p_(parameter);
  if (value < settings_->prior.lowest(parameter)) return settings_->prior.lowest(parameter);
  return value > settings_->prior.highest(parameter) ? settings_->prior.highest(parameter) : value;
}

/// Onto the nearest limit in the metric of the covariance: the other parameters move as they would had the limit been
/// measured, and the covariance itself is left as it is.
template <class Scalar>
void Identifier<Scalar>::bring_inside() {
  for (int i = 0; i < 3; ++i) {
    const Scalar limit = nearest_inside(i);
    if (limit == p_(i)) continue;
    const Vector3<Scalar> column = covariance_.column(i, held_);
    if (column(i) > Scalar(0)) {
      const Scalar by = (limit - p_(i)) / column(i);
      for (int j = 0; j < 3; ++j) p_.set(j, p_(j) + column(j) * by);
    }
    p_.set(i, limit);
  }
  for (int i = 0; i < 3; ++i) p_.set(i, nearest_inside(i));
}

template <class Scalar>
void Identifier<Scalar>::learn_noise(Scalar normalised, Scalar square) {
  // Until the colour is known nothing is valid; a wild residual says nothing of it (learn_from).
  if (refined_ < kWatchFrom && (refined_ <= kLearnColourFrom || normalised < Scalar(ResidualNoise<Scalar>::kWild))) {
    // What the parameters left on their way was not noise.
    if (++refined_ == kLearnColourFrom) noise_.stands_on(kNoiseKept);
  }
  noise_.learn(normalised, square, refined_ > kColourFrom);
}

template <class Scalar>
Vector3<Scalar> Identifier<Scalar>::standard_deviation() const {
  Vector3<Scalar> deviation = covariance_.variance() * claimed_variance();
#pragma GCC unroll 1
  for (int i = 0; i < 3; ++i) {
    const Scalar most = settings_->prior.spread(i);
    deviation(i) = square_root(deviation(i));
    if (deviation(i) > most) deviation(i) = most;
  }
  return deviation;
}

template <class Scalar>
bool Identifier<Scalar>::sound() const {
  return inside() && covariance_.positive() && noise_.variance() >= Scalar(ResidualNoise<Scalar>::kLeast);
}

}  // namespace steerid
