// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Defects of a record, made by hand, and their absence.
#include "gap/preparation/record_defects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/preparation/prepared_record.hpp"
#include "support/independent_wheel.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

const RecordDefect* found(const RecordDefects& defects, std::string_view id) {
  const auto it = std::ranges::find_if(defects.found, [&](const auto& one) { return one.effect.type->id == id; });
  return it == defects.found.end() ? nullptr : &*it;
}

Record usual(std::uint64_t seed) {
  Record record = test::drive({}, seed);
  for (double& angle : record.angle_rad) angle = 0.0005 * std::round(angle / 0.0005);  // 0.03 degrees
  return record;
}

TEST(RecordDefects, AUsualRecordHasNone) { EXPECT_TRUE(record_defects(usual(test::seed(21))).found.empty()); }

TEST(RecordDefects, LostSamplesAreCountedAndRepaired) {
  const Record whole = usual(test::seed(22));
  Record record = whole;
  test::Noise chance(test::seed(23));
  for (std::size_t i = 1; i < record.size(); ++i) {
    if (chance.uniform() < 0.08) record.angle_rad[i] = record.angle_rad[i - 1];
  }
  const RecordDefects defects = record_defects(record);
  const RecordDefect* loss = found(defects, "sample_loss");
  ASSERT_NE(loss, nullptr);
  EXPECT_EQ(defects.found.size(), 1U);
  EXPECT_NEAR(loss->effect.at("loss_probability"), 0.08, 0.03);
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    before += std::pow(record.angle_rad[i] - whole.angle_rad[i], 2);
    after += std::pow(defects.repaired.angle_rad[i] - whole.angle_rad[i], 2);
  }
  EXPECT_LT(after, 0.1 * before);
}

/// One in sixty, each alone: noise undoes a wheel that moves by more than four times of it far less often.
TEST(RecordDefects, AFewLostSamplesAreSeen) {
  Record record = usual(test::seed(36));
  test::Noise chance(test::seed(37));
  for (std::size_t i = 1; i < record.size(); ++i) {
    if (chance.uniform() < 1.0 / 60) record.angle_rad[i] = record.angle_rad[i - 1];
  }
  const RecordDefects defects = record_defects(record);
  const RecordDefect* loss = found(defects, "sample_loss");
  ASSERT_NE(loss, nullptr);
  EXPECT_NEAR(loss->effect.at("loss_probability"), 1.0 / 60, 0.008);  // two deviations of some thousand samples
}

/// One sample in a hundred, but ten after one another: the wheel stands still and jumps.
TEST(RecordDefects, SamplesLostInRunsAreFewAndPlain) {
  Record record = usual(test::seed(34));
  test::Noise chance(test::seed(35));
  double lost = 0;
  for (std::size_t i = 1; i + 10 < record.size(); ++i) {
    if (chance.uniform() > 1e-3) continue;
    for (int k = 0; k < 10; ++k, ++i, ++lost) record.angle_rad[i] = record.angle_rad[i - 1];
  }
  ASSERT_GT(lost, 30);
  const RecordDefects defects = record_defects(record);
  const RecordDefect* loss = found(defects, "sample_loss");
  ASSERT_NE(loss, nullptr);
  const double share = lost / static_cast<double>(record.size());
  EXPECT_NEAR(loss->effect.at("loss_probability"), share, 0.5 * share);
}

/// Backlash in the sensor repeats, too, but only after reversals: nothing of it is lost.
TEST(RecordDefects, BacklashOfTheSensorLosesNoSamples) {
  test::DrawnDrive what;
  what.angle_noise_rad = 0;
  Record record = test::drive(what, test::seed(27));
  constexpr double kHalfGap_rad = 0.01;
  double held = record.angle_rad[0];
  int repeats = 0;
  for (double& angle : record.angle_rad) {
    const double before = held;
    held = std::clamp(held, angle - kHalfGap_rad, angle + kHalfGap_rad);
    repeats += held == before ? 1 : 0;
    angle = held;
  }
  EXPECT_GT(repeats, static_cast<int>(record.size()) / 20);
  EXPECT_EQ(found(record_defects(record), "sample_loss"), nullptr);
}

