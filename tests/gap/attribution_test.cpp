// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Probabilities: they sum to one, follow the evidence, and leave room for the unknown when nothing reaches the floor.
#include "gap/attribution/attribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gap/attribution/attribution_coefficients.hpp"
#include "gap/compared_drive.hpp"
#include "gap/comparison/wheel_shift.hpp"
#include "gap/pairs/pair_acceptance.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

Evidence evidence(const char* id, double nats, double excess, double complexity = 4) {
  return {.id = id,
          .fit_nats = nats,
          .choose_nats = nats / 2,
          .complexity = complexity,
          .shift = 0,
          .excess = excess,
          .eligible = true,
          .switches = switches(id)};
}

double of(const AttributionInput& input, const std::vector<double>& probability, std::string_view id) {
  for (std::size_t i = 0; i < input.all.size(); ++i) {
    if (input.all[i].id == id) return probability[i];
  }
  return probability.back();
}

AttributionInput gap_of_ten(double best_excess) {
  return {{evidence("none", 9000, 11, 0), evidence("parameters", 8000, 10, 12),
           evidence("coulomb_friction", 1000, best_excess), evidence("stribeck_friction", 999, best_excess, 12)},
          10};
}

TEST(Attribution, SumsToOneAndNamesWhatReachesTheFloor) {
  const AttributionInput input = gap_of_ten(1.02);
  const std::vector<double> probability = attribute(input, kAttribution);
  EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0), 1.0, 1e-12);
  EXPECT_GT(of(input, probability, "coulomb_friction"), 0.9);
  EXPECT_LT(of(input, probability, "unknown"), 0.05);
}

/// Of two that explain a record alike the one that leaves J, B and C where the simulation has them is meant, though the
/// other one is a little better.
TEST(Attribution, WhatHasToMoveTheWheelOutOfPlaceIsNotMeantWhereSomethingElseIsAsGood) {
  const auto named = [](double nats_better) {
    AttributionInput input = gap_of_ten(3);
    Evidence delay = evidence("delay", -1000 - nats_better, 1.02);
    delay.shift = 10;
    delay.shift_at_least = 9.5;
    input.all.push_back(delay);
    input.all.push_back(evidence("reflex", -1000, 1.02, 10));
    return attribute(input, kAttribution);
  };
  const AttributionInput ids = [] {
    AttributionInput input = gap_of_ten(3);
    input.all.push_back(evidence("delay", 0, 1));
    input.all.push_back(evidence("reflex", 0, 1));
    return input;
  }();
  EXPECT_GT(of(ids, named(10), "reflex"), 0.9);
  // Where nothing else is nearly as good the other one is a stand-in.
  EXPECT_GT(of(ids, named(200), "unknown"), 0.9);
}

TEST(Attribution, HowFarFrictionBendsSaysNothingOfItsKind) {
  const test::ComparedDrive compared({}, test::seed(90));
  const auto at_bound = [&](const char* parameter) {
    Effect friction(effect::stribeck_friction);
    for (std::size_t i = 0; i < friction.values.size(); ++i) {
      if (friction.type->parameters[i].name == parameter) friction.values[i] = friction.type->parameters[i].high;
    }
    Comparison comparison;
    comparison.candidates = {compared.candidate(compared_parts({}), "stribeck_friction", friction, kSeen)};
    return attribution_input(comparison, compared.whittle, compared.drive.wheel).all[0].at_bound;
  };
  EXPECT_FALSE(at_bound("bristle_rad"));
  EXPECT_TRUE(at_bound("breakaway_ratio"));
}

TEST(Attribution, AHandThatLeavesNoInertiaBehindIsNone) {
  const test::ComparedDrive compared({}, test::seed(87));
  const auto eligible = [&](double share) {
    Effect away(effect::hands_off);
    away.at("wheel_inertia_share") = share;
    Comparison comparison;
    comparison.candidates = {compared.candidate(compared_parts({}), "hands_off", away, kSeen)};
    return attribution_input(comparison, compared.whittle, compared.drive.wheel).all[0].eligible;
  };
  EXPECT_FALSE(eligible(0.05));
  EXPECT_TRUE(eligible(0.06));
}

