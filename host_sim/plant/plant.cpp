#include "plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Where g, at most 0 at `lo` and positive at `hi`, changes sign: the upper end of the last bracket, so that g > 0
/// there. Illinois' variant of false position (Dowell and Jarratt, BIT 11, 1971).
template <class Function>
double upper_root(Function g, double lo, double g_lo, double hi, double g_hi, double tolerance) {
  for (int i = 0; i < 60 && hi - lo > tolerance; ++i) {
    const double guess =
        std::clamp(lo + (hi - lo) * g_lo / (g_lo - g_hi), lo + 0.01 * (hi - lo), hi - 0.01 * (hi - lo));
    const double value = g(guess);
    if (value > 0) {
      hi = guess;
      g_hi = value;
      g_lo *= 0.5;
    } else {
      lo = guess;
      g_lo = value;
      g_hi *= 0.5;
    }
  }
  return hi;
}

/// When y, known at both ends of a step of `h` with its rates, leaves the positive side for good: y(0) >= 0 > y(h).
double crossing_after(double y0, double rate0, double y1, double rate1, double h) {
  const Cubic y = Cubic::hermite(y0, rate0, y1, rate1, h);
  double lo = 0;
  if (y0 <= 0) {  // starts on the boundary: look for where it had left it inwards
    if (rate0 <= 0) return 0;
    for (lo = h / 2; y.at(lo) <= 0; lo /= 2) {
      if (lo < 1e-6 * h) return 0;
    }
  }
  return upper_root([&](double s) { return -y.at(s); }, lo, -y.at(lo), h, -y1, 1e-12 * h);
}

}  // namespace

Plant::Plant(std::span<const Effect> effects, const RunSetting& setting) : wheel_(setting.wheel) {
  check_compatible(effects);
  double stiffness = std::abs(wheel_.stiffness_nm_per_rad);
  double damping = std::abs(wheel_.damping_nms_per_rad);
  double inertia_share = 1;
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
    dry_ = dry_ || traits.dry;
    turns_at_rest_ = turns_at_rest_ || traits.turns_at_rest;
    stiffness += traits.added_stiffness_nm_per_rad;
    damping += traits.added_damping_nms_per_rad;
    inertia_share = std::min(inertia_share, traits.least_inertia_share);
    fastest_per_s_ = std::max(fastest_per_s_, traits.fastest_per_s);
    parts_.push_back(std::move(part));
  }
  if (states_ > kMaxStates) throw std::length_error("too many effects with states of their own");
  // The one that gives the arm a mass of its own comes last: it moves there what the others have made of the arm's
  // terms.
  std::ranges::stable_partition(parts_, [](const Part& part) { return !part.divides_arm; });
  const double inertia = inertia_share * wheel_.inertia_kgm2;
  fastest_per_s_ = std::max({fastest_per_s_, std::sqrt(stiffness / inertia), damping / inertia});
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
  if (parts_.empty()) {
    step_linear(driver - motor, span_s);
    return;
  }
  piece_start_s_ = time_s_;
  driver_ = driver;
  motor_ = motor;
  const int count = steps(span_s);
  for (int i = 1; i < count; ++i) reach(piece_start_s_ + span_s * i / count);
  reach(piece_start_s_ + span_s);
}

int Plant::steps(double span_s) const {
  constexpr double kMost = 1e5;
  return refinement_ * static_cast<int>(std::clamp(std::ceil(span_s * fastest_per_s_ / kStepAngle), 1.0, kMost));
}

void Plant::step_linear(const Cubic& net, double span_s) {
  if (!linear_ || std::abs(span_s - linear_span_s_) > 1e-9 * span_s) {
    linear_.emplace(wheel_, span_s);
    linear_span_s_ = span_s;
  }
  const auto& e = linear_->transition;
  const auto& g = linear_->input;
  const double angle = state_[0];
  const double rate = state_[1];
  for (int row = 0; row < 2; ++row) {
    state_[static_cast<std::size_t>(row)] = e(row, 0) * angle + e(row, 1) * rate + g(row, 0) * net.c0 +
                                            g(row, 1) * net.c1 + g(row, 2) * net.c2 + g(row, 3) * net.c3;
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
    dx[1] = (net - friction) / balance.inertia_kgm2;
  }
  return net;
}

