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

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

Plant::Plant(std::span<const Effect> effects, const RunSetting& setting)
    : wheel_(setting.wheel), per_inertia_(1 / setting.wheel.inertia_kgm2) {
  check_compatible(effects);
  for (const Effect& given : effects) {
    if (given.type->in_plant == nullptr) continue;
    Part part;
    part.effect = given.type->in_plant(given.values, given.time_course_nm, setting);
    part.traits = part.effect->traits();
    const PlantTraits& traits = part.traits;
    if (!traits.acts && !traits.dry) continue;
    part.first_state = states_;
    part.divides_arm = given.type->joint == EffectType::Joint::kAlone;
    states_ += static_cast<std::size_t>(traits.states);
    linear_plant_ = linear_plant_ && traits.linear;
    dry_ = dry_ || traits.dry;
    turns_at_rest_ = turns_at_rest_ || traits.turns_at_rest;
    parts_.push_back(std::move(part));
  }
  if (states_ > kMaxStates) throw std::length_error("too many effects with states of their own");
  linear_plant_ = linear_plant_ && states_ <= 4;
  // The one that gives the arm a mass of its own comes last: it moves there what the others have made of the arm's
  // terms.
  std::stable_partition(parts_.begin(), parts_.end(), [](const Part& part) { return !part.divides_arm; });
  set_pace();
}

void Plant::start(double time_s, const WheelState& state) {
  time_s_ = piece_start_s_ = step_middle_s_ = time_s;
  driver_ = motor_ = {};
  state_ = {};
  state_[0] = state.angle_rad;
  state_[1] = state.rate_rad_s;
  next_jump_s_ = next_jump_s();
  settle_regions();
  // A wheel at rest is held until the first step has seen the torques.
  direction_ = turns_at_rest_ ? (state_[1] > 0) - (state_[1] < 0) : 1;
  for (Part& part : parts_) {
    part.effect->start(instant(time_s, state_, part.region), &state_[part.first_state]);
  }
}

void Plant::settle_regions() {
  for (Part& part : parts_) {
    part.region = 0;
    for (int i = 0; i < part.traits.edge_count; ++i) {
      if (state_[0] > part.traits.edges_rad[static_cast<std::size_t>(i)]) part.region = i + 1;
    }
  }
}

void Plant::advance(const Cubic& driver, const Cubic& motor, double span_s) {
  if (linear_plant_) {
    step_linear(driver - motor, span_s);
    return;
  }
  piece_start_s_ = time_s_;
  driver_ = driver;
  motor_ = motor;
  const double end_s = piece_start_s_ + span_s;
  if (varies_) {
    reach_at_present_pace(end_s);
    return;
  }
  const int count = steps(span_s, engaged_per_s_);
  for (int i = 1; i <= count; ++i) {
    const double target_s = i == count ? end_s : piece_start_s_ + span_s * i / count;
    for (int events = 0; time_s_ < target_s;) step(target_s, events);
  }
}

/// In steps as long as what takes part at each of them lets them be.
void Plant::reach_at_present_pace(double end_s) {
  const double span_s = end_s - time_s_;
  for (int events = 0; time_s_ < end_s;) {
    constexpr double kRounding = 1e-6;
    const double left_s = end_s - time_s_;
    const double count = std::ceil(left_s / span_s * steps(span_s, present_per_s()) - kRounding);
    step(count > 1 ? time_s_ + left_s / count : end_s, events);
  }
}

/// The exact step; with effects its matrices are read off derivative(), column by column.
LinearStep Plant::linear_step(double span_s) {
  if (parts_.empty()) return {wheel_, span_s};
  Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
  Eigen::Vector4d push = Eigen::Vector4d::Zero();
  const auto slope_into = [&](const State& x, auto column) {
    State dx{};
    derivative(time_s_, x, dx);
    for (std::size_t i = 0; i < states_; ++i) column[static_cast<Eigen::Index>(i)] = dx[i];
  };
  driver_ = {1, 0, 0, 0};
  motor_ = {};
  slope_into({}, push.col(0));
  driver_ = {};
  for (std::size_t i = 0; i < states_; ++i) {
    State x{};
    x[i] = 1;
    slope_into(x, rate.col(static_cast<Eigen::Index>(i)));
  }
  return {rate, push, span_s};
}

void Plant::step_linear(const Cubic& net, double span_s) {
  if (!linear_ || std::abs(span_s - linear_span_s_) > 1e-9 * span_s) {
    linear_.emplace(linear_step(span_s));
    linear_span_s_ = span_s;
  }
  const auto& e = linear_->transition;
  const auto& g = linear_->input;
  const State from = state_;
  for (std::size_t i = 0; i < states_; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double next = e(row, 0) * from[0] + e(row, 1) * from[1];
    for (std::size_t j = 2; j < states_; ++j) next += e(row, static_cast<Eigen::Index>(j)) * from[j];
    state_[i] = next + g(row, 0) * net.c0 + g(row, 1) * net.c1 + g(row, 2) * net.c2 + g(row, 3) * net.c3;
  }
  time_s_ += span_s;
}

Instant Plant::instant(double time_s, const State& x, int region) const {
  return {time_s, x[0], x[1], step_middle_s_, direction_, region};
}

double Plant::level_nm(int direction, double speed_rad_s) const {
  double level = 0;
  for (const Part& part : parts_) {
    if (part.traits.dry) level += part.effect->dry_friction_nm(direction, speed_rad_s);
  }
  return level;
}

/// The states' rates; returns the torque on the wheel apart from dry friction.
double Plant::derivative(double time_s, const State& x, State& dx) const {
  const double tau = time_s - piece_start_s_;
  Balance balance{wheel_.inertia_kgm2,
                  wheel_.damping_nms_per_rad,
                  wheel_.stiffness_nm_per_rad,
                  x[0],
                  driver_.at(tau),
                  motor_.at(tau),
                  0};
  for (const Part& part : parts_) {
    if (!part.traits.acts) continue;
    part.effect->act(instant(time_s, x, part.region), &x[part.first_state], &dx[part.first_state], balance);
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

double Plant::next_jump_s() const {
  double next = kNever;
  for (const Part& part : parts_) next = std::min(next, part.effect->next_jump_s(time_s_));
  return next;
}

/// One step, as far as the target, the next jump or the next event.
void Plant::step(double target_s, int& events) {
  if (time_s_ >= next_jump_s_) next_jump_s_ = next_jump_s();
  const double end_s = std::min(target_s, next_jump_s_);
  const double h = end_s - time_s_;
  step_middle_s_ = time_s_ + h / 2;
  if (direction_ == 0) choose_direction();
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
    if (part.traits.remembers) part.effect->remember(instant(time_s, state_, part.region));
  }
}

}  // namespace steerid