TEST(Attribution, AnAbsenceOfNoWhileIsNone) {
  const test::ComparedDrive compared({}, test::seed(88));
  const auto eligible = [&](double away_s) {
    Effect away(effect::hands_off);
    away.at("away_s") = away_s;
    Comparison comparison;
    comparison.candidates = {compared.candidate(compared_parts({}), "hands_off", away, kSeen)};
    return attribution_input(comparison, compared.whittle, compared.drive.wheel).all[0].eligible;
  };
  EXPECT_FALSE(eligible(0.09));
  EXPECT_TRUE(eligible(0.11));
}

TEST(Attribution, ASwingingStiffnessMayBeGivenByItsLeastOrItsMost) {
  const test::ComparedDrive compared({}, test::seed(89));
  const auto shift = [&](double shape, double given_share) {
    Effect swing(effect::time_varying_stiffness);
    swing.at("shape") = shape;
    swing.at("stiffness_ratio") = 1.4;
    Comparison comparison;
    comparison.candidates = {compared.candidate(compared_parts({}), "time_varying_stiffness", swing, kSeen)};
    WheelArm given = compared.drive.wheel;
    given.stiffness_nm_per_rad *= given_share;
    return attribution_input(comparison, compared.whittle, given).all[0].shift;
  };
  EXPECT_EQ(shift(2, 0.61), 0);
  EXPECT_EQ(shift(2, 1.39), 0);
  EXPECT_NEAR(shift(2, 0.54), std::log1p(std::pow(std::log(0.9) / 0.06, 2)), 1e-9);  // a tenth below the least
  EXPECT_GT(shift(0, 0.61), 4) << "a step's stiffness is given as it was before";
}

TEST(Attribution, AFitWhoseFreeRunErrsMoreThanTheWheelAloneIsUnknown) {
  const auto unknown = [](double run_error) {
    AttributionInput input = gap_of_ten(1.02);
    input.all[2].run_error = run_error;
    return of(input, attribute(input, kAttribution), "unknown");
  };
  EXPECT_LT(unknown(0.05), 0.05);
  EXPECT_GT(unknown(3), 0.95);
}

TEST(Attribution, ToReachAFloorThatIsNoNoiseExplainsNothing) {
  const auto unknown = [](const char* best, double departure) {
    AttributionInput input = gap_of_ten(1.02);
    std::ranges::find(input.all, "coulomb_friction", &Evidence::id)->id = best;
    std::erase_if(input.all, [&](const Evidence& one) { return one.id != best && one.excess < 2; });
    input.noise_departure = departure;
    return of(input, attribute(input, kAttribution), "unknown");
  };
  EXPECT_LT(unknown("none", 4), 0.09);                // normal noise
  EXPECT_GT(unknown("none", 9), 0.94);                // the least of a rounded angle
  EXPECT_LT(unknown("gravity_imbalance", 30), 0.05);  // an effect has more to say for itself
}

TEST(Attribution, BesideARoundedAngleWhatIsPlainIsNamed) {
  const Evidence refit = evidence("parameters", 8000, 1.0);
  // The choosing blocks count besides: 1.5 nats for one. Forty beyond the price of 4.
  EXPECT_TRUE(gains_beside_rounding(refit, evidence("cubic_stiffness", 7965, 0.95)));
  EXPECT_FALSE(gains_beside_rounding(refit, evidence("cubic_stiffness", 7975, 0.95)));
  Evidence strays = evidence("torque_ripple", 7900, 0.85);
  strays.run_error = 3;
  EXPECT_FALSE(gains_beside_rounding(refit, strays));
}

