// Pieces over which the plant is linear, in exact steps; and those over which it is nearly so, because bent bristles
// are by far the stiffest spring in it.
//
// While bristles bend (effects/dry_friction.hpp) a wheel that sticks swings on them at up to 100 Hz, and the method of
// Runge and Kutta would need ten steps a sample to follow. There all that is not linear hardly changes: it is a torque
// in time, known at four instants of a piece from where the exact steps lead to under it, and again until that moves
// the wheel no more (an exponential integrator; Hochbruck and Ostermann, Acta Numerica 19, 2010).
#include <algorithm>
#include <cmath>
#include <utility>

#include "plant/plant.hpp"

namespace steerid {

/// Where the effects have states of their own the matrices are read off derivative(), column by column.
LinearStep Plant::linear_step(double span_s, double stiffness_nm_per_rad) {
  if (states_ == 2) return {{wheel_.inertia_kgm2, wheel_.damping_nms_per_rad, stiffness_nm_per_rad}, span_s};
  const auto slope_at = [&](const State& x) {
    State dx{};
    derivative(time_s_, x, dx);
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < states_; ++i) slope[static_cast<Eigen::Index>(i)] = dx[i];
    return slope;
  };
  const Cubic driver = std::exchange(driver_, {});
  const Cubic motor = std::exchange(motor_, {});
  const Eigen::Vector4d rest = slope_at({});
  driver_.c0 = 1;
  const Eigen::Vector4d push = slope_at({}) - rest;
  driver_.c0 = 0;
  Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < states_; ++i) {
    State x{};
    x[i] = 1;
    rate.col(static_cast<Eigen::Index>(i)) = slope_at(x) - rest;
  }
  driver_ = driver;
  motor_ = motor;
  return {rate, push, span_s};
}

void Plant::prepare(PieceStep& of, double span_s, int count, double stiffness_nm_per_rad) {
  if (of.step && std::abs(span_s - of.span_s) <= 1e-9 * span_s) return;
  of.step.emplace(linear_step(span_s / count, stiffness_nm_per_rad));
  of.span_s = span_s;
}

template <class X>
void Plant::take_step(const LinearStep& step, const Cubic& torque, X& x) const {
  const auto& e = step.transition;
  const auto& g = step.input;
  const LinearState from{x[0], x[1], x[2], x[3]};
  for (std::size_t i = 0; i < states_; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double next = e(row, 0) * from[0] + e(row, 1) * from[1];
    for (std::size_t j = 2; j < states_; ++j) next += e(row, static_cast<Eigen::Index>(j)) * from[j];
    x[i] = next + g(row, 0) * torque.c0 + g(row, 1) * torque.c1 + g(row, 2) * torque.c2 + g(row, 3) * torque.c3;
  }
}

/// What acts on a linear plant whatever it does: the applied torques, those of the time alone, and the springs of bent
/// bristles as far as they are at angle 0.
Cubic Plant::push(double span_s) const {
  const Cubic applied = driver_ - motor_;
  if (!pushes_) return applied;
  const auto effects_nm = [&](int third) {
    Balance balance{};
    double none = 0;
    for (const Part& part : parts_) {
      if (!part.traits.in_time_only && !part.traits.bends()) continue;
      part.effect->act(instant(piece_start_s_ + span_s * third / kThirds, {}, part), &none, &none, balance);
    }
    return balance.torque_nm;
  };
  return applied + Cubic::through(effects_nm(0), effects_nm(1), effects_nm(2), effects_nm(3), span_s);
}

/// What acts on the linear part of a plant at a state.
double Plant::push_at(double time_s, const LinearState& x) const {
  State dx;
  derivative(time_s, {x[0], x[1]}, dx);
  return wheel_.inertia_kgm2 * dx[1] + wheel_.damping_nms_per_rad * x[1] + bent_stiffness_nm_per_rad_ * x[0];
}

/// How far a wheel may have gone on its way from one state to another, less than half a swing later: where it turns
/// round, no farther than its rate at either end carries it.
void Plant::Reach::include(const LinearState& from, double h, const LinearState& to) {
  const auto farthest = [&](int way) {
    const double beyond = std::max(way * from[0], way * to[0]);
    const bool turns = way * from[1] > 0 && way * to[1] < 0;
    return turns ? std::max(beyond, std::min(way * (from[0] + from[1] * h), way * (to[0] - to[1] * h))) : beyond;
  };
  highest_rad = std::max(highest_rad, farthest(1));
  lowest_rad = std::min(lowest_rad, -farthest(-1));
  fastest_rad_s = std::max({fastest_rad_s, std::abs(from[1]), std::abs(to[1])});
}

