// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/pairs/pair_meaning.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/model/compared_parts.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

/// Whether two torques are large only against each other: their sum is no effect of either.
bool undo_each_other(const SpectralRecord& record, const WheelArm& wheel, const Effect& one, const Effect& other) {
  constexpr double kLeft = 0.3;
  const ComparedParts both = compared_parts({one, other});
  if (both.parts.size() < 2 || !both.parts[0]->acts() || !both.parts[1]->acts()) return false;
  const auto torque = [&](std::size_t i) {
    std::vector<double> nm(record.record.size());
    both.parts[i]->torque(wheel, both.present[i].values.data(), record.record, record.motion, nm);
    return nm;
  };
  const std::vector<double> first = torque(0);
  const std::vector<double> second = torque(1);
  double larger = 0;
  double sum = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    larger += std::max(first[i] * first[i], second[i] * second[i]);
    sum += (first[i] + second[i]) * (first[i] + second[i]);
  }
  return sum < kLeft * kLeft * larger;
}

/// Whether a grip stands beside what filters as it does: the two together come close to any other filter, a delay and a
/// grip to a lag.
bool filters_with_a_grip(const EffectType& one, const EffectType& other) {
  const auto filters = [](const EffectType& type) {
    return &type == &effect::delay || &type == &effect::lag || &type == &effect::reflex;
  };
  return (&one == &effect::compliance && filters(other)) || (&other == &effect::compliance && filters(one));
}

/// Whether a drag beside friction is smaller than what the linear damping had to move by to make room for it: together
/// they are the first terms of any friction that changes with rate.
bool bends_friction(const MeasuredMotion& motion, const WheelArm& sim, const WheelArm& found, const Effect& one,
                    const Effect& other) {
  const auto plain = [](const Effect& e) {
    return e.type == &effect::coulomb_friction || e.type == &effect::asymmetric_friction;
  };
  const bool first = one.type == &effect::quadratic_damping;
  const Effect& drag = first ? one : other;
  if (drag.type != &effect::quadratic_damping || !plain(first ? other : one)) return false;
  double dragged = 0;
  double moved = 0;
  for (const double rate : motion.rate_rad_s) {
    dragged += std::pow(drag.values[0] * rate * rate, 2);
    moved += std::pow((found.damping_nms_per_rad - sim.damping_nms_per_rad) * rate, 2);
  }
  return dragged < moved;
}

}  // namespace

bool stand_together(const SpectralRecord& record, const WheelArm& sim, const WheelArm& found, const Effect& one,
                    const Effect& other) {
  return !filters_with_a_grip(*one.type, *other.type) && !bends_friction(record.motion, sim, found, one, other) &&
         !undo_each_other(record, found, one, other);
}

}  // namespace steerid
