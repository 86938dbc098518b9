// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

// Rad and rad/s beyond which a run has diverged: a wheel driven past the balance of a softening spring gets there
// within milliseconds, and no record does.
constexpr double kLost = 1e6;

}  // namespace

Plant::Plant(std::span<const Effect> effects, const RunSetting& setting)
    : wheel_(setting.wheel), per_inertia_(1 / setting.wheel.inertia_kgm2) {
  check_compatible(effects);
  bool turns_beside = false;  // a turn within a piece would be missed
  for (const Effect& given : effects) {
    if (given.type->in_plant == nullptr) continue;
    Part part;
    part.effect = given.type->in_plant(given.values, given.time_course_nm, setting);
    part.traits = part.effect->traits();
    const PlantTraits& traits = part.traits;
    if (!traits.acts && !traits.dry) continue;
    part.first_state = states_;
    states_ += static_cast<std::size_t>(traits.states);
    linear_plant_ = linear_plant_ && (traits.linear || traits.in_time_only || traits.bends());
    bends_ = bends_ || traits.bends();
    in_time_ = in_time_ || traits.in_time_only;
    slips_steadily_ = slips_steadily_ && (!traits.bends() || traits.slips_steadily);
    dry_ = dry_ || traits.dry;
    turns_at_rest_ = turns_at_rest_ || traits.turns_at_rest;
    divided_ = divided_ || traits.divided;
    turns_beside = turns_beside || (traits.remembers && !traits.bends());
    parts_.push_back(std::move(part));
  }
  if (states_ > kMaxStates) throw std::length_error("too many effects with states of their own");
  linear_plant_ = linear_plant_ && states_ <= 4;
  slips_steadily_ = slips_steadily_ && linear_plant_;
  bends_ = bends_ && !dry_ && !divided_ && !turns_beside && (linear_plant_ || states_ == 2);
  // The one that gives the arm a mass of its own comes last: it moves there what the others have made of the arm's
  // terms.
  std::stable_partition(parts_.begin(), parts_.end(), [](const Part& part) { return !part.traits.divides_arm; });
  set_pace();
}

void Plant::start(double time_s, const WheelState& state) {
  time_s_ = piece_start_s_ = step_middle_s_ = time_s;
  driver_ = motor_ = {};
  state_ = {};
  state_[0] = state.angle_rad;
  state_[1] = state.rate_rad_s;
  next_jump_s_ = time_s;  // not known yet
  // A wheel at rest is held until the first step has seen the torques.
  direction_ = turns_at_rest_ ? (state_[1] > 0) - (state_[1] < 0) : 1;
  for (Part& part : parts_) {
    part.slips = 0;
    part.region = part.effect->first_region(instant(time_s, state_, part));
    part.effect->start(instant(time_s, state_, part), &state_[part.first_state]);
  }
}

void Plant::advance(const Cubic& driver, const Cubic& motor, double span_s) {
  if (refinement_ == 1) return advance_piece(driver, motor, span_s);  // shifting costs half as much as a linear step
  const double part_s = span_s / refinement_;
  for (int i = 0; i < refinement_; ++i) advance_piece(driver.shifted(part_s * i), motor.shifted(part_s * i), part_s);
}

void Plant::advance_piece(const Cubic& driver, const Cubic& motor, double span_s) {
  piece_start_s_ = time_s_;
  driver_ = driver + torque_in_time(span_s);
  motor_ = motor;
  if (linear_plant_ && !bends_) return advance_linearly(span_s);
  if (bends_ && (advance_while_bending(span_s) || advance_while_slipping(span_s))) return;
  constexpr int kFew = 2;  // steps of Runge and Kutta's method, which cost less than exact ones
  const auto present_steps = [&] { return steps(span_s, varies_ ? present_per_s() : engaged_per_s_); };
  int count = present_steps();
  if (count > kFew && advance_while_moving(span_s)) return;
  // In equal steps as long as what takes part at each of them lets them be.
  const double end_s = piece_start_s_ + span_s;
  for (int events = 0; time_s_ < end_s;) {
    constexpr double kRounding = 1e-6;
    const double left_s = end_s - time_s_;
    const double left = std::ceil(left_s / span_s * count - kRounding);
    step(left > 1 ? time_s_ + left_s / left : end_s, events);
    if (time_s_ < end_s) count = present_steps();
  }
}

Instant Plant::instant(double time_s, const State& x, const Part& part) const {
  return {time_s, x[0], x[1], step_middle_s_, direction_, part.region, part.slips};
}

double Plant::level_nm(int direction, double speed_rad_s) const {
  double level = 0;
  for (const Part& part : parts_) {
    if (part.traits.dry) level += part.effect->dry_friction_nm(direction, speed_rad_s);
  }
  return level;
}

