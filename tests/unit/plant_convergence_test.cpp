// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The integrator's error at 100 Hz records: under a tenth of the sensor floor for every effect, weak, preset and
// strong.
#include <gtest/gtest.h>

#include <algorithm>

#include "plant/free_run.hpp"
#include "plant_drive.hpp"

namespace steerid::test {
namespace {

struct Case {
  std::string name;
  WheelArm wheel;
  std::vector<Effect> effects;
  double steering_nm = 3;  ///< of the driver
};

// Corners of tables I and II of the paper: light and stiff (fast), light and strongly damped (stiff equation), heavy.
constexpr WheelArm kTypical{0.11, 1.5, 22.7};
constexpr WheelArm kLightStiff{0.05, 0.8, 80.0};
constexpr WheelArm kLightDamped{0.02, 4.4, 13.0};
constexpr WheelArm kHeavySoft{0.18, 0.4, 5.0};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const EffectType* type : effects()) {
    for (const auto& [name, wheel] : {std::pair{"typical", kTypical},
                                      {"light_stiff", kLightStiff},
                                      {"light_damped", kLightDamped},
                                      {"heavy_soft", kHeavySoft}}) {
      all.push_back({std::string(name), wheel, {Effect(*type)}});
    }
  }
  using namespace effect;
  const auto strong = [&all](Effect of, WheelArm wheel = kTypical) {
    all.push_back({"strong", wheel, {std::move(of)}});
  };
  strong(with(coulomb_friction, {{"friction_nm", 3}}));
  strong(with(coulomb_friction, {{"friction_nm", 0.01}}));
  strong(with(stribeck_friction, {{"friction_nm", 1.5}, {"breakaway_ratio", 2.5}, {"stribeck_rate_rad_s", 0.05}}));
  strong(with(asymmetric_friction, {{"friction_forward_nm", 0}, {"friction_backward_nm", 2}}));
  strong(with(coulomb_friction, {{"friction_nm", 3}, {"bristle_rad", 2e-3}}));
  strong(with(coulomb_friction, {{"friction_nm", 0.3}, {"bristle_rad", 1e-4}}));
  strong(with(stribeck_friction, {{"friction_nm", 0.6}, {"stribeck_rate_rad_s", 0.15}, {"bristle_rad", 4e-4}}));
  strong(with(asymmetric_friction, {{"friction_forward_nm", 0}, {"bristle_rad", 4e-4}}));
  strong(with(presliding_hysteresis, {{"friction_nm", 1.5}, {"presliding_rad", 0.02}, {"sharpness", 4}}));
  strong(with(presliding_hysteresis, {{"friction_nm", 0.5}, {"presliding_rad", 0.006}, {"sharpness", 6}}));
  strong(with(presliding_hysteresis, {{"friction_nm", 1.5}, {"presliding_rad", 0.02}, {"loop_shape", 1}}));
  strong(with(presliding_hysteresis,
              {{"friction_nm", 0.5}, {"presliding_rad", 0.006}, {"sharpness", 6}, {"loop_shape", 1}}));
  strong(with(backlash, {{"half_gap_rad", 0.05}, {"wheel_damping_share", 0.3}}));
  for (const auto& wheel : {kTypical, kLightStiff, kLightDamped, kHeavySoft}) {
    for (const double share : {0.3, 0.95}) {
      strong(with(backlash, {{"half_gap_rad", 0.03}, {"wheel_inertia_share", share}, {"contact_shape", 1}}), wheel);
    }
  }
  strong(with(cubic_stiffness, {{"cubic_stiffness_nm_per_rad3", 500}}), kLightStiff);
  strong(with(cubic_stiffness, {{"cubic_stiffness_nm_per_rad3", -88}}), kLightStiff);
  strong(with(quadratic_damping, {{"quadratic_damping_nms2_per_rad2", 5}}));
  strong(with(compliance, {{"grip_stiffness_nm_per_rad", 800}, {"wheel_inertia_share", 0.15}}));
  strong(with(reflex, {{"reflex_stiffness_nm_per_rad", 10}, {"delay_s", 0.04}, {"time_constant_s", 0.01}}));
  for (const double shape : {0.0, 1.0, 2.0}) {
    strong(with(time_varying_stiffness,
                {{"shape", shape}, {"stiffness_ratio", 3}, {"time_s", 7.0031}, {"length_s", 1.7}}));
  }
  // A torque that is gone from one sample to the next makes a record ring: the motor alone.
  all.push_back(
      {"strong_at_once",
       kTypical,
       {with(hands_off, {{"period_s", 3.003}, {"away_s", 0.4013}, {"first_s", 1.0007}, {"wheel_inertia_share", 0.15}})},
       0});
  for (const double fade_s : {0.02, 0.05, 0.1}) {
    strong(with(hands_off, {{"period_s", 3.003},
                            {"away_s", 0.4013},
                            {"first_s", 1.0007},
                            {"wheel_inertia_share", 0.15},
                            {"fade_s", fade_s}}));
  }
  strong(with(torque_ripple, {{"ripple_nm", 1}, {"cycles_per_turn", 40}}));
  strong(with(torque_ripple, {{"ripple_nm", 0.5}, {"cycles_per_turn", 150}}));
  strong(with(gravity_imbalance, {{"weight_torque_nm", 8}, {"phase_rad", -2}}));
  strong(with(periodic_disturbance, {{"amplitude_nm", 3}, {"frequency_hz", 12}}));
  Effect course(unmeasured_torque);
  course.at("knot_interval_s") = 0.5;
  course.time_course_nm = {1, -2, 3, 1, -1, -2, 2, 2, 2, -3, 0, 1, 1};
  strong(course);
  // While the bristles bend, what stands beside them is a torque that is known at a few instants only.
  const Effect bends = with(coulomb_friction, {{"friction_nm", 1.5}, {"bristle_rad", 1e-3}});
  for (Effect beside : {with(cubic_stiffness, {{"cubic_stiffness_nm_per_rad3", 500}}),
                        with(quadratic_damping, {{"quadratic_damping_nms2_per_rad2", 5}}),
                        with(torque_ripple, {{"ripple_nm", 0.5}, {"cycles_per_turn", 150}}),
                        with(gravity_imbalance, {{"weight_torque_nm", 8}, {"phase_rad", -2}}),
                        with(periodic_disturbance, {{"amplitude_nm", 3}, {"frequency_hz", 12}}),
                        with(time_varying_stiffness, {{"shape", 1}, {"stiffness_ratio", 3}, {"length_s", 1.7}}),
                        with(compliance), with(hands_off), with(backlash), with(reflex), course}) {
    all.push_back({"bends_beside_" + std::string(beside.type->id), kTypical, {bends, std::move(beside)}});
  }
  // Most of what the linear wheel takes for granted is away with the hand, which leaves between two samples and at one.
  all.push_back({"bends_beside_a_light_wheel",
                 kTypical,
                 {bends, with(hands_off, {{"period_s", 3}, {"away_s", 1}, {"wheel_inertia_share", 0.5}})}});
  all.push_back({"moves_from_jump_to_jump",
                 kTypical,
                 {with(coulomb_friction), with(torque_ripple, {{"ripple_nm", 0.5}, {"cycles_per_turn", 80}}),
                  with(hands_off, {{"period_s", 2}, {"away_s", 0.5}, {"first_s", 1}, {"wheel_inertia_share", 0.5}})}});
  all.push_back({"together",
                 kTypical,
                 {with(stribeck_friction, {{"friction_nm", 0.3}}), with(backlash), with(gravity_imbalance),
                  with(reflex), with(hands_off), with(delay), with(lag)}});
  const Effect contact = with(backlash, {{"half_gap_rad", 0.02}, {"contact_shape", 1}});
  all.push_back({"contact_that_rests", kTypical, {contact, with(coulomb_friction)}});
  all.push_back({"contact_that_bends", kTypical, {contact, with(coulomb_friction, {{"bristle_rad", 4e-4}})}});
  all.push_back({"contact_of_a_changing_arm",
                 kTypical,
                 {contact, with(time_varying_stiffness, {{"shape", 2}, {"length_s", 3}}), with(gravity_imbalance)}});
  all.push_back({"together_hysteresis",
                 kTypical,
                 {with(presliding_hysteresis, {{"presliding_rad", 0.03}, {"sharpness", 3}}), with(compliance),
                  with(torque_ripple)}});
  all.push_back({"together_sliding_springs",
                 kTypical,
                 {with(coulomb_friction, {{"bristle_rad", 4e-4}}),
                  with(presliding_hysteresis, {{"presliding_rad", 0.03}, {"loop_shape", 1}}), with(torque_ripple)}});
  const Effect stiff_grip = with(compliance, {{"grip_stiffness_nm_per_rad", 4000}, {"wheel_inertia_share", 0.1}});
  all.push_back({"stiff_grip_loop", kLightStiff, {with(presliding_hysteresis), stiff_grip}});
  all.push_back({"stiff_grip_friction", kLightStiff, {with(coulomb_friction), stiff_grip}});
  all.push_back({"stiff_grip_spring", kTypical, {with(cubic_stiffness), stiff_grip}});
  all.push_back({"together_two_masses", kTypical, {with(coulomb_friction), with(compliance), with(torque_ripple)}});
  return all;
}