/// Whether every friction bends that far, at any of those rates.
bool Plant::all_bend(const Reach& reach) const {
  return std::ranges::all_of(parts_, [&](const Part& part) {
    if (!part.traits.bends()) return true;
    State high{reach.highest_rad, reach.fastest_rad_s};
    State low{reach.lowest_rad, -reach.fastest_rad_s};
    return part.slips == 0 && part.effect->left_to_bend_rad(instant(time_s_, high, part), 1) > 0 &&
           part.effect->left_to_bend_rad(instant(time_s_, low, part), -1) > 0;
  });
}

/// Walks a piece in `count` exact steps; false where bristles may slip on the way.
bool Plant::walk(Cubic torque, double span_s, int count, Thirds& at) const {
  const double h = span_s / count;
  LinearState x = at[0];
  Reach reach{x[0], x[0], 0};
  for (int i = 0; i < count; ++i) {
    const LinearState from = x;
    take_step(*bent_.step, torque, x);
    reach.include(from, h, x);
    torque = torque.shifted(h);
    if ((i + 1) * kThirds % count == 0) at[static_cast<std::size_t>((i + 1) * kThirds / count)] = x;
  }
  return all_bend(reach);
}

/// The same where not everything is linear, with the torque that is met on the way.
bool Plant::walk_nearly_linear(double span_s, int count, Thirds& at) const {
  constexpr int kMost = 4;
  constexpr double kSettled_rad = 1e-6;  // that the bent wheel still moves
  at.fill(at[0]);
  std::array<double, kThirds + 1> torque_nm{push_at(piece_start_s_, at[0])};
  for (int round = 0; round < kMost; ++round) {
    double change_nm = 0;
    for (std::size_t k = 1; k < at.size(); ++k) {
      const double before = torque_nm[k];
      torque_nm[k] = push_at(piece_start_s_ + span_s * static_cast<double>(k) / kThirds, at[k]);
      change_nm = std::max(change_nm, std::abs(torque_nm[k] - before));
    }
    if (round > 0 && change_nm < kSettled_rad * bent_stiffness_nm_per_rad_) return true;
    const Cubic torque = Cubic::through(torque_nm[0], torque_nm[1], torque_nm[2], torque_nm[3], span_s);
    if (!walk(torque, span_s, count, at)) return false;
  }
  return false;
}

void Plant::advance_linearly(double span_s) {
  prepare(free_, span_s, 1, wheel_.stiffness_nm_per_rad);
  take_step(*free_.step, push(span_s), state_);
  time_s_ += span_s;
}

/// Goes on by `span_s`, a whole piece; false, and nowhere, where bristles may slip on the way or something jumps.
bool Plant::advance_while_bending(double span_s) {
  if (coming_jump_s() < time_s_ + span_s || !all_bend({state_[0], state_[0], std::abs(state_[1])})) return false;
  if (direction_ == 0) direction_ = 1;  // a wheel on bristles is never held
  const int count = steps_while_bending(span_s);
  prepare(bent_, span_s, count, bent_stiffness_nm_per_rad_);
  step_middle_s_ = time_s_ + span_s / 2;
  Thirds at{};
  std::copy_n(state_.begin(), at[0].size(), at[0].begin());
  const bool went = linear_plant_ ? walk(push(span_s), span_s, count, at) : walk_nearly_linear(span_s, count, at);
  if (!went) return false;
  std::copy_n(at.back().begin(), at.back().size(), state_.begin());
  time_s_ += span_s;
  direction_ = (state_[1] > 0) - (state_[1] < 0);
  return true;
}

/// The same where they slip all the way; false where the wheel may come to rest.
bool Plant::advance_while_slipping(double span_s) {
  const auto bends = [](const Part& part) { return part.traits.bends() && part.slips == 0; };
  if (!slips_steadily_ || std::ranges::any_of(parts_, bends)) return false;
  prepare(free_, span_s, 1, wheel_.stiffness_nm_per_rad);
  derivative(time_s_, state_, slope_);
  State next = state_;
  take_step(*free_.step, push(span_s), next);
  if (rest_after(next, span_s) <= span_s) return false;
  accept(next, time_s_ + span_s);
  return true;
}

}  // namespace steerid
