// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction of any level: ideal, or with bristles.
//
// Ideal friction holds the wheel where it rests: the plant integrates it as a set (plant/plant.hpp). Real surfaces bend
// a little before they slip. With `bristle_rad` > 0 the torque is that of a spring that follows the wheel over so many
// radians and then slips at the level of the present speed (a play operator: Prandtl 1928; as the elastic limit of
// Dahl's model in Dupont et al., IEEE TAC 47 (2002)):
//   bend = bend at the last step + turned since, no more than level/k either way;  torque = -k bend
//   k = largest level at rest / bristle_rad
// It is a spring until it slips, and slips until the wheel turns round; the plant ends a step at both. So the bend is a
// function of the angle: no state has to be integrated. It is 0 at the start of a run, since the record before it is
// unknown. Bristles on which the wheel would swing faster than 100 Hz are as good as none to a sensor of that rate, and
// count as none.
#pragma once

#include <algorithm>
#include <memory>
#include <numbers>

#include "plant/effects/effect.hpp"

namespace steerid::effect {

/// The parameter that every dry friction has: below what an angle sensor shows, and of a tenth of a degree at most.
inline constexpr Parameter kBristle{"bristle_rad", 0, 0, 0.002, 1e-4, "angle that it bends before it slips; 0: none"};

class DryFriction : public PlantEffect {
 public:
  /// `breakaway_nm`: the largest level at rest. `added_damping_nms_per_rad`: the steepest fall of a level with speed.
  DryFriction(double breakaway_nm, double bristle_rad, const RunSetting& setting, double added_damping_nms_per_rad = 0)
      : added_damping_nms_per_rad_(added_damping_nms_per_rad) {
    constexpr double kFastest_rad_s = 2 * std::numbers::pi * 100;
    const double stiffest = setting.wheel.inertia_kgm2 * kFastest_rad_s * kFastest_rad_s;
    if (breakaway_nm < stiffest * bristle_rad) stiffness_nm_per_rad_ = breakaway_nm / bristle_rad;
  }

  [[nodiscard]] PlantTraits traits() const final {
    const bool bends = stiffness_nm_per_rad_ > 0;
    return {.acts = bends,
            .dry = !bends,
            .turns_at_rest = true,
            .remembers = bends,
            .bending_stiffness_nm_per_rad = stiffness_nm_per_rad_,
            .slips_steadily = added_damping_nms_per_rad_ == 0,
            // They take part for a few ms around a reversal only: half the stiffness will do
            // (tests/unit/plant_convergence_test.cpp).
            .passing_stiffness_nm_per_rad = stiffness_nm_per_rad_ / 2,
            .added_damping_nms_per_rad = added_damping_nms_per_rad_};
  }
  void start(const Instant& now, double*) final {
    bend_rad_ = 0;
    angle_rad_ = now.angle_rad;
  }
  void act(const Instant& now, const double*, double*, Balance& balance) const final {
    balance.torque_nm -= now.slips == 0 ? stiffness_nm_per_rad_ * bend_at(now) : now.slips * level_nm(now, now.slips);
  }
  [[nodiscard]] double left_to_bend_rad(const Instant& now, int way) const final {
    return level_nm(now, way) / stiffness_nm_per_rad_ - way * bend_at(now);
  }
  /// While it slips it is only as stiff as its level changes with speed.
  [[nodiscard]] bool engaged(const Instant& now, const double*) const final { return now.slips == 0; }
  void remember(const Instant& now) final {
    bend_rad_ = now.slips == 0 ? bend_at(now) : now.slips * level_nm(now, now.slips) / stiffness_nm_per_rad_;
    angle_rad_ = now.angle_rad;
  }

 private:
  [[nodiscard]] double bend_at(const Instant& now) const { return bend_rad_ + now.angle_rad - angle_rad_; }

  [[nodiscard]] double level_nm(const Instant& now, int way) const {
    return dry_friction_nm(way, std::max(0.0, way * now.rate_rad_s));
  }

  double stiffness_nm_per_rad_ = 0;  // 0: ideal
  double added_damping_nms_per_rad_;
  double bend_rad_ = 0;
  double angle_rad_ = 0;
};

/// Builds the factory of a kind of dry friction.
template <class Class>
std::unique_ptr<PlantEffect> dry_friction(std::span<const double> values, std::span<const double> /*time_course_nm*/,
                                          const RunSetting& setting) {
  return std::make_unique<Class>(values, setting);
}

}  // namespace steerid::effect
