// The steps of the identifier declared in identifier.hpp, in the order in which a sample meets them.
#pragma once

#include "identifier/identifier.hpp"

namespace steerid {

template <class Scalar>
void Identifier<Scalar>::restart() {
  p_ = settings_.prior.value;
  noise_variance_ = Scalar(kLeastNoise);
  open_covariance();
  torque_noise_ = SensorNoise<Scalar>();
  angle_noise_ = SensorNoise<Scalar>();
  window_.reset();
  search(kSearch);
  resettle();
  refresh();
  for (Belief& belief : belief_) belief = Belief::kStarting;
}

template <class Scalar>
void Identifier<Scalar>::restore(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation, Scalar noise_nm) {
  restart();
  p_ = value;
  noise_variance_ = noise_nm * noise_nm;
  if (noise_variance_ < Scalar(kLeastNoise)) noise_variance_ = Scalar(kLeastNoise);
  covariance_ = UdCovariance<Scalar>(deviation);
  covariance_.scale(Scalar(1) / noise_variance_);
  searching_ = 0;
  start_refining();
  for (Belief& belief : belief_) belief = Belief::kHolding;
}

template <class Scalar>
void Identifier<Scalar>::resettle() {
  settling_ = kSettle;
  torque_noise_.break_here();
  angle_noise_.break_here();
}

template <class Scalar>
void Identifier<Scalar>::open_covariance() {
  covariance_ = UdCovariance<Scalar>(settings_.prior.spread);
  covariance_.scale(Scalar(kOpen));
}

template <class Scalar>
void Identifier<Scalar>::search(int samples) {
  searching_ = samples;
  refined_ = 0;
  colour_.reset();
  residual_shelf_.reset();
  instrument_shelf_.reset();
  change_.reset();
}

template <class Scalar>
void Identifier<Scalar>::update(Scalar torque_nm, Scalar angle_rad, bool learn) {
  const auto plausible = [](Scalar x) { return x <= Scalar(kLargest) && x >= Scalar(-kLargest); };
  if (!plausible(torque_nm) || !plausible(angle_rad)) {
    resettle();
    return;
  }
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
    measured_.fill(angle_rad);
    modelled_.fill(angle_rad);
    for (Scalar& late : torque_late_) late = torque_nm;
    model_angle_ = angle_rad;
    model_rate_ = Scalar(0);
    instrument_shelf_.reset();
    residual_shelf_.reset();
  }
  const Scalar torque = torque_filter_.step(torque_nm, common_, settings_.period_s);
  torque_late_[2] = torque_late_[1];
  torque_late_[1] = torque_late_[0];
  torque_late_[0] = torque;
  measured_.push(angle_filter_.step(angle_rad, common_, settings_.period_s));
  modelled_.push(free_run(instrument_shelf_.step(torque, colour_.depth())));

  if (settling_ > 0) {
    --settling_;
    return;
  }
  if (learn) {
    const Scalar rate_hz = Scalar(1) / settings_.period_s;
    learn_from(measured_.derivatives(rate_hz), modelled_.derivatives(rate_hz));
  }
  if (--until_refresh_ > 0) return;
  if (refined_ > kColourFrom && misfits()) {
    // What was taken for the sensors' noise was the fault's.
    torque_noise_ = SensorNoise<Scalar>();
    angle_noise_ = SensorNoise<Scalar>();
    open_covariance();
    search(kSearchAgain);
  }
  refresh();
}

/// The wheel of now, running freely on the filtered torque: the instrument's only source.
template <class Scalar>
Scalar Identifier<Scalar>::free_run(Scalar filtered_torque_nm) {
  const Scalar period = settings_.period_s;
  const Scalar inertia = p_(kInertia);
  // The step is stable for C T^2 < 4 J; only the corner of the limits that no arm reaches lies beyond.
  const Scalar stiffest = Scalar(3) * inertia / (period * period);
  const Scalar stiffness = p_(kStiffness) < stiffest ? p_(kStiffness) : stiffest;
  const Scalar push = period * (filtered_torque_nm - stiffness * model_angle_);
  model_rate_ = (inertia * model_rate_ + push) / (inertia + period * p_(kDamping));
  model_angle_ += period * model_rate_;
  return model_angle_;
}

template <class Scalar>
void Identifier<Scalar>::learn_from(const Vector3<Scalar>& measured, const Vector3<Scalar>& modelled) {
  const bool refining = searching_ == 0;
  const Vector3<Scalar>& z = refining ? modelled : measured;
  Scalar residual = torque_late_[Differentiator<Scalar>::kDelay] - measured.dot(p_);
  if (refining) residual = residual_shelf_.step(residual, colour_.depth());

  const Scalar spread = Scalar(1) + covariance_.along(z);
  const Scalar square = residual * residual / spread;
  const Scalar normalised = square / noise_variance_;
  if (refined_ > kColourFrom && change_.surprised(normalised)) {
    ++changes_;
    open_covariance();
    search(kSearchAgain);
    return;
  }
  const Scalar torque = torque_late_[Differentiator<Scalar>::kDelay];
  recent_torque_ += (torque * torque - recent_torque_) * Scalar(0.01);
  recent_residual_ += (square - recent_residual_) * Scalar(0.01);
  p_ += covariance_.observe(z) * residual;
  window_.push(z);
  keep_inside();
  learn_noise(normalised, square);
  if (!refining) {
    if (--searching_ == 0) start_refining();
    return;
  }
  forget(z);
  if (refined_ > kColourFrom) {
    const Scalar rise = colour_.learn(residual);
    if (rise > Scalar(0)) covariance_.scale(Scalar(1) + Scalar(kColourDoubt) * rise);
  }
}