TEST(RecordDefects, ACoarseAngleHasItsStep) {
  Record record = test::drive({}, test::seed(24));
  for (double& angle : record.angle_rad) angle = 0.02 * std::round(angle / 0.02);
  const RecordDefects defects = record_defects(record);
  const RecordDefect* coarse = found(defects, "coarse_quantization");
  ASSERT_NE(coarse, nullptr);
  EXPECT_EQ(defects.found.size(), 1U);
  EXPECT_NEAR(coarse->effect.at("step_rad"), 0.02, 1e-6);
}

TEST(RecordDefects, AClippedTorqueHasItsLimit) {
  Record record = usual(test::seed(25));
  for (double& torque : record.torque_motor_nm) torque = std::clamp(torque, -3.0, 3.0);
  test::Noise noise(test::seed(26));
  for (double& torque : record.torque_motor_nm) torque += 0.006 * noise();
  const RecordDefects defects = record_defects(record);
  const RecordDefect* clipped = found(defects, "torque_saturation");
  ASSERT_NE(clipped, nullptr);
  EXPECT_NEAR(clipped->effect.at("limit_nm"), 3.0, 0.03);
}

/// A probe of tones up to 5 Hz, clipped at 0.6 of its peak for 0.1 s at most: the tones say what was clipped. Clipping
/// took 0.5 Nm and more in the mean; noise of 4 mNm on every sample leaves no less than itself.
TEST(RecordDefects, AClippedProbeComesBack) {
  Record record = usual(test::seed(28));
  test::Noise noise(test::seed(29));
  std::vector<double> whole(record.size());
  double peak = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (int tone = 1; tone <= 24; ++tone) {
      const double hz = 0.2 + 0.2 * tone + 0.01 * std::sin(7.0 * tone);
      whole[i] += 0.5 * std::sin(2 * std::numbers::pi * hz * 0.01 * static_cast<double>(i) + tone * tone);
    }
    peak = std::max(peak, std::abs(whole[i]));
  }
  const double limit = 0.6 * peak;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    record.torque_motor_nm[i] = std::clamp(whole[i], -limit, limit) + 0.004 * noise();
  }
  const RecordDefects defects = record_defects(record);
  ASSERT_NE(found(defects, "torque_saturation"), nullptr);
  EXPECT_NEAR(found(defects, "torque_saturation")->effect.at("limit_nm"), limit, 0.004);
  double took = 0;
  double left = 0;
  double count = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (std::abs(whole[i]) <= limit) continue;
    took += std::pow(std::abs(whole[i]) - limit, 2);
    left += std::pow(defects.repaired.torque_motor_nm[i] - whole[i], 2);
    count += 1;
  }
  EXPECT_GT(std::sqrt(took / count), 0.3);
  EXPECT_LT(std::sqrt(left / count), 0.1 * std::sqrt(took / count));
  EXPECT_GT(std::sqrt(left / count), 0.002);
  // What may be wrong with it is said: not many times less than what is wrong, and not as much as was clipped.
  double doubt = 0;
  for (const HiddenTorque& one : defects.hidden) doubt += one.shapes_nm.squaredNorm();
  EXPECT_GT(std::sqrt(doubt / count), 0.5 * std::sqrt(left / count));
  EXPECT_LT(std::sqrt(doubt / count), std::sqrt(took / count));
}

