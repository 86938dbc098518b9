// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the blind generator draws: contents in the promised numbers, cases that keep to their labels.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "blind/case_files.hpp"
#include "blind/catalogue.hpp"
#include "blind/drawn_case.hpp"
#include "blind/linear_refit.hpp"
#include "blind/slow_torque.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::blind {
namespace {

/// |found/true - 1| of J, B and C.
std::array<double, 3> off(const Arm& found, const Arm& truth) {
  return {std::abs(found.inertia_kgm2 / truth.inertia_kgm2 - 1),
          std::abs(found.damping_nms_per_rad / truth.damping_nms_per_rad - 1),
          std::abs(found.stiffness_nm_per_rad / truth.stiffness_nm_per_rad - 1)};
}

TEST(BlindDrawing, ADeckHoldsEveryEffectAsOftenAsPromised) {
  const std::size_t deck = 4 + 4 + 2 * vocabulary().size() + outside().size();
  std::map<std::string, int> count;
  for (const Contents& contents : draw_contents(2 * deck, test::seed(5))) ++count[contents.front().id];
  EXPECT_EQ(vocabulary().size(), effects().size()) << "each effect of the plant is drawn, and none that it lacks";
  EXPECT_GE(outside().size(), 10U);
  for (const Kind* kind : vocabulary()) EXPECT_EQ(count[std::string(kind->id)], 4) << kind->id;
  for (const Kind* kind : outside()) EXPECT_EQ(count[std::string(kind->id)], 2) << kind->id;
  EXPECT_EQ(count["none"], 8);
  EXPECT_EQ(count["parameters"], 8);
}

TEST(BlindDrawing, AnotherSeedGivesAnotherOrder) {
  EXPECT_EQ(draw_contents(40, 1), draw_contents(40, 1));
  EXPECT_NE(draw_contents(40, 1), draw_contents(40, 2));
}

TEST(BlindDrawing, PairsAreOfTwoFamilies) {
  const auto family = [](const std::string& id) {
    int number = 0;
    for (const auto kinds : {friction_kinds(), joint_kinds(), torque_kinds(), record_kinds()}) {
      for (const Kind& kind : kinds) {
        if (kind.id == id) return number;
      }
      ++number;
    }
    return -1;
  };
  for (const Contents& pair : draw_pairs(200, test::seed(6))) {
    ASSERT_EQ(pair.size(), 2U);
    // A sensor's errors come last: they are on whatever it measures.
    EXPECT_LT(family(pair[0].id), family(pair[1].id)) << pair[0].id << " " << pair[1].id;
  }
}

TEST(BlindDrawing, NoPairIsOneEffectByDefinition) {
  // F+ sliding forward and F- sliding back, both shifted by an offset, are F+ and F- of asymmetric friction.
  std::size_t of_friction = 0;
  for (const Contents& pair : draw_pairs(2000, test::seed(11))) {
    if (pair[1].id != "torque_bias") continue;
    EXPECT_NE(pair[0].id, "coulomb_friction");
    EXPECT_NE(pair[0].id, "asymmetric_friction");
    of_friction += pair[0].id == "stribeck_friction" || pair[0].id == "presliding_hysteresis" ? 1 : 0;
  }
  EXPECT_GT(of_friction, 0U);  // the other kinds are pairs
}

TEST(BlindDrawing, ADeckOfSeveralHoldsEveryKindOfChange) {
  std::map<std::string, int> count;
  for (const Contents& contents : draw_several(40, test::seed(12))) {
    EXPECT_LE(contents.size(), 4U);
    ++count[several_case(contents)];
  }
  const std::map<std::string, int> wanted = {
      {"exact", 6},    {"resized", 6},   {"superfluous", 4}, {"1 missing beside 1", 6}, {"1 missing beside 2", 2},
      {"mixed", 2},    {"2 missing", 2}, {"3 missing", 4},   {"2 missing beside 1", 4}, {"3 missing beside 1", 2},
      {"4 missing", 2}};
  EXPECT_EQ(count, wanted);
}

TEST(BlindDrawing, WhatHasToChangeStaysTheAnswerBesideARemainder) {
  const std::vector<Contents> plain = draw_several(20, test::seed(14));
  const std::vector<Contents> all = with_remainders(plain, test::seed(14));
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(several_case(all[i]), several_case(plain[i]));
    const bool exact = several_case(plain[i]) == "exact";
    ASSERT_EQ(all[i].size(), plain[i].size() + (exact ? 0 : 1));
    EXPECT_EQ(is_known(all[i].back().id), exact) << all[i].back().id;
  }
  for (const char* alone : {"none", "parameters", "end_stop"}) {
    const Contents contents = {alone};
    EXPECT_EQ(with_remainders({contents}, test::seed(14))[0], contents);
  }
}

TEST(BlindDrawing, ARemainderIsDrawnBesideWhatHasToChange) {
  const DrawnCase alone = draw_case({"delay"}, test::seed(15));
  const DrawnCase drawn = draw_case({"delay", "fractional_damping"}, test::seed(15));
  EXPECT_EQ(drawn.label, "delay");
  EXPECT_EQ(alone.effects.size(), 1U);
  ASSERT_EQ(drawn.effects.size(), 2U);
  EXPECT_EQ(drawn.effects[1].id, "fractional_damping");
  EXPECT_TRUE(drawn.simulated.empty());
}

