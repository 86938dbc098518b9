// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Pieces over which the plant is linear, in exact steps (plant/linear_response.hpp).
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
  of = {span_s, count, stiffness_nm_per_rad, linear_step(span_s / count, stiffness_nm_per_rad)};
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

/// What the effects of some traits add in a piece with the wheel at angle 0.
Cubic Plant::torque_at_zero(double span_s, bool (*of)(const PlantTraits&)) const {
  const auto effects_nm = [&](int third) {
    Balance balance{};
    double none = 0;
    for (const Part& part : parts_) {
      if (!of(part.traits)) continue;
      part.effect->act(instant(piece_start_s_ + span_s * third / kThirds, {}, part), &none, &none, balance);
    }
    return balance.torque_nm;
  };
  return Cubic::through(effects_nm(0), effects_nm(1), effects_nm(2), effects_nm(3), span_s);
}

/// What acts in a piece whatever the wheel does, beside the applied torques.
Cubic Plant::torque_in_time(double span_s) const {
  return in_time_ ? torque_at_zero(span_s, [](const PlantTraits& traits) { return traits.in_time_only; }) : Cubic{};
}

/// What acts on a linear plant whatever it does: the torques in time, and the springs of bent bristles as far as they
/// are at angle 0.
Cubic Plant::push(double span_s) const {
  const Cubic applied = driver_ - motor_;
  return bends_ ? applied + torque_at_zero(span_s, [](const PlantTraits& traits) { return traits.bends(); }) : applied;
}

Plant::Reach::Reach(const LinearState& from)
    : highest_rad(from[0]), lowest_rad(from[0]), forward_rad_s(from[1]), backward_rad_s(-from[1]) {}

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
  forward_rad_s = std::max(forward_rad_s, to[1]);
  backward_rad_s = std::max(backward_rad_s, -to[1]);
  change_rad_s = std::max(change_rad_s, std::abs(to[1] - from[1]));
}

/// Walks a piece in exact steps.
Plant::Reach Plant::walk(const PieceStep& by, Cubic torque, Thirds& at) const {
  const double h = by.span_s / by.count;
  LinearState x = at[0];
  Reach reach(x);
  for (int i = 0; i < by.count; ++i) {
    const LinearState from = x;
    take_step(*by.step, torque, x);
    reach.include(from, h, x);
    torque = torque.shifted(h);
    if ((i + 1) * kThirds % by.count == 0) at[static_cast<std::size_t>((i + 1) * kThirds / by.count)] = x;
  }
  return reach;
}

void Plant::advance_linearly(double span_s) {
  prepare(free_, span_s, 1, wheel_.stiffness_nm_per_rad);
  take_step(*free_.step, push(span_s), state_);
  time_s_ += span_s;
}

/// Goes on by `span_s`, a whole piece over which what can bend slips; false, and nowhere, where the wheel may come to
/// rest.
bool Plant::advance_while_slipping(double span_s) {
  if (!slips_steadily_ || std::ranges::any_of(parts_, &Part::bends)) return false;
  prepare(free_, span_s, 1, wheel_.stiffness_nm_per_rad);
  derivative(time_s_, state_, slope_);
  State next = state_;
  take_step(*free_.step, push(span_s), next);
  if (rest_after(next, span_s) <= span_s) return false;
  accept(next, time_s_ + span_s);
  return true;
}

}  // namespace steerid