/// The probability of unknown beside one effect, where J, B and C alone leave `refit_excess`.
double unknown_beside(const Evidence& one, double refit_excess) {
  const AttributionInput input = {
      {evidence("none", 9000, refit_excess + 1, 0), evidence("parameters", 8000, refit_excess, 12), one}, refit_excess};
  return of(input, attribute(input, kAttribution), "unknown");
}

/// The same of an effect with one figure of its evidence.
double unknown_with(const char* id, double excess, double Evidence::*figure, double value, double refit_excess) {
  Evidence one = evidence(id, 500, excess);
  one.*figure = value;
  return unknown_beside(one, refit_excess);
}

TEST(Attribution, ASmoothEffectIsForgivenLessThanOneThatSwitches) {
  EXPECT_GT(unknown_beside(evidence("cubic_stiffness", 500, 1.4), 2), 0.5);
  EXPECT_LT(unknown_beside(evidence("backlash", 500, 1.4), 2), 0.5);
}

TEST(Attribution, DryFrictionIsForgivenLeastBecauseItsKindsStandInForEachOther) {
  EXPECT_GT(unknown_beside(evidence("coulomb_friction", 500, 1.9), 35), 0.7);
  EXPECT_LT(unknown_beside(evidence("cubic_stiffness", 500, 1.9), 35), 0.3);
}

TEST(Attribution, MoreSlowTorqueThanAnyDriverMakesIsUnknown) {
  const auto unknown = [](const char* id, double slow_share) {
    return unknown_with(id, 1.02, &Evidence::slow_share, slow_share, 1.5);
  };
  EXPECT_LT(unknown("torque_bias", 0.02), 0.05);
  EXPECT_GT(unknown("torque_bias", 0.045), 0.9);
  EXPECT_LT(unknown("hands_off", 0.045), 0.05);  // misses some at low frequency even when right
}

TEST(Attribution, ASlowTorqueThatFreeRunsDoNotNeedSaysNothing) {
  const auto unknown = [](double run_error) {
    Evidence one = evidence("stribeck_friction", 500, 1.02);
    one.slow_share = 0.045;
    one.run_error = run_error;
    return unknown_beside(one, 1.5);
  };
  EXPECT_GT(unknown(0.03), 0.9);
  EXPECT_LT(unknown(0.01), 0.05);
}

TEST(Attribution, AWheelFarFromTheSimulationsMayLeaveLess) {
  const auto unknown = [](double shift) { return unknown_with("compliance", 1.15, &Evidence::shift, shift, 12.6); };
  EXPECT_LT(unknown(3), 0.05);
  EXPECT_GT(unknown(15), 0.5);
}

TEST(Attribution, AFitWithJBAndCOutOfPlaceIsUnknownHoweverMuchItExplains) {
  const auto unknown = [](double shift) {
    return unknown_with("stribeck_friction", 1.0, &Evidence::shift_at_least, shift, 50);
  };
  // 8 % off in all three is 3.06, a damping that is three quarters too large 4.5.
  EXPECT_LT(unknown(3.06), 0.05);
  EXPECT_GT(unknown(4.5), 0.85);
  EXPECT_LT(unknown(0), 0.01);
}

TEST(Attribution, AToneIsNoSlowTorque) {
  const auto unknown = [](double share) {
    return unknown_with("unmeasured_torque", 1.0, &Evidence::slow_line_share, share, 5);
  };
  EXPECT_LT(unknown(0.65), 0.05);
  EXPECT_GT(unknown(0.85), 0.95);
}

TEST(Attribution, UnknownIsGivenOddsBesideAName) {
  // An excess and a share open at which evidence speaks for neither.
  Evidence one = evidence("backlash", 500, 1 + kAttribution.unknown_excess);
  const double open = kAttribution.unknown_excess / kAttribution.unknown_unclosed;
  EXPECT_NEAR(unknown_beside(one, 1 + open), kAttribution.unknown_odds / (1 + kAttribution.unknown_odds), 1e-6);
}