TEST(BlindDrawing, ASimulationHasWhatItsContentsSay) {
  const Contents contents = {{"coulomb_friction", Simulated::kResized}, {"delay", Simulated::kNot}};
  const DrawnCase drawn = draw_case(contents, test::seed(13));
  ASSERT_EQ(drawn.effects.size(), 2U);
  ASSERT_EQ(drawn.simulated.size(), 1U);
  const double factor = drawn.simulated[0].numbers["friction_nm"] / drawn.effects[0].numbers["friction_nm"];
  EXPECT_TRUE((factor >= 0.4 && factor <= 0.65) || (factor >= 1.5 && factor <= 2.5)) << factor;
  EXPECT_GE(drawn.gap_over_floor, 1.5);  // each of two changes has as much
  EXPECT_EQ(drawn.label, "coulomb_friction");
}

TEST(BlindDrawing, TheSimulationOfNoneIsExactAndReachesTheFloor) {
  const DrawnCase drawn = draw_case({"none"}, test::seed(7));
  EXPECT_EQ(off(drawn.simulation, drawn.arm), (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(drawn.gap_over_floor, 1);
  EXPECT_EQ(drawn.label, "none");
  EXPECT_TRUE(drawn.effects.empty());
  // 60 s or more of a bounded drive tell C to a few percent whatever the slow torque.
  EXPECT_LT(off(drawn.linear_fit, drawn.arm)[2], 0.1);
}

TEST(BlindDrawing, TheSimulationOfParametersIsFarOff) {
  const DrawnCase drawn = draw_case({"parameters"}, test::seed(8));
  for (const double share : off(drawn.simulation, drawn.arm)) {
    EXPECT_GE(share, 0.2 - 1e-12);
    EXPECT_LE(share, 0.6 + 1e-12);
  }
  EXPECT_EQ(drawn.gap_over_floor, 1);
}

TEST(BlindDrawing, AnEffectStandsAboveTheFloorAsDrawn) {
  const std::uint64_t seed = test::seed(9);
  for (const char* id : {"coulomb_friction", "end_stop"}) {
    const DrawnCase drawn = draw_case({id}, seed);
    EXPECT_EQ(drawn.label, is_known(id) ? id : "unknown");
    ASSERT_EQ(drawn.effects.size(), 1U);
    EXPECT_EQ(drawn.effects[0].id, id);
    EXPECT_GT(drawn.gap_over_floor, 1.3);  // 1.5 within the twelfth that the search allows
    EXPECT_LT(drawn.gap_over_floor, 38);
    EXPECT_NEAR(drawn.refit_nrmse / drawn.floor_nrmse, drawn.gap_over_floor, 1e-9 * drawn.gap_over_floor);
    for (const double share : off(drawn.simulation, drawn.arm)) EXPECT_LE(share, 0.08);
    EXPECT_NEAR(refit(drawn.record, drawn.simulation).nrmse, drawn.refit_nrmse, 1e-4 * drawn.refit_nrmse);
  }
}

TEST(BlindDrawing, TheSameSeedGivesTheSameBits) {
  const std::uint64_t seed = test::seed(10);
  const DrawnCase one = draw_case({"reflex"}, seed);
  const DrawnCase other = draw_case({"reflex"}, seed);
  EXPECT_EQ(one.record.angle_rad, other.record.angle_rad);
  EXPECT_EQ(one.record.torque_motor_nm, other.record.torque_motor_nm);
  EXPECT_NE(case_seed(seed, 0), case_seed(seed, 1));
}

TEST(BlindDrawing, SlowTorqueIsSlowAndAsStrongAsAsked) {
  const Signal torque = slow_torque(0.3, 0, 100, test::seed(11));
  EXPECT_NEAR(torque.rms(), 0.3, 1e-12);
  // Nothing above 1 Hz: steps of 10 ms are small against the torque, (2 pi 0.95 0.01)^2 = 0.0036 of its square at most.
  double steps = 0;
  for (int i = 0; i < 9999; ++i) steps += std::pow(torque.at(0.01 * (i + 1)) - torque.at(0.01 * i), 2) / 9999;
  EXPECT_LT(steps, 0.0036 * 0.09);
}

TEST(BlindDrawing, AnEffectGrowsWithItsSizeAndStopsAtWhatIsPhysical) {
  const Kind& friction = kind_called("coulomb_friction");
  EXPECT_DOUBLE_EQ(scaled(friction, {{"friction_nm", 0.2}}, 3)["friction_nm"], 0.6);
  EXPECT_DOUBLE_EQ(scaled(friction, {{"friction_nm", 0.2}}, 1000)["friction_nm"], friction.sizes[0].high);
  const Kind& limit = kind_called("torque_saturation");
  EXPECT_DOUBLE_EQ(scaled(limit, {{"limit_nm", 4}}, 2)["limit_nm"], 2);
  const Kind& ratio = kind_called("time_varying_stiffness");
  EXPECT_NEAR(scaled(ratio, {{"stiffness_ratio", 0.8}}, 2)["stiffness_ratio"], 0.6, 1e-12);
  // Both levels stop when the larger one does: at 2.5 Nm either way it would be Coulomb's friction.
  const Kind& sided = kind_called("asymmetric_friction");
  const Numbers capped = scaled(sided, {{"friction_forward_nm", 0.2}, {"friction_backward_nm", 0.5}}, 1000);
  EXPECT_DOUBLE_EQ(capped["friction_forward_nm"], 1.0);
  EXPECT_DOUBLE_EQ(capped["friction_backward_nm"], 2.5);
  EXPECT_THROW((void)kind_called("no such effect"), std::invalid_argument);
}

}  // namespace
}  // namespace steerid::blind