/// No wheel of this kind explains what comes in: a sensor is at fault, or was until now.
template <class Scalar>
bool Identifier<Scalar>::misfits() const {
  return recent_torque_ > Scalar(kMisfitTorque) && recent_residual_ > Scalar(kMisfit) * recent_torque_;
}

template <class Scalar>
void Identifier<Scalar>::start_refining() {
  covariance_.scale(Scalar(kHandOver));
  early_forgetting_ = Scalar(kEarlyForgetting);
  refined_ = 0;
  refresh();
}

template <class Scalar>
void Identifier<Scalar>::forget(const Vector3<Scalar>& z) {
  covariance_.scale(Scalar(1) + early_forgetting_);
  early_forgetting_ *= Scalar(kEarlyFade);
  // Stenlund and Gustafsson: P gains Pd z z' Pd / (1 + z' Pd z), Pd what it is to return to where it is excited.
  const Vector3<Scalar> floor = p_ * settings_.memory_floor;
  const Vector3<Scalar> back = floor.cwiseProduct(floor).cwiseProduct(z) / noise_variance_;
  covariance_.spread(back, Scalar(1) / (Scalar(1) + z.dot(back)));
}

/// Onto the nearest limit in the metric of the covariance: the other parameters move as they would had the limit been
/// measured, and the covariance itself is left as it is.
template <class Scalar>
void Identifier<Scalar>::keep_inside() {
  for (int i = 0; i < 3; ++i) {
    Scalar limit = p_(i);
    if (limit < settings_.prior.lowest(i)) limit = settings_.prior.lowest(i);
    if (limit > settings_.prior.highest(i)) limit = settings_.prior.highest(i);
    if (limit == p_(i)) continue;
    const Vector3<Scalar> column = covariance_.column(i);
    p_ += column * ((limit - p_(i)) / column(i));
    p_(i) = limit;
  }
  p_ = p_.cwiseMax(settings_.prior.lowest).cwiseMin(settings_.prior.highest);
}

template <class Scalar>
void Identifier<Scalar>::learn_noise(Scalar normalised, Scalar square) {
  if (refined_ < kNoiseMemory) ++refined_;
  // Once the figure stands on enough samples a single wild one must not move it much.
  if (refined_ > kColourFrom && normalised > Scalar(9)) square = Scalar(9) * noise_variance_;
  noise_variance_ += (square - noise_variance_) / Scalar(refined_);
  if (noise_variance_ < Scalar(kLeastNoise)) noise_variance_ = Scalar(kLeastNoise);
}

template <class Scalar>
void Identifier<Scalar>::refresh() {
  until_refresh_ = kRefresh;
  // Before the sensors have shown their noise: 0.03 Nm over 0.0007 rad, a usual torque sensor and a usual encoder.
  Scalar rho_squared(1800);
  if (torque_noise_.known() && angle_noise_.variance() > Scalar(0)) {
    rho_squared = torque_noise_.variance() / angle_noise_.variance();
  }
  common_ = common_filter(p_, rho_squared, settings_.period_s);

  const Vector3<Scalar> variance = covariance_.variance() * noise_variance_;
  const Vector3<Scalar> bound = window_.bound(Scalar(1e12)) * noise_variance_;
  // No wheel is without inertia: where the data fix it, and fix it at its limit, the model does not hold (torque the
  // wrong way round, swapped channels), and damping and stiffness mean nothing either.
  const Scalar lowest = settings_.prior.lowest(kInertia);
  const Scalar room = p_(kInertia) - lowest;
  absurd_ = variance(kInertia) < lowest * lowest && room * room < Scalar(4) * variance(kInertia);
  for (int i = 0; i < 3; ++i) judge(i, variance(i), bound(i));
}

template <class Scalar>
void Identifier<Scalar>::judge(int parameter, Scalar variance, Scalar window_bound) {
  if (searching_ > 0 && belief_[parameter] == Belief::kStarting) return;
  // Before kColourFrom the noise, and with it the variance, is a guess.
  // A value within two standard deviations of its limit is what the limit made of it, not what the data say.
  const Scalar room = p_(parameter) - settings_.prior.lowest(parameter);
  const Scalar limit = settings_.usable * p_(parameter) * settings_.usable * p_(parameter);
  const bool learned = searching_ == 0 && !absurd_ && variance <= limit && Scalar(4) * variance < room * room;
  // Leaving the excited state takes four times the bound that entering it does, so that it does not flicker.
  const bool was_excited = belief_[parameter] == Belief::kValid || belief_[parameter] == Belief::kConverging;
  const bool excited = window_bound <= (was_excited ? Scalar(4) * limit : limit);
  if (learned) {
    belief_[parameter] = excited ? Belief::kValid : Belief::kHolding;
  } else {
    const bool known_once = belief_[parameter] == Belief::kHolding && searching_ == 0;
    belief_[parameter] = excited ? Belief::kConverging : known_once ? Belief::kHolding : Belief::kNotExcited;
  }
}

template <class Scalar>
Vector3<Scalar> Identifier<Scalar>::standard_deviation() const {
  const Vector3<Scalar> variance = covariance_.variance() * noise_variance_;
  const Vector3<Scalar> deviation(square_root(variance(0)), square_root(variance(1)), square_root(variance(2)));
  return deviation.cwiseMin(settings_.prior.spread);
}

template <class Scalar>
bool Identifier<Scalar>::sound() const {
  bool inside = covariance_.positive() && noise_variance_ >= Scalar(kLeastNoise);
  for (int i = 0; i < 3; ++i) {
    inside = inside && p_(i) >= settings_.prior.lowest(i) && p_(i) <= settings_.prior.highest(i);
  }
  return inside;
}

}  // namespace steerid