TEST(Attribution, ANumberThatIsHardlyKnownIsNotFarFromAnything) {
  Whittle::Fit fit;
  fit.x = Eigen::Vector3d(0.11, 3.0, 20);
  const WheelArm sim{.inertia_kgm2 = 0.11, .damping_nms_per_rad = 1.5, .stiffness_nm_per_rad = 20};
  const auto with_sd = [&](double damping_sd) {
    fit.information = Eigen::Vector3d(1e8, 1 / (damping_sd * damping_sd), 1e8).asDiagonal();
    fit.misfit[0] = {.cost = 0, .chi = 100, .lines = 100};  // at the floor
    return shift_at_least(sim, fit);
  };
  const auto of = [](double ratio) { return std::log(1 + std::pow(std::log(ratio) / 0.06, 2)); };
  EXPECT_NEAR(with_sd(1e-6), of(2), 1e-4);
  EXPECT_NEAR(with_sd(1e-6), shift_from(sim, wheel_of(fit.x)), 1e-4);
  EXPECT_NEAR(with_sd(0.1), of(2.7 / 1.5), 1e-6);  // three deviations nearer
  EXPECT_NEAR(with_sd(0.6), 0, 1e-6);
}

TEST(Attribution, ARicherEffectNeedsProof) {
  // One nat better, eight nats dearer.
  const AttributionInput input = gap_of_ten(1.02);
  const std::vector<double> probability = attribute(input, kAttribution);
  EXPECT_LT(of(input, probability, "stribeck_friction"), 0.1);
}

TEST(Attribution, StribeckHasToExplainATenthOfWhatCoulombLeaves) {
  // Both stay far above the floor; a hundred nats alone are what bristles give to any bend of the curve.
  const auto told = [](double stribeck_excess) {
    AttributionInput input = {
        {evidence("none", 90000, 130, 0), evidence("parameters", 80000, 120, 12), evidence("coulomb_friction", 1000, 7),
         evidence("stribeck_friction", 900, stribeck_excess, 12)},
        120};
    const std::vector<double> probability = attribute(input, kAttribution);
    return of(input, probability, "stribeck_friction") > of(input, probability, "coulomb_friction");
  };
  EXPECT_FALSE(told(6.5));
  EXPECT_TRUE(told(6.3));
}

TEST(Attribution, NothingThatReachesTheFloorIsUnknown) {
  const AttributionInput input = gap_of_ten(5);  // four tenths of the gap left open
  const std::vector<double> probability = attribute(input, kAttribution);
  EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0), 1.0, 1e-12);
  EXPECT_GT(of(input, probability, "unknown"), 0.9);
}

TEST(Attribution, AStrongEffectMayLeaveAPerCentBehind) {
  AttributionInput input = gap_of_ten(1.75);  // far above the floor, and half a per cent of the gap
  input.refit_excess = 151;
  EXPECT_LT(of(input, attribute(input, kAttribution), "unknown"), 0.05);
}

AttributionInput left_to_a_shape(double fit_nats, double choose_nats) {
  AttributionInput input = gap_of_ten(1.2);  // close to the floor, 200 nats above it
  input.refit_excess = 31;                   // and less than a hundredth of the gap
  for (Evidence& one : input.all) one.lines = 1000;
  input.all[2].rivals = {{"surface", fit_nats, choose_nats, 10, 200}};
  return input;
}

TEST(Attribution, WhatAShapeWithoutANameExplainsIsUnknown) {
  const AttributionInput input = left_to_a_shape(150, 75);
  EXPECT_GT(of(input, attribute(input, kAttribution), "unknown"), 0.9);
}

TEST(Attribution, AShapeThatExplainsTheFittedBlocksOnlyIsChance) {
  const AttributionInput input = left_to_a_shape(150, 2);
  EXPECT_LT(of(input, attribute(input, kAttribution), "unknown"), 0.05);
}

TEST(Attribution, AShapeThatExplainsLittleOfWhatIsLeftSaysNothing) {
  AttributionInput input = left_to_a_shape(150, 75);
  input.refit_excess = 151;
  input.all[2].excess = 2.5;  // 1,500 nats above the floor
  input.all[2].rivals[0].left = 1500;
  for (Evidence& one : input.all) one.excess = std::max(one.excess, 2.5);
  EXPECT_LT(of(input, attribute(input, kAttribution), "unknown"), 0.2);
}

