// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The floor: noise levels read off channels with a drive on them, the split, and the rms that the floor leaves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "gap/drawn_drive.hpp"
#include "gap/likelihood/held_out_split.hpp"
#include "gap/likelihood/noise_floor.hpp"
#include "gap/model/floor_rms.hpp"
#include "gap/model/floor_runs.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

TEST(NoiseFloor, ReadsWhiteLevelsUnderADrive) {
  test::DrawnDrive what;
  what.duration_s = 100;
  const NoiseFloor floor = NoiseFloor::of(test::drive(what, test::seed(11)), what.wheel);
  // The lowest of four bands, each of some 700 lines: 4 % below the mean at most, three times that allowed.
  EXPECT_NEAR(std::sqrt(floor.torque_variance), 0.02, 0.08 * 0.02);
  EXPECT_NEAR(std::sqrt(floor.angle_variance), 0.0006, 0.08 * 0.0006);
}

TEST(NoiseFloor, ReadsWhatColouredNoiseHasWhereTheWheelMoves) {
  // n_k + 0.3 n_(k-1) has the density v (1.09 + 0.6 cos w): 1.69 v at zero, 0.56 v at 42 Hz.
  test::DrawnDrive what;
  what.duration_s = 100;
  what.torque_noise_nm = 0;
  Record record = test::drive(what, test::seed(17));
  test::Noise noise(test::seed(18));
  double before = noise();
  for (double& torque_nm : record.torque_driver_nm) {
    const double now = noise();
    torque_nm += 0.02 * (now + 0.3 * before);
    before = now;
  }
  const NoiseFloor floor = NoiseFloor::of(record, what.wheel);
  // The line's end at zero is known to 5 %: four bands of some 700 windowed lines, half of them their own.
  EXPECT_NEAR(floor.torque_variance, 1.69 * 0.02 * 0.02, 3 * 0.05 * 1.69 * 0.02 * 0.02);
  EXPECT_NEAR(std::sqrt(floor.angle_variance), 0.0006, 0.08 * 0.0006) << "white, and read as white";
}

TEST(NoiseFloor, TakesTheLowestBandWhereSomethingMovesInOthers) {
  // Up to 30 Hz a torque of twice the noise's power: no line through the four bands.
  test::DrawnDrive what;
  what.duration_s = 100;
  Record record = test::drive(what, test::seed(19));
  for (int tone = 0; tone < 300; ++tone) {
    const double f_hz = 15 + 0.05 * tone;
    for (std::size_t i = 0; i < record.size(); ++i) {
      record.torque_driver_nm[i] += 0.02 * std::sqrt(2.0 * 2 * 0.3 / 300) *
                                    std::cos(2 * std::numbers::pi * f_hz * record.time_s[i] + tone * tone);
    }
  }
  const NoiseFloor floor = NoiseFloor::of(record, what.wheel);
  EXPECT_NEAR(std::sqrt(floor.torque_variance), 0.02, 0.08 * 0.02);
}

