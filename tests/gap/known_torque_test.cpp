// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is known of torques behind their noise: of noise alone next to nothing, of a torque all but its noise.
#include "gap/preparation/known_torque.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "gap/drawn_drive.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr double kNoise_nm = 0.03;
constexpr std::size_t kSamples = 6000;

/// A driver's torque of time, with noise; the motor's channel is exact, and at rest.
Record torque_of(const std::function<double(double)>& torque_nm, std::uint64_t seed) {
  test::Noise noise(seed);
  Record record;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(torque_nm(t) + kNoise_nm * noise());
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(0);
  }
  return record;
}

double rms_off(const KnownTorque& known, const std::function<double(double)>& torque_nm) {
  double squares = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    squares += std::pow(known.record.torque_driver_nm[i] - torque_nm(known.record.time_s[i]), 2);
  }
  return std::sqrt(squares / kSamples);
}

double share_at(const KnownTorque& known, double f_hz) {
  const std::vector<double>& share = known.left.at(0).share;
  return share.at(static_cast<std::size_t>(std::lround(f_hz / 50 * static_cast<double>(share.size() - 1))));
}

TEST(KnownTorque, OfNoiseAloneIsNextToNothing) {
  const auto none = [](double) { return 0.0; };
  const KnownTorque known = known_torque(torque_of(none, test::seed(71)), kNoise_nm * kNoise_nm, 0);
  // Drawn apart, for lines of exponential power of which p is the largest of one's own and the mean of nine around: w
  // is 0.198 in the mean, and leaves 0.477 of the noise's rms. Some 330 such means are independent.
  double mean = 0;
  for (const double share : known.left.at(0).share) mean += share / static_cast<double>(known.left[0].share.size());
  EXPECT_NEAR(mean, 0.477 * 0.477, 0.04);
  EXPECT_NEAR(rms_off(known, none) / kNoise_nm, 0.477, 0.05);
}

TEST(KnownTorque, OfASineIsTheSineAndLittleOfTheNoise) {
  const auto sine = [](double t) { return std::cos(2 * std::numbers::pi * t); };  // ends where it begins
  const KnownTorque known = known_torque(torque_of(sine, test::seed(72)), kNoise_nm * kNoise_nm, 0);
  EXPECT_LT(rms_off(known, sine), 0.6 * kNoise_nm);  // 0.48 as above, and the lines around the sine
  EXPECT_GT(share_at(known, 1), 0.99);
}

TEST(KnownTorque, OfAProbesLinesIsAllThatStandsAlone) {
  // A sine of ten times the noise of its line: weighed by the lines around it would lose a tenth and more.
  const double amplitude_nm = kNoise_nm * std::sqrt(10 * 4.0 / kSamples);
  const auto sine = [&](double t) { return amplitude_nm * std::cos(2 * std::numbers::pi * 3 * t); };
  double left = 0;
  for (std::uint64_t draw = 0; draw < 20; ++draw) {
    const KnownTorque known = known_torque(torque_of(sine, test::seed(78) + draw), kNoise_nm * kNoise_nm, 0);
    for (std::size_t i = 0; i < kSamples; ++i) {
      left += known.record.torque_driver_nm[i] * sine(known.record.time_s[i]) * 2 /
              (amplitude_nm * amplitude_nm * kSamples) / 20;
    }
  }
  // 1 - v/p in the mean, 0.9; its draws stray by sqrt(v/2p) each.
  EXPECT_NEAR(left, 0.9, 4 * std::sqrt(0.05 / 20));
}

TEST(KnownTorque, OfABroadTorqueFarAboveTheNoiseIsAllThatWasRecorded) {
  test::Noise drawn(test::seed(73));
  std::vector<double> torque_nm(kSamples);
  for (double& one : torque_nm) one = drawn();
  const auto of_time = [&](double t) { return torque_nm[static_cast<std::size_t>(std::lround(t / 0.01))]; };
  const Record record = torque_of(of_time, test::seed(74));
  const KnownTorque known = known_torque(record, kNoise_nm * kNoise_nm, 0);
  // A share of v/(1 + v) is taken off: 0.0009 of a torque of one newton metre.
  for (std::size_t i = 0; i < kSamples; ++i) {
    ASSERT_NEAR(known.record.torque_driver_nm[i], record.torque_driver_nm[i], 0.01);
  }
  EXPECT_GT(share_at(known, 20), 0.99);
}

TEST(KnownTorque, SaysWhatItLeaves) {
  for (const double power : {0.25, 1.0, 5.0}) {  // of the noise's
    double left = 0;
    double said = 0;
    for (std::uint64_t draw = 0; draw < 10; ++draw) {
      test::Noise drawn(test::seed(79) + 100 * draw);
      std::vector<double> torque_nm(kSamples);
      for (double& one : torque_nm) one = kNoise_nm * std::sqrt(power) * drawn();
      const auto of_time = [&](double t) { return torque_nm[static_cast<std::size_t>(std::lround(t / 0.01))]; };
      const KnownTorque known = known_torque(torque_of(of_time, test::seed(80) + draw), kNoise_nm * kNoise_nm, 0);
      left += std::pow(rms_off(known, of_time) / kNoise_nm, 2) / 10;
      for (const double share : known.left.at(0).share)
        said += share / static_cast<double>(known.left[0].share.size()) / 10;
    }
    // The rule is within a tenth; of ten draws of some 330 independent weights a hundredth is chance.
    EXPECT_NEAR(said / left, 1, 0.11) << power;
  }
}

TEST(KnownTorque, ARampStaysWhatItIs) {
  const auto ramp = [](double t) { return 5.0 - t / 6; };
  const KnownTorque known = known_torque(torque_of(ramp, test::seed(75)), kNoise_nm * kNoise_nm, 0);
  // Its ends are known to 0.6 of the noise each, by three samples.
  EXPECT_LT(rms_off(known, ramp), 0.8 * kNoise_nm);
}

TEST(KnownTorque, OfAnExactChannelIsTheChannel) {
  Record record = torque_of([](double t) { return std::sin(t * t); }, test::seed(76));
  record.torque_motor_nm = record.torque_driver_nm;
  const KnownTorque known = known_torque(record, 0, 0);
  for (std::size_t i = 0; i < kSamples; ++i) {
    ASSERT_NEAR(known.record.torque_motor_nm[i], record.torque_motor_nm[i], 1e-12);
  }
  EXPECT_EQ(share_at(known, 5), 1.0);
}

TEST(KnownTorque, StretchesStandApart) {
  // Of the first stretch only noise is recorded, of the second a torque far above it.
  const auto later = [](double t) { return t < 30 ? 0.0 : std::sin(2 * std::numbers::pi * t); };
  Record record = torque_of(later, test::seed(77));
  for (std::size_t i = kSamples / 2; i < kSamples; ++i) record.time_s[i] += 7;
  const KnownTorque known = known_torque(record, kNoise_nm * kNoise_nm, 0);
  ASSERT_EQ(known.left.size(), 2U);
  EXPECT_EQ(known.left[0].end, kSamples / 2);
  EXPECT_EQ(known.left[1].first, kSamples / 2);
  double squares = 0;
  for (std::size_t i = 0; i < kSamples / 2; ++i) squares += std::pow(known.record.torque_driver_nm[i], 2);
  EXPECT_LT(std::sqrt(squares / (kSamples / 2.0)), 0.6 * kNoise_nm);
}

}  // namespace
}  // namespace steerid::gap