std::vector<double> angle(const Record& record, const Case& given, int refinement) {
  FreeRun run(record);
  run.refine(refinement);
  const auto predicted = run(given.wheel, given.effects, WheelState{0.02, -0.1});
  return {predicted.begin(), predicted.end()};
}

class Convergence : public ::testing::TestWithParam<Case> {};

// Halving the step of a fourth-order method leaves a sixteenth of its error, so the difference is 15/16 of it. A step
// of a thirty-second besides shows whatever does not shrink that way, a missed event for one.
TEST_P(Convergence, FinerStepsMoveTheAngleByLessThanATenthOfTheFloor) {
  Record record = record_of(steering(GetParam().steering_nm), probe(), 20);
  Recorder recorder(GetParam().effects, {});  // the torque goes with a hand that leaves
  for (std::size_t i = 0; i < record.size(); ++i) {
    Channels now{.time_s = record.time_s[i], .torque_driver_nm = record.torque_driver_nm[i]};
    recorder.before_noise(now);
    record.torque_driver_nm[i] = now.torque_driver_nm;
  }
  const auto base = angle(record, GetParam(), 1);
  const double halved = worst_difference(base, angle(record, GetParam(), 2));
  const double fine = worst_difference(base, angle(record, GetParam(), 32));
  RecordProperty("halved_rad", std::to_string(halved));
  EXPECT_LT(halved, kTenthOfFloorRad);
  EXPECT_LT(fine, kTenthOfFloorRad);
  EXPECT_GT(rms(base), 0.005) << "the drive has to move the wheel for this to say anything";
}

std::string name_of(const ::testing::TestParamInfo<Case>& given) {
  return std::to_string(given.index) + "_" + std::string(given.param.effects.front().type->id) + "_" + given.param.name;
}
INSTANTIATE_TEST_SUITE_P(EveryEffect, Convergence, ::testing::ValuesIn(cases()), name_of);

}  // namespace
}  // namespace steerid::test