TEST(NoiseFloor, AMachineDrivenAtAllFrequenciesDoesNotPassForNoise) {
  // Real torque of 0.5 Nm rms up to 50 Hz on inertia alone, and the motion it makes, with 0.02 Nm and 1 urad of noise.
  // Every sample's torque is drawn, so the record's lines are those of the closed form -1/(J w^2) only after a
  // transform of our own: the angle is summed from the torque's lines.
  constexpr double kInertia = 0.1;
  constexpr int kSamples = 4000;
  test::Noise noise(test::seed(12));
  std::vector<double> torque(kSamples, 0.0);
  std::vector<double> angle(kSamples, 0.0);
  constexpr int kTones = 180;
  for (int k = 1; k <= kTones; ++k) {
    const double w = 2 * std::numbers::pi * 0.25 * k;
    const double phase = 2 * std::numbers::pi * noise.uniform();
    for (int i = 0; i < kSamples; ++i) {
      const double tone = 0.5 * std::sqrt(2.0 / kTones) * std::cos(w * 0.01 * i + phase);
      torque[static_cast<std::size_t>(i)] += tone;
      angle[static_cast<std::size_t>(i)] -= tone / (kInertia * w * w);
    }
  }
  Record record;
  for (int i = 0; i < kSamples; ++i) {
    record.time_s.push_back(0.01 * i);
    record.torque_driver_nm.push_back(torque[static_cast<std::size_t>(i)] + 0.02 * noise());
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(angle[static_cast<std::size_t>(i)] + 1e-6 * noise());
  }
  const NoiseFloor floor = NoiseFloor::of(record, {kInertia, 0, 0});
  // Over the window's main lobe, some 1 Hz to either side, 1/H changes by 5 % at 42 Hz: of 0.5 Nm about 0.01 Nm does
  // not cancel, sqrt(0.02^2 + 0.01^2) = 0.022. Below the truth only by chance, 5 %. The channel alone reads 0.5 Nm.
  EXPECT_GT(std::sqrt(floor.torque_variance), 0.95 * 0.02);
  EXPECT_LT(std::sqrt(floor.torque_variance), 1.25 * 0.02);
  EXPECT_LT(std::sqrt(floor.angle_variance), 0.02 / (kInertia * std::pow(2 * std::numbers::pi * 38, 2)) + 2e-6);
}

/// What stray weights leave of a torque's noise makes whatever passes less of it no better; what is left of a torque
/// that drove the wheel does.
TEST(NoiseFloor, CountsWhatNoiseLeavesByOneWheelAndWhatATorqueLeavesByEach) {
  BlockSpectra spectra(std::vector{Block{Block::Role::kFit, 0, 1000}});
  NoiseFloor floor;
  floor.angle_variance = 1;
  floor.torque_variance = 8;
  const Eigen::VectorXd gain = Eigen::VectorXd::Constant(spectra.bins(), 3);
  EXPECT_EQ(floor.counted_density(spectra, gain)[5], 1 + 3 * 8);
  spectra.count_torque_noise_by(Eigen::VectorXd::Constant(spectra.bins(), 2));
  spectra.leave_of_torque_noise(Eigen::VectorXd::Constant(spectra.bins(), 0.2));
  EXPECT_EQ(floor.density(spectra, gain)[5], 1 + 3 * 8 * 0.2);
  EXPECT_EQ(floor.counted_density(spectra, gain)[5], 1 + 2 * 8 * 0.2);
  spectra.leave_of_torque_noise(Eigen::VectorXd::Constant(spectra.bins(), 1));
  EXPECT_EQ(floor.counted_density(spectra, gain)[5], 1 + 3 * 8);
}

TEST(NoiseFloor, SlowTorqueHasUnitPowerAndItsRateTheVarianceStated) {
  for (const SlowColour& colour : {SlowColour{0.1, 1}, SlowColour{0.4, 1}, SlowColour{0.15, 2}, SlowColour{0.3, 2}}) {
    double power = 0;
    double rate = 0;
    constexpr double kStep_hz = 1e-4;
    for (double f = kStep_hz / 2; f < 20; f += kStep_hz) {
      power += colour.density(f) * kStep_hz;
      rate += std::pow(2 * std::numbers::pi * f, 2) * colour.density(f) * kStep_hz;
    }
    // A soft end at 1 or 1.3 Hz in place of a sharp one or of none: 2 % of the power; the rate counts what is fast.
    EXPECT_NEAR(power, 1.0, 0.02) << colour.corner_hz << " " << colour.order;
    EXPECT_NEAR(rate, colour.rate_variance(), 0.2 * rate) << colour.corner_hz << " " << colour.order;
  }
}

TEST(NoiseFloor, RmsOfAStaticWheelIsTorqueNoiseOverStiffness) {
  NoiseFloor floor;
  floor.angle_variance = 1e-6;
  floor.torque_variance = 0;
  floor.slow_variance = 0.01;
  floor.slow_colour.corner_hz = 0.05;
  // Slow beside 2 Hz: the wheel follows, sd 0.1 Nm over 50 Nm/rad, and angle noise on top.
  const double expected = std::sqrt(1e-6 + std::pow(0.1 / 50, 2));
  EXPECT_NEAR(floor_rms_rad(floor, held_gain({0.1, 2.0, 50.0}), 0), expected, 0.01 * expected);
}