/// A motor that clips before its channel's filter, which overshoots where a clipped stretch begins: by a hundredth,
/// many times the noise.
TEST(RecordDefects, ATorqueThatOvershootsItsLimitIsClipped) {
  Record record = usual(test::seed(33));
  test::Noise noise(test::seed(34));
  constexpr double kLimit_nm = 2.5;
  int clipped_for = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    double torque = 0;
    for (int tone = 1; tone <= 12; ++tone) {
      torque += 0.5 * std::sin(2 * std::numbers::pi * 0.21 * tone * 0.01 * static_cast<double>(i) + tone * tone);
    }
    clipped_for = std::abs(torque) > kLimit_nm ? clipped_for + 1 : 0;
    const double over = clipped_for == 1 ? 0.01 : clipped_for == 2 ? 0.005 : 0;
    record.torque_motor_nm[i] = std::clamp(torque, -kLimit_nm, kLimit_nm) * (1 + over) + 0.0005 * noise();
  }
  const RecordDefects defects = record_defects(record);
  ASSERT_NE(found(defects, "torque_saturation"), nullptr);
  EXPECT_NEAR(found(defects, "torque_saturation")->effect.at("limit_nm"), kLimit_nm, 0.01);
}

/// Tones up to 5 Hz with noise of the torque's own, as a loop's answers are: clipped with the rest, and forty times
/// what is added behind. Not clipped it has no top.
TEST(RecordDefects, ATorqueWhoseNoiseIsClippedHasItsLimit) {
  Record record = usual(test::seed(30));
  test::Noise noise(test::seed(31));
  for (std::size_t i = 0; i < record.size(); ++i) {
    double torque = 0.08 * noise();
    for (int tone = 1; tone <= 24; ++tone) {
      torque += 0.2 * std::sin(2 * std::numbers::pi * 0.205 * tone * 0.01 * static_cast<double>(i) + tone * tone);
    }
    record.torque_motor_nm[i] = torque;
  }
  EXPECT_EQ(found(record_defects(record), "torque_saturation"), nullptr);
  constexpr double kLimit_nm = 1.1;
  for (double& torque : record.torque_motor_nm) torque = std::clamp(torque, -kLimit_nm, kLimit_nm) + 0.002 * noise();
  const RecordDefects defects = record_defects(record);
  ASSERT_NE(found(defects, "torque_saturation"), nullptr);
  EXPECT_NEAR(found(defects, "torque_saturation")->effect.at("limit_nm"), kLimit_nm, 0.002);
}

/// Who clips noise, too, leaves one value again and again. A limit that the torque was made with does the same when it
/// has no noise, and has it on top of that when it has.
TEST(RecordDefects, OnlyNoiseThatIsClippedIsCertain) {
  Record record = usual(test::seed(36));
  test::Noise noise(test::seed(37));
  constexpr double kLimit_nm = 3.0;
  const auto motor = [&](double behind, double before) {
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double torque =
          5 * std::sin(0.3 * record.time_s[i]) + 2 * std::sin(9 * record.time_s[i]) + before * noise();
      record.torque_motor_nm[i] = std::clamp(torque, -kLimit_nm, kLimit_nm) + behind * noise();
    }
    const RecordDefects defects = record_defects(record);
    const RecordDefect* clipped = found(defects, "torque_saturation");
    return clipped != nullptr && clipped->certain;
  };
  EXPECT_TRUE(motor(0, 0.03));
  EXPECT_FALSE(motor(0, 0));
  EXPECT_FALSE(motor(0.03, 0));
}

/// Noise on a lattice: a few samples have the largest size of all exactly, and none lie between the lattice's values.
TEST(RecordDefects, AQuietChannelThatIsReadInStepsIsNotClipped) {
  Record record = usual(test::seed(32));
  test::Noise noise(test::seed(33));
  for (int i = 0; i < 20; ++i) {
    for (double& torque : record.torque_driver_nm) torque = 0.005 * std::round(0.01 * noise() / 0.005);
    EXPECT_EQ(found(record_defects(record), "torque_saturation"), nullptr);
  }
}

