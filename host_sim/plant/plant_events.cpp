// Where a step of the plant is cut short: rest, breakaway and the edges of play, found and set exactly.
#include <algorithm>

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
  return upper_root([&](double s) { return -y.at(s); }, lo, -y.at(lo), h, -y1, 1e-6 * h);
}

}  // namespace

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
    runge_kutta(s, x);
    return sign * derivative(time_s_ + s, x, slope) - level;
  };
  const double now = excess(0);
  return now > 0 ? 0 : upper_root(excess, 0, now, h, excess(h), 1e-10 * h);
}

/// Ends the step at the event. The Hermite cubic that found it is not quite the integrated state: one Newton step on
/// the latter, so short that a straight line carries the state over it.
void Plant::take(const Event& event) {
  using Kind = Event::Kind;
  State next = state_;
  double after_s = event.after_s;
  if (after_s > 0) {
    runge_kutta(after_s, next);
    if (event.kind != Kind::kBreakaway) {
      State slope;
      derivative(time_s_ + after_s, next, slope);
      const double residual = event.kind == Kind::kRest ? next[1] : next[0] - event.edge_rad;
      const double rate = event.kind == Kind::kRest ? slope[1] : slope[0];
      const double shift = rate != 0 ? std::clamp(-residual / rate, -after_s, after_s) : 0;
      for (std::size_t i = 0; i < states_; ++i) next[i] += shift * slope[i];
      after_s += shift;
    }
  }
  if (event.kind == Kind::kEdge) {
    next[0] = event.edge_rad;
    parts_[event.part].region += event.sign;
  } else {
    next[1] = 0;
  }
  accept(next, time_s_ + after_s);
  if (event.kind == Kind::kRest) choose_direction();
  if (event.kind == Kind::kBreakaway) direction_ = event.sign;
}

}  // namespace steerid
