// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Pieces over which the plant is nearly linear, in exact steps of its linear part.
//
// While bristles bend (effects/dry_friction.hpp) a wheel that sticks swings on them at up to 100 Hz, and the method of
// Runge and Kutta would need ten steps a sample to follow; and so it would where a wheel sweeps over a ripple. All that
// is not linear is a torque in time, known at four instants of a piece from where the exact steps lead to under it, and
// again until that moves the wheel no more (an exponential integrator; Hochbruck and Ostermann, Acta Numerica 19,
// 2010). A piece begins from how that torque went on in the last one, which is off by so little that most take two
// walks. Three things are asked of each: that every walk leaves a tenth of the change before it at most, so that the
// last change tells the error; that the cubic is what is met between the instants, too; and that the wheel has not left
// where the directions and regions that a piece freezes hold. Where one fails, the piece is integrated step by step.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "plant/plant.hpp"

namespace steerid {

/// Whether every friction bends that far, at any of those rates.
bool Plant::all_bend(const Reach& reach) const {
  return std::ranges::all_of(parts_, [&](const Part& part) {
    if (!part.traits.bends()) return true;
    State high{reach.highest_rad, reach.fastest_rad_s()};
    State low{reach.lowest_rad, -reach.fastest_rad_s()};
    return part.slips == 0 && part.effect->left_to_bend_rad(instant(time_s_, high, part), 1) > 0 &&
           part.effect->left_to_bend_rad(instant(time_s_, low, part), -1) > 0;
  });
}

/// Whether the wheel neither came to rest where that matters, if only within a step, nor met where another law begins.
bool Plant::moves_on(const Reach& reach) const {
  const double slowest_rad_s = direction_ > 0 ? -reach.backward_rad_s : -reach.forward_rad_s;
  if (turns_at_rest_ && !(slowest_rad_s > reach.change_rad_s)) return false;
  const State high{reach.highest_rad, state_[1]};
  const State low{reach.lowest_rad, state_[1]};
  return std::ranges::all_of(parts_, [&](const Part& part) {
    return !part.traits.divided ||
           (left_in_region(time_s_, high, part, 1) > 0 && left_in_region(time_s_, low, part, -1) > 0);
  });
}

/// What acts on the linear part of a plant at a state.
double Plant::push_at(double time_s, const LinearState& x, double stiffness_nm_per_rad) const {
  State dx;
  derivative(time_s, {x[0], x[1]}, dx);
  return wheel_.inertia_kgm2 * dx[1] + wheel_.damping_nms_per_rad * x[1] + stiffness_nm_per_rad * x[0];
}

/// Walks a piece where not everything is linear, with the torque that is met on the way, begun from how it went on in
/// the last piece; false where the wheel does not stay where `stays` says, and where a cubic through four instants is
/// not soon found or does not follow.
template <class Stays>
bool Plant::walk_nearly_linear(const PieceStep& by, Thirds& at, Stays stays) {
  constexpr int kMost = 5;
  constexpr double kOff_rad = 1e-5;  // that the torque may be off by for ever: before the last walk, between instants
  constexpr double kShrink = 0.1;    // of that error in each walk; where less, changes do not tell it
  constexpr double kAtLeast_per_s = 10;  // a wheel with hardly a spring goes that far within a tenth of a second
  const double off_nm =
      kOff_rad * std::max(by.stiffness_nm_per_rad, wheel_.inertia_kgm2 * kAtLeast_per_s * kAtLeast_per_s);
  const auto met_nm = [&](double after_s, const LinearState& x) {
    return push_at(piece_start_s_ + after_s, x, by.stiffness_nm_per_rad);
  };
  const auto instant_s = [&](std::size_t k) { return by.span_s * static_cast<double>(k) / kThirds; };

  const Cubic applied = driver_ - motor_;
  const Met last = std::exchange(met_, {});
  const bool goes_on = last.beside == &by;
  Cubic torque = applied + (goes_on ? last.torque : Cubic{.c0 = met_nm(0, at[0]) - applied.c0});
  std::array<double, kThirds + 1> torque_nm{};
  for (std::size_t k = 0; k < at.size(); ++k) torque_nm[k] = torque.at(instant_s(k));
  double change_nm = std::numeric_limits<double>::infinity();
  for (int round = 0; change_nm > off_nm || (round < 2 && !goes_on); ++round) {
    if (round == kMost || !stays(walk(by, torque, at))) return false;
    const double change_before_nm = std::exchange(change_nm, 0);
    for (std::size_t k = 1; k < at.size(); ++k) {
      const double guess_nm = std::exchange(torque_nm[k], met_nm(instant_s(k), at[k]));
      change_nm = std::max(change_nm, std::abs(torque_nm[k] - guess_nm));
    }
    if (!(change_nm <= std::max(kShrink * change_before_nm, kShrink * off_nm))) return false;
    torque = Cubic::through(torque_nm[0], torque_nm[1], torque_nm[2], torque_nm[3], by.span_s);
  }
  if (!stays(walk(by, torque, at))) return false;
  // Halfway to the first of the instants, where a cubic through all four errs most.
  const double half_s = instant_s(1) / 2;
  const Cubic angle_rad = Cubic::hermite(at[0][0], at[0][1], at[1][0], at[1][1], instant_s(1));
  if (!(std::abs(met_nm(half_s, {angle_rad.at(half_s), angle_rad.slope(half_s)}) - torque.at(half_s)) <= off_nm)) {
    return false;
  }
  met_ = {&by, (torque - applied).shifted(by.span_s)};
  return true;
}

/// Goes on by `span_s`, a whole piece; false, and nowhere, where bristles may slip on the way or something jumps.
bool Plant::advance_while_bending(double span_s) {
  Thirds at{};
  std::copy_n(state_.begin(), at[0].size(), at[0].begin());
  if (coming_jump_s() < time_s_ + span_s || !all_bend(Reach(at[0]))) return false;
  if (direction_ == 0) direction_ = 1;  // a wheel on bristles is never held
  prepare(bent_, span_s, steps_while_bending(span_s), bent_stiffness_nm_per_rad_);
  step_middle_s_ = time_s_ + span_s / 2;
  const auto stays = [this](const Reach& reach) { return all_bend(reach); };
  const bool went = linear_plant_ ? stays(walk(bent_, push(span_s), at)) : walk_nearly_linear(bent_, at, stays);
  if (!went) return false;
  std::copy_n(at.back().begin(), at.back().size(), state_.begin());
  time_s_ += span_s;
  direction_ = (state_[1] > 0) - (state_[1] < 0);
  return true;
}

/// The same where nothing bends and not all is linear; false where the wheel may come to rest or meet an edge, too, and
/// where the torques depend so much on where they lead that a piece is too long.
bool Plant::advance_while_moving(double span_s) {
  if (states_ > 2 || direction_ == 0 || coming_jump_s() < time_s_ + span_s) return false;
  if (std::ranges::any_of(parts_, &Part::bends)) return false;
  prepare(moving_, span_s, kThirds, wheel_.stiffness_nm_per_rad);
  step_middle_s_ = time_s_ + span_s / 2;
  Thirds at{};
  std::copy_n(state_.begin(), states_, at[0].begin());
  if (!walk_nearly_linear(moving_, at, [this](const Reach& reach) { return moves_on(reach); })) return false;
  State next;
  std::copy_n(at.back().begin(), states_, next.begin());
  accept(next, time_s_ + span_s);
  return true;
}

}  // namespace steerid