/// Two motors that switch at random every tenth of a second, held between samples: the levels crowd as a limit would.
TEST(RecordDefects, ATorqueOfTwoLevelsIsNotClipped) {
  test::Noise noise(test::seed(75));
  const WheelArm wheel{0.1, 1.4, 20};
  std::vector<double> driver_nm(4000);
  std::vector<double> motor_nm(4000);
  for (std::size_t i = 0; i < driver_nm.size(); ++i) {
    const bool held = i % 10 != 0;
    driver_nm[i] = held ? driver_nm[i - 1] : std::copysign(1.5, noise.uniform() - 0.5);
    motor_nm[i] = held ? motor_nm[i - 1] : std::copysign(1.5, noise.uniform() - 0.5);
  }
  Record record;
  record.angle_rad = test::independent_angles(wheel, driver_nm.size(), 20,
                                              [&](std::size_t k, double) { return driver_nm[k] - motor_nm[k]; });
  for (std::size_t i = 0; i < driver_nm.size(); ++i) {
    record.time_s.push_back(0.01 * static_cast<double>(i));
    record.torque_driver_nm.push_back(driver_nm[i] + 0.01 * noise());
    record.torque_motor_nm.push_back(motor_nm[i] + 0.01 * noise());
    record.angle_rad[i] += 3e-4 * noise();
  }
  Simulation simulation;
  simulation.wheel = wheel;
  simulation.torque_between_samples = TorqueSignal::Between::kHeld;
  EXPECT_EQ(diagnose(record, simulation).verdict, "none");
}

/// A probe that comes back every ten seconds has its peak nine times, and samples crowd there; what crowds was not
/// clipped where the record predicts as well as it is.
TEST(RecordDefects, ThePeaksOfAProbeThatComesBackAreNotClipped) {
  test::DrawnDrive what;
  what.duration_s = 90;
  what.torque_noise_nm = 0.004;
  what.angle_noise_rad = 1e-4;
  test::Noise draw(test::seed(38));
  std::vector<double> phases;
  for (int tone = 0; tone < 40; ++tone) phases.push_back(2 * std::numbers::pi * draw.uniform());
  what.probe_nm = [phases](double t) {
    double sum = 0;
    for (std::size_t tone = 0; tone < phases.size(); ++tone) {
      const double hz = 0.3 + 0.2 * static_cast<double>(tone);
      sum += 0.25 * std::cos(2 * std::numbers::pi * hz * t + phases[tone]);
    }
    return sum;
  };
  const Record record = test::drive(what, test::seed(39));
  ASSERT_NE(found(record_defects(record), "torque_saturation"), nullptr) << "the peaks crowd";
  Simulation simulation;
  simulation.wheel = what.wheel;
  EXPECT_EQ(found(PreparedRecord(record, simulation, {}).defects, "torque_saturation"), nullptr);
}

/// A drag that the simulation has hides from the linear wheel what clipped peaks did; the simulation's own run knows.
/// Where the same drive has flat tops that drove the wheel, rebuilt peaks move that run away from the record.
TEST(RecordDefects, ClippedPeaksAreToldBesideADragThatTheSimulationHas) {
  constexpr double kLimit_nm = 2.6;
  constexpr double kDrag = 5;
  for (const bool on_purpose : {false, true}) {
    test::DrawnDrive what;
    what.torque_noise_nm = 0.004;
    what.torque = [](double, double, double v) { return -kDrag * v * std::abs(v); };
    what.probe_nm = [=](double t) {
      double sum = 0;
      for (int tone = 1; tone <= 12; ++tone) sum += 0.75 * std::cos(2.3 * tone * t * 0.731 + tone * tone);
      return on_purpose ? std::clamp(sum, -kLimit_nm, kLimit_nm) : sum;
    };
    Record record = test::drive(what, test::seed(76));
    for (double& torque : record.torque_motor_nm) torque = std::clamp(torque, -kLimit_nm, kLimit_nm);
    ASSERT_NE(found(record_defects(record), "torque_saturation"), nullptr);
    Simulation simulation;
    simulation.wheel = what.wheel;
    simulation.effects.emplace_back(effect::quadratic_damping);
    simulation.effects.back().values[0] = kDrag;
    const bool told = found(PreparedRecord(record, simulation, {}).defects, "torque_saturation") != nullptr;
    EXPECT_EQ(told, !on_purpose);
  }
}

}  // namespace
}  // namespace steerid::gap