TEST(HeldOutSplit, PartsAreDisjointAndCoverTheWholeCourse) {
  Record record;
  for (int i = 0; i < 6000; ++i) record.time_s.push_back(0.01 * i);
  const std::vector<Block> blocks = held_out_split(record);
  std::vector<int> owner(6000, 0);
  double report = 0;
  for (const Block& block : blocks) {
    for (std::size_t i = block.first; i < block.first + block.count; ++i) owner[i] += 1;
    if (block.role == Block::Role::kReport) report += static_cast<double>(block.count);
  }
  EXPECT_EQ(*std::max_element(owner.begin(), owner.end()), 1);
  EXPECT_NEAR(report / 6000, 0.25, 0.03);
  EXPECT_EQ(blocks.size(), 9U);  // three cycles of 20 s
}

TEST(HeldOutSplit, PartsChangePlaces) {
  Record record;
  for (int i = 0; i < 6000; ++i) record.time_s.push_back(0.01 * i);
  std::vector<int> reports(6000, 0);
  for (const std::size_t turn : {0U, 1U, 2U}) {
    for (const Block& block : held_out_split(record, turn)) {
      if (block.role != Block::Role::kReport) continue;
      for (std::size_t i = block.first; i < block.first + block.count; ++i) reports[i] += 1;
    }
  }
  EXPECT_EQ(*std::max_element(reports.begin(), reports.end()), 1) << "what reported reports again";
  // Of three quarters of the record; the part that fits is the longer one.
  EXPECT_NEAR(std::accumulate(reports.begin(), reports.end(), 0.0) / 6000, 0.75, 0.03);
}

TEST(HeldOutSplit, ShortRecordsGetShortBlocksAndTinyOnesNone) {
  Record record;
  for (int i = 0; i < 800; ++i) record.time_s.push_back(0.01 * i);
  EXPECT_EQ(held_out_split(record).size(), 6U);
  record.time_s.resize(400);
  EXPECT_TRUE(held_out_split(record).empty());
}

TEST(FloorByRuns, IsTheClosedFormsOfALinearWheelAndLessBehindAHardeningSpring) {
  NoiseFloor floor;
  floor.angle_variance = 1e-7;
  floor.torque_variance = 0.02 * 0.02;
  floor.slow_variance = 0.05 * 0.05;
  floor.slow_colour = {0.3, 2};
  Simulation simulation;
  simulation.wheel = {0.1, 1.0, 6.0};
  Record record;
  for (int i = 0; i < 8000; ++i) {
    record.time_s.push_back(0.01 * i);
    record.torque_driver_nm.push_back(1.5 * std::sin(2 * std::numbers::pi * 0.3 * 0.01 * i));
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(0);
  }
  const std::vector<RunStretch> whole = {{0, record.size(), WheelState{}}};
  const auto by_runs = [&] {
    return floor_by_runs_rad(simulation, record, whole, restarted_run(simulation, record, whole), floor,
                             test::seed(13));
  };
  const double linear = by_runs().value();
  // Six draws of 80 s in a band of 0.3 Hz are some 290 degrees of freedom: 4 % of the rms, four times that allowed.
  const double closed_form = floor_rms_rad(floor, held_gain(simulation.wheel), 0);
  EXPECT_NEAR(linear, closed_form, 0.16 * closed_form);
  // A spring of C + 3 C3 x^2 moves less: with x = 0.2 rad rms and C3 = 100, three times as stiff.
  Effect cubic(effect::cubic_stiffness);
  cubic.values[0] = 100;
  simulation.effects = {cubic};
  EXPECT_LT(by_runs().value(), 0.75 * linear);
}

}  // namespace
}  // namespace steerid::gap
