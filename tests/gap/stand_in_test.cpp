// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What stands in for an unknown effect: free runs of hand-made candidates on a wheel whose damping grows with its
// angle.
#include "gap/diagnosis/stand_in.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "gap/drawn_drive.hpp"
#include "gap/model/compared_parts.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// A wheel whose spring hardens with the fifth power of the angle, and what it is compared with: the closest linear
/// wheel, and effects beside that.
class HardeningWheel {
 public:
  HardeningWheel() {
    simulation_.wheel = drive_.wheel;
    compare_at("parameters", nullptr, joined(prepared_.closest, {}));
  }

  void compare_with(const WheelArm& wheel, const Effect& effect) {
    compare_at(std::string(effect.type->id), effect.type, joined(wheel, {effect}));
  }
  [[nodiscard]] const WheelArm& closest() const { return prepared_.closest; }
  [[nodiscard]] const WheelArm& at_rest() const { return drive_.wheel; }  ///< its spring does not harden there

  [[nodiscard]] std::string stand_in(const std::string& most_probable) const {
    return steerid::stand_in(prepared_, simulation_, comparison_, most_probable);
  }

 private:
  void compare_at(std::string id, const EffectType* type, Eigen::VectorXd x) {
    Candidate& one = comparison_.candidates.emplace_back();
    one.id = std::move(id);
    one.type = type;
    one.fit.x = std::move(x);
  }

  test::DrawnDrive drive_ = [] {
    test::DrawnDrive what;
    what.torque = [](double, double x, double) { return -20 * x * std::pow(x / 0.1, 4); };
    return what;
  }();
  Simulation simulation_;
  PreparedRecord prepared_{test::drive(drive_, test::seed(48)), test::off_by_five_percent(drive_.wheel), {}};
  Comparison comparison_;
};

Effect spring(double cubic_nm_per_rad3) {
  Effect effect(effect::cubic_stiffness);
  effect.values[0] = cubic_nm_per_rad3;
  return effect;
}

Effect friction(double friction_nm) {
  Effect effect(effect::coulomb_friction);
  effect.values[0] = friction_nm;
  return effect;
}

TEST(StandIn, IsWhatRunsNearestAndNotWhatIsMostProbable) {
  HardeningWheel wheel;
  wheel.compare_with(wheel.closest(), friction(1.0));
  wheel.compare_with(wheel.at_rest(), spring(1200));
  EXPECT_EQ(wheel.stand_in("coulomb_friction"), "cubic_stiffness");
}

TEST(StandIn, IsNothingWhereNothingRunsNearer) {
  HardeningWheel wheel;
  wheel.compare_with(wheel.closest(), friction(1.0));
  wheel.compare_with(wheel.closest(), spring(-300));
  EXPECT_EQ(wheel.stand_in("coulomb_friction"), "");
}

TEST(StandIn, IsNothingWhereWhatRunsNearerDoesSoByLessThanATenth) {
  HardeningWheel wheel;
  wheel.compare_with(wheel.closest(), spring(10));
  EXPECT_EQ(wheel.stand_in("cubic_stiffness"), "");
}

TEST(StandIn, IsTheTorqueThatNobodyMeasuredWhereThatIsMostProbable) {
  HardeningWheel wheel;
  wheel.compare_with(wheel.at_rest(), spring(1200));
  EXPECT_EQ(wheel.stand_in("unmeasured_torque"), "unmeasured_torque");
}

}  // namespace
}  // namespace steerid