double Plant::derivative(double time_s, const State& x, State& dx) const {
  Balance balance;
  return derivative(time_s, x, dx, balance);
}

/// The states' rates and what they come from; returns the torque on the wheel apart from dry friction.
double Plant::derivative(double time_s, const State& x, State& dx, Balance& balance) const {
  const double tau = time_s - piece_start_s_;
  balance = {wheel_.inertia_kgm2,
             wheel_.damping_nms_per_rad,
             wheel_.stiffness_nm_per_rad,
             x[0],
             driver_.at(tau),
             motor_.at(tau),
             0};
  for (const Part& part : parts_) {
    if (!part.traits.acts || part.traits.in_time_only) continue;
    part.effect->act(instant(time_s, x, part), &x[part.first_state], &dx[part.first_state], balance);
  }
  const double net = balance.torque_driver_nm - balance.torque_motor_nm + balance.torque_nm -
                     balance.damping_nms_per_rad * x[1] - balance.stiffness_nm_per_rad * balance.spring_angle_rad;
  if (direction_ == 0) {
    dx[0] = 0;
    dx[1] = 0;
  } else {
    const double friction = dry_ ? direction_ * level_nm(direction_, direction_ * x[1]) : 0;
    dx[0] = x[1];
    // The division is the slowest operation here; most effects leave the inertia as it is.
    dx[1] = (net - friction) * (balance.inertia_kgm2 == wheel_.inertia_kgm2 ? per_inertia_ : 1 / balance.inertia_kgm2);
  }
  return net;
}

/// From the present over h; slope_ must hold the present derivative. `Count` is the number of states, 0 for states_:
/// the usual two are worth unrolling.
template <std::size_t Count>
void Plant::runge_kutta_of(double h, State& next) const {
  const std::size_t count = Count == 0 ? states_ : Count;
  State k2;
  State k3;
  State k4;
  State x = state_;
  const auto probe = [&](const State& slope, double s) {
    for (std::size_t i = 0; i < count; ++i) x[i] = state_[i] + s * slope[i];
  };
  probe(slope_, h / 2);
  derivative(time_s_ + h / 2, x, k2);
  probe(k2, h / 2);
  derivative(time_s_ + h / 2, x, k3);
  probe(k3, h);
  derivative(time_s_ + h, x, k4);
  for (std::size_t i = 0; i < count; ++i) next[i] = state_[i] + h / 6 * (slope_[i] + 2 * (k2[i] + k3[i]) + k4[i]);
}

void Plant::runge_kutta(double h, State& next) const {
  if (states_ > 2) {
    runge_kutta_of<0>(h, next);
  } else if (direction_ == 0) {
    next = state_;
  } else {
    runge_kutta_of<2>(h, next);
  }
}

/// At rest: which way the wheel starts, or 0 when friction holds it.
void Plant::choose_direction() {
  State slope;
  const double net = derivative(time_s_, state_, slope);
  direction_ = net > level_nm(1, 0) ? 1 : net < -level_nm(-1, 0) ? -1 : 0;
}

/// The next time at which an effect jumps, asked of them once the last one is past.
double Plant::coming_jump_s() {
  if (time_s_ < next_jump_s_) return next_jump_s_;
  next_jump_s_ = kNever_s;
  for (const Part& part : parts_) next_jump_s_ = std::min(next_jump_s_, part.effect->next_jump_s(time_s_));
  return next_jump_s_;
}

/// One step, as far as the target, the next jump or the next event.
void Plant::step(double target_s, int& events) {
  const double end_s = std::min(target_s, coming_jump_s());
  const double h = end_s - time_s_;
  step_middle_s_ = time_s_ + h / 2;
  if (direction_ == 0) choose_direction();
  begin_to_slip();
  derivative(time_s_, state_, slope_);
  State next;
  runge_kutta(h, next);
  if (!(std::abs(next[0]) < kLost && std::abs(next[1]) < kLost)) {  // also when not a number
    state_.fill(std::numeric_limits<double>::quiet_NaN());
    time_s_ = target_s;
    return;
  }
  const Event event = events < kMostEvents ? first_event(next, h) : Event{};
  if (event.kind == Event::Kind::kNone) {
    accept(next, end_s);
  } else {
    ++events;
    take(event);
  }
}

void Plant::accept(const State& next, double time_s) {
  std::copy_n(next.begin(), states_, state_.begin());
  time_s_ = time_s;
  for (Part& part : parts_) {
    if (part.traits.remembers) part.effect->remember(instant(time_s, state_, part));
  }
}

}  // namespace steerid
