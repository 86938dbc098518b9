// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a step of the plant is cut short: rest, breakaway, slip and where another of an effect's
// laws begins, found and set exactly.
#include <algorithm>
#include <cmath>

#include "plant/plant.hpp"

namespace steerid {
namespace {

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

/// Where a cubic that falls at 0 and rises at `h` is lowest in between.
double lowest_of(const Cubic& y, double h) {
  // y' = c1 + 2 c2 s + 3 c3 s^2 with y'(0) < 0 < y'(h): the root between them, in the form that does not cancel.
  const double root = std::sqrt(std::max(0.0, y.c2 * y.c2 - 3 * y.c3 * y.c1));
  const double s = y.c2 + root > 0 ? -y.c1 / (y.c2 + root) : h;
  return std::clamp(s, 0.0, h);
}

/// When y, known at both ends of a step of `h` with its rates, leaves the positive side: y(0) >= 0, and y(h) < 0 or y
/// below 0 in between. Infinite if it does not.
double crossing_after(double y0, double rate0, double y1, double rate1, double h) {
  const Cubic y = Cubic::hermite(y0, rate0, y1, rate1, h);
  double hi = h;
  if (y1 >= 0) {
    if (!(rate0 < 0 && rate1 > 0)) return kNever_s;
    hi = lowest_of(y, h);
    if (!(y.at(hi) < 0)) return kNever_s;
  }
  double lo = 0;
  if (y0 <= 0) {  // starts on the boundary: look for where it had left it inwards
    if (rate0 <= 0) return 0;
    for (lo = hi / 2; y.at(lo) <= 0; lo /= 2) {
      if (lo < 1e-6 * h) return 0;
    }
  }
  return upper_root([&](double s) { return -y.at(s); }, lo, -y.at(lo), hi, -y.at(hi), 1e-6 * h);
}

}  // namespace

Plant::Event Plant::first_event(const State& next, double h) {
  using Kind = Event::Kind;
  Event first;
  const auto earliest = [&first](const Event& other) {
    if (other.kind != Kind::kNone && (first.kind == Kind::kNone || other.after_s < first.after_s)) first = other;
  };
  StepEnd end{.state = next, .slope = {}, .balance = {}};
  if (direction_ == 0) {
    const double net = derivative(time_s_ + h, next, end.slope, end.balance);
    const int sign = net > level_nm(1, 0) ? 1 : net < -level_nm(-1, 0) ? -1 : 0;
    if (sign != 0) earliest({.kind = Kind::kBreakaway, .after_s = breakaway_after(h, sign), .sign = sign});
  } else {
    if (turns_at_rest_) {
      const double after_s = rest_after(next, h);
      if (after_s <= h) earliest({.kind = Kind::kRest, .after_s = after_s});
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (parts_[p].bends() &&
          parts_[p].effect->left_to_bend_rad(instant(time_s_ + h, next, parts_[p]), direction_) < 0) {
        earliest({.kind = Kind::kSlip, .after_s = slip_after(next, h, parts_[p]), .sign = direction_, .part = p});
      }
    }
    if (divided_) derivative(time_s_ + h, next, end.slope, end.balance);
  }
  for (std::size_t p = 0; divided_ && p < parts_.size(); ++p) {
    if (!parts_[p].traits.divided) continue;
    for (const int way : {-1, 1}) earliest(leaves_region(end, h, p, way));
  }
  return first;
}

double Plant::left_in_region(double time_s, const State& x, const Part& part, int way) const {
  StepEnd at{.state = x, .slope = {}, .balance = {}};
  derivative(time_s, x, at.slope, at.balance);
  return left_in_region(time_s, at, part, way);
}

double Plant::left_in_region(double time_s, const StepEnd& at, const Part& part, int way) const {
  return part.effect->left_in_region(instant(time_s, at.state, part), &at.state[part.first_state], at.balance,
                                     at.slope[1], way);
}

/// When a step of `h` leaves a part's region, on the Hermite cubics of all states.
Plant::Event Plant::leaves_region(const StepEnd& end, double h, std::size_t part, int way) const {
  const double left_at_end = left_in_region(time_s_ + h, end, parts_[part], way);
  if (std::isinf(left_at_end)) return {};  // nothing lies on that side
  const bool turns = state_[1] * end.state[1] < 0 || states_ > 2;
  if (!(left_at_end < 0) && !turns) return {};
  std::array<Cubic, kMaxStates> course;
  for (std::size_t i = 0; i < states_; ++i) {
    course[i] = Cubic::hermite(state_[i], slope_[i], end.state[i], end.slope[i], h);
  }
  const auto left = [&](double s) {
    State x;
    for (std::size_t i = 0; i < states_; ++i) x[i] = course[i].at(s);
    return left_in_region(time_s_ + s, x, parts_[part], way);
  };
  const double hi = left_at_end < 0 ? h : h / 2;  // or there and back within the step
  const double left_at_hi = left_at_end < 0 ? left_at_end : left(hi);
  if (!(left_at_hi < 0)) return {};
  Event event{.kind = Event::Kind::kRegion, .after_s = 0, .sign = way, .part = part};
  double lo = 0;
  double left_at_lo = left_in_region(time_s_, state_, parts_[part], way);
  if (left_at_lo <= 0) {  // starts on the border: look for where it had left it inwards
    for (lo = hi / 2; (left_at_lo = left(lo)) <= 0; lo /= 2) {
      if (lo < 1e-6 * h) return event;
    }
  }
  event.after_s = upper_root([&](double s) { return -left(s); }, lo, -left_at_lo, hi, -left_at_hi, 1e-6 * h);
  const double beside_s = 1e-3 * h;
  event.left_per_s = (left(event.after_s + beside_s) - left(event.after_s - beside_s)) / (2 * beside_s);
  return event;
}

/// When a step of `h` to `next` brings the wheel to rest, if only to go on: where its deceleration at the beginning
/// would do that. Infinite if it does not. slope_ holds the present derivative.
double Plant::rest_after(const State& next, double h) const {
  if (direction_ * next[1] >= 0 && direction_ * (state_[1] + h * slope_[1]) >= 0) return kNever_s;
  State end_slope;
  derivative(time_s_ + h, next, end_slope);
  return crossing_after(direction_ * state_[1], direction_ * slope_[1], direction_ * next[1], direction_ * end_slope[1],
                        h);
}

double Plant::breakaway_after(double h, int sign) {
  State x = state_;
  State slope;
  const double level = level_nm(sign, 0);
  const auto excess = [&](double s) {
    runge_kutta(s, x);
    return sign * derivative(time_s_ + s, x, slope) - level;
  };
  const double now = excess(0);
  return now > 0 ? 0 : upper_root(excess, 0, now, h, excess(h), 1e-10 * h);
}

/// When something that bends at the beginning of a step slips, being bent too far at its end.
double Plant::slip_after(const State& next, double h, const Part& part) const {
  const Cubic angle_rad = Cubic::hermite(state_[0], state_[1], next[0], next[1], h);
  const auto beyond_rad = [&](double s) {
    const State x{angle_rad.at(s), angle_rad.slope(s)};
    return -part.effect->left_to_bend_rad(instant(time_s_ + s, x, part), direction_);
  };
  return upper_root(beyond_rad, 0, beyond_rad(0), h, beyond_rad(h), 1e-6 * h);
}

/// What is bent as far as it goes, and moved on.
void Plant::begin_to_slip() {
  for (Part& part : parts_) {
    if (!part.bends() || direction_ == 0) continue;
    if (part.effect->left_to_bend_rad(instant(time_s_, state_, part), direction_) <= 0) part.slips = direction_;
  }
}

/// Goes over into the next law of a part or the one before.
void Plant::enter_region(Part& part, int change) {
  part.region += change;
  state_[1] = part.effect->enter_region(instant(time_s_, state_, part), &state_[part.first_state]);
  if (!turns_at_rest_) return;
  const int direction = (state_[1] > 0) - (state_[1] < 0);
  if (direction == direction_) return;
  for (Part& one : parts_) one.slips = 0;
  direction_ = direction;
  if (direction == 0) choose_direction();
}

/// Ends the step at the event. The Hermite cubic that found it is not quite the integrated state: one Newton step on
/// the latter, so short that a straight line carries the state over it.
void Plant::take(const Event& event) {
  using Kind = Event::Kind;
  State next = state_;
  double after_s = event.after_s;
  if (after_s > 0) {
    runge_kutta(after_s, next);
    if (event.kind == Kind::kRest || event.kind == Kind::kRegion) {
      State slope;
      derivative(time_s_ + after_s, next, slope);
      const double residual =
          event.kind == Kind::kRest ? next[1] : left_in_region(time_s_ + after_s, next, parts_[event.part], event.sign);
      const double rate = event.kind == Kind::kRest ? slope[1] : event.left_per_s;
      const double shift = rate != 0 ? std::clamp(-residual / rate, -after_s, after_s) : 0;
      for (std::size_t i = 0; i < states_; ++i) next[i] += shift * slope[i];
      after_s += shift;
    }
  }
  if (event.kind == Kind::kSlip) {
    parts_[event.part].slips = event.sign;
  } else if (event.kind != Kind::kRegion) {
    next[1] = 0;
  }
  accept(next, time_s_ + after_s);
  if (event.kind == Kind::kRest) {
    for (Part& part : parts_) part.slips = 0;
    choose_direction();
  }
  if (event.kind == Kind::kBreakaway) direction_ = event.sign;
  if (event.kind == Kind::kRegion) enter_region(parts_[event.part], event.sign);
}

}  // namespace steerid