/// 100 nats above the floor, of a gap of 4,000: what `free` coefficients gain.
AttributionInput claimed_by(int free, double fit_nats, double choose_nats) {
  AttributionInput input = left_to_a_shape(0, 0);
  input.refit_excess = 5;
  for (Evidence& one : input.all) one.excess = std::min(one.excess, 1.1);
  input.all[2].rivals = {{"course", fit_nats, choose_nats, free, 100}};
  return input;
}

TEST(Attribution, ASingleShapeClaimsWhatTenWouldFindByChance) {
  const auto unknown = [](int free, double fit_nats, double choose_nats) {
    const AttributionInput input = claimed_by(free, fit_nats, choose_nats);
    return of(input, attribute(input, kAttribution), "unknown");
  };
  const double unclaimed = unknown(1, 0, 0);
  EXPECT_LT(unclaimed, 0.27);  // one to four, times the odds
  EXPECT_GT(unknown(1, 30, 15), 0.8);
  EXPECT_LT(unknown(10, 30, 15), 0.39);     // three to seven, times the odds
  EXPECT_EQ(unknown(1, 10, 5), unclaimed);  // less than a fifth of what is left
  EXPECT_EQ(unknown(1, 30, 1), unclaimed);  // on the fitted blocks only
  AttributionInput switching = claimed_by(1, 30, 15);
  for (Evidence& one : switching.all) one.switches = true;
  EXPECT_LT(of(switching, attribute(switching, kAttribution), "unknown"), 0.39);
}

TEST(Attribution, AShapeThatExplainsLessThanAThousandthOfTheGapSaysNothing) {
  AttributionInput input = left_to_a_shape(150, 75);
  input.refit_excess = 301;  // 300,000 nats of gap, of which the shape explains 225
  EXPECT_LT(of(input, attribute(input, kAttribution), "unknown"), 0.05);
}

TEST(Attribution, NoiseAloneIsNone) {
  const AttributionInput input = {
      {evidence("none", 1003, 1.01, 0), evidence("parameters", 1001, 1.0, 12), evidence("delay", 999, 1.0, 16)}, 1.0};
  const std::vector<double> probability = attribute(input, kAttribution);
  EXPECT_GT(of(input, probability, "none"), 0.9);
  EXPECT_LT(of(input, probability, "unknown"), 0.05);
}

/// Of 1.23 times the floor 40 nats and three fifths of what is above it have to go, by an effect of one number.
TEST(Attribution, ASecondEffectBesideADefectExplainsMostOfWhatIsLeft) {
  const auto evidence = [](double excess, double nats) {
    Evidence one;
    one.excess = excess;
    one.fit_nats = nats;
    return one;
  };
  EXPECT_TRUE(gains_beside_defects(evidence(1.23, 0), evidence(1.01, -200)));
  EXPECT_TRUE(gains_beside_defects(evidence(1.23, 0), evidence(1.08, -45)));
  EXPECT_FALSE(gains_beside_defects(evidence(1.23, 0), evidence(1.01, -35)));
  EXPECT_FALSE(gains_beside_defects(evidence(1.23, 0), evidence(1.12, -200)));
  EXPECT_FALSE(gains_beside_defects(evidence(1.08, 0), evidence(1.0, -200)));
  // However much is left: a free run that closes seven tenths of the gap's power.
  Evidence runs = evidence(9, -2000);
  EXPECT_FALSE(gains_beside_defects(evidence(12, 0), runs));
  runs.run_error = 0.25;
  EXPECT_TRUE(gains_beside_defects(evidence(12, 0), runs));
  runs.run_error = 0.35;
  EXPECT_FALSE(gains_beside_defects(evidence(12, 0), runs));
}

}  // namespace
}  // namespace steerid
