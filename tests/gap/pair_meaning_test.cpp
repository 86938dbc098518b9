// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which two effects mean what they say beside each other, on the motion of a drawn drive (gap/drawn_drive.hpp).
#include "gap/pairs/pair_meaning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gap/drawn_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

class PairMeaning : public ::testing::Test {
 protected:
  PairMeaning()
      : record_(test::drive(drive_, test::seed(61))),
        spectral_(record_, drive_.wheel, held_out_split(record_, 100), 100, false) {}

  static Effect with(const EffectType& type, std::string_view name, double value) {
    Effect effect(type);
    effect.at(name) = value;
    return effect;
  }

  /// With a damping that is `moved` from the simulation's; whichever of the two is named first.
  [[nodiscard]] bool together(const Effect& one, const Effect& other, double moved_nms_per_rad = 0) const {
    WheelArm found = drive_.wheel;
    found.damping_nms_per_rad += moved_nms_per_rad;
    const bool first = stand_together(spectral_, drive_.wheel, found, one, other);
    EXPECT_EQ(first, stand_together(spectral_, drive_.wheel, found, other, one));
    return first;
  }

  test::DrawnDrive drive_;
  Record record_;
  SpectralRecord spectral_;
};

TEST_F(PairMeaning, AGripBesideAFilterIsAnyOther) {
  const Effect grip(effect::compliance);
  for (const EffectType* filter : {&effect::delay, &effect::lag, &effect::reflex}) {
    EXPECT_FALSE(together(grip, Effect(*filter))) << filter->id;
  }
  EXPECT_TRUE(together(grip, Effect(effect::coulomb_friction)));
  EXPECT_TRUE(together(Effect(effect::delay), Effect(effect::reflex)));
}

TEST_F(PairMeaning, ADragHasToBeLargerThanWhatTheDampingMovedBy) {
  const Effect friction = with(effect::coulomb_friction, "friction_nm", 0.3);
  // B2 v^2 against dB v over the record: equal, rms, at B2 = dB sqrt(mean v^2 / mean v^4).
  double second = 0;
  double fourth = 0;
  for (const double rate : spectral_.motion.rate_rad_s) {
    second += rate * rate;
    fourth += std::pow(rate, 4);
  }
  const double moved = -0.2;
  const double equal = std::abs(moved) * std::sqrt(second / fourth);
  const auto drag = [](double size) {
    return with(effect::quadratic_damping, "quadratic_damping_nms2_per_rad2", size);
  };
  EXPECT_TRUE(together(friction, drag(1.05 * equal), moved));
  EXPECT_FALSE(together(friction, drag(0.95 * equal), moved));
  EXPECT_TRUE(together(friction, drag(0.95 * equal), 0.9 * moved));
  // Stribeck's friction bends by itself.
  EXPECT_TRUE(together(Effect(effect::stribeck_friction), drag(0.5 * equal), moved));
}

TEST_F(PairMeaning, TorquesThatUndoEachOtherAreNeither) {
  const auto bias = [](double nm) { return with(effect::torque_bias, "bias_nm", nm); };
  EXPECT_FALSE(together(bias(1), bias(-0.72)));  // three tenths of the larger one are left
  EXPECT_TRUE(together(bias(1), bias(-0.68)));
  EXPECT_TRUE(together(bias(1), with(effect::cubic_stiffness, "cubic_stiffness_nm_per_rad3", -5)));
}

}  // namespace
}  // namespace steerid