void Plant::runge_kutta(double h, State& next) {
  State k2;
  State k3;
  State k4;
  State x;
  const auto probe = [&](const State& slope, double s) {
    for (std::size_t i = 0; i < states_; ++i) x[i] = state_[i] + s * slope[i];
  };
  derivative(time_s_, state_, slope_);
  probe(slope_, h / 2);
  derivative(time_s_ + h / 2, x, k2);
  probe(k2, h / 2);
  derivative(time_s_ + h / 2, x, k3);
  probe(k3, h);
  derivative(time_s_ + h, x, k4);
  for (std::size_t i = 0; i < states_; ++i) {
    next[i] = state_[i] + h / 6 * (slope_[i] + 2 * (k2[i] + k3[i]) + k4[i]);
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

void Plant::reach(double target_s) {
  State next;
  for (int events = 0; time_s_ < target_s;) {
    if (time_s_ >= next_jump_s_) next_jump_s_ = next_jump_s();
    const double end_s = std::min(target_s, next_jump_s_);
    const double h = end_s - time_s_;
    step_middle_s_ = time_s_ + h / 2;
    if (direction_ == 0) choose_direction();
    runge_kutta(h, next);
    Event event = events < kMostEvents ? first_event(next, h) : Event{};
    if (event.kind == Event::Kind::kNone) {
      accept(next, end_s);
    } else {
      ++events;
      polish(event, h);
      take(event);
    }
  }
}

void Plant::accept(const State& next, double time_s) {
  std::copy_n(next.begin(), states_, state_.begin());
  time_s_ = time_s;
  for (Part& part : parts_) {
    if (part.traits.remembers) part.effect->remember(instant(time_s, state_, part.region));
  }
}

Plant::Event Plant::first_event(const State& next, double h) {
  using Kind = Event::Kind;
  Event first;
  const auto earliest = [&first](const Event& other) {
    if (first.kind == Kind::kNone || other.after_s < first.after_s) first = other;
  };
  State end_slope;
  if (direction_ == 0) {
    const double net = derivative(time_s_ + h, next, end_slope);
    const int sign = net > level_nm(1, 0) ? 1 : net < -level_nm(-1, 0) ? -1 : 0;
    if (sign != 0) earliest({.kind = Kind::kBreakaway, .after_s = breakaway_after(h, sign), .sign = sign});
    return first;
  }
  if (turns_at_rest_ && direction_ * next[1] < 0) {
    derivative(time_s_ + h, next, end_slope);
    earliest({.kind = Kind::kRest,
              .after_s = crossing_after(direction_ * state_[1], direction_ * slope_[1], direction_ * next[1],
                                        direction_ * end_slope[1], h)});
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const PlantTraits& traits = parts_[p].traits;
    const int region = parts_[p].region;
    for (const int sign : {-1, 1}) {
      const int edge = sign > 0 ? region : region - 1;  // the edge on that side of the region
      if (edge < 0 || edge >= traits.edge_count) continue;
      const double edge_rad = traits.edges_rad[static_cast<std::size_t>(edge)];
      if (sign * (next[0] - edge_rad) <= 0) continue;
      earliest({.kind = Kind::kEdge,
                .after_s = crossing_after(sign * (edge_rad - state_[0]), -sign * state_[1], sign * (edge_rad - next[0]),
                                          -sign * next[1], h),
                .sign = sign,
                .part = p,
                .edge_rad = edge_rad});
    }
  }
  return first;
}

double Plant::breakaway_after(double h, int sign) {
  State x = state_;
  State slope;
  const double level = level_nm(sign, 0);
  const auto excess = [&](double s) {
    if (states_ > 2) runge_kutta(s, x);
    return sign * derivative(time_s_ + s, x, slope) - level;
  };
  const double now = excess(0);
  return now > 0 ? 0 : upper_root(excess, 0, now, h, excess(h), 1e-10 * h);
}

/// One Newton step on the integrated state itself: the Hermite cubic that found the event is not it.
void Plant::polish(Event& event, double h) {
  if (event.kind == Event::Kind::kBreakaway || event.after_s == 0) return;
  State x;
  State slope;
  runge_kutta(event.after_s, x);
  derivative(time_s_ + event.after_s, x, slope);
  const bool rest = event.kind == Event::Kind::kRest;
  const double residual = rest ? x[1] : x[0] - event.edge_rad;
  const double rate = rest ? slope[1] : slope[0];
  if (rate != 0) event.after_s = std::clamp(event.after_s - residual / rate, 0.0, h);
}

void Plant::take(const Event& event) {
  State next = state_;
  if (event.after_s > 0) runge_kutta(event.after_s, next);
  if (event.kind == Event::Kind::kEdge) {
    next[0] = event.edge_rad;
    parts_[event.part].region += event.sign;
  } else {
    next[1] = 0;
  }
  accept(next, time_s_ + event.after_s);
  if (event.kind == Event::Kind::kRest) choose_direction();
  if (event.kind == Event::Kind::kBreakaway) direction_ = event.sign;
}

}  // namespace steerid
