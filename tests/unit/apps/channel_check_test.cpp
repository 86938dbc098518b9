// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Sensors of a column that are given as other channels, or do not agree, on simulated drives whose wheel is known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "apps/answers.hpp"
#include "apps/channel_words.hpp"
#include "apps/first_look.hpp"
#include "apps/identification_json.hpp"
#include "apps/identification_table.hpp"
#include "backend/simulated_column.hpp"
#include "plant/driving_torques.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

struct Driver {
  std::string what;
  double steering_rad;
  double stiffness_nm_per_rad;
  double probe_nm;
};

const std::vector<Driver> kDrivers = {{"holds still", 0, 30, 1},
                                      {"keeps the lane", 0.05, 20, 1},
                                      {"steers", 0.15, 12, 0.6},
                                      {"steers without a probe", 0.15, 12, 0}};

Record drive(const Driver& driver, std::uint64_t seed) {
  ColumnScenario what;
  what.drive.arm = {0.1, 1.45, driver.stiffness_nm_per_rad};
  what.drive.steering_rad = driver.steering_rad;
  what.drive.probe = {.rms_nm = driver.probe_nm, .high_hz = 6, .random_phases = seed};
  what.drive.seed = seed;
  ColumnDrive result;
  SimulatedColumnHal hal(what, &result);
  while (hal.wait_tick() == Status::kOk) {
  }
  return result.measured;
}

/// The record of who has no better names for these two.
Record as_torques(const Record& record, const std::vector<double>& driver, const std::vector<double>& motor) {
  Record named;
  named.time_s = record.time_s;
  named.angle_rad = record.angle_rad;
  named.torque_driver_nm = driver;
  named.torque_motor_nm = motor;
  return named;
}

TEST(WheelBetween, IsTheWheelWhateverTheDriverDoes) {
  const std::uint64_t seed = test::seed(91);
  const Column truth;
  for (const Driver& driver : kDrivers) {
    SCOPED_TRACE(driver.what);
    double inertia_z = 0, damping_z = 0;
    constexpr int kDrives = 20;
    for (int i = 0; i < kDrives; ++i) {
      const WheelBetween wheel = wheel_between(drive(driver, seed + static_cast<std::uint64_t>(i)));
      ASSERT_EQ(wheel.verdict, WheelBetween::Verdict::kAgree) << wheel_words(wheel);
      inertia_z += std::pow((wheel.fit.inertia.value - truth.wheel_inertia_kgm2) / wheel.fit.inertia.sd, 2);
      damping_z += std::pow((wheel.fit.damping.value - truth.wheel_damping_nms_per_rad) / wheel.fit.damping.sd, 2);
      EXPECT_NEAR(wheel.fit.inertia.value, truth.wheel_inertia_kgm2, 0.15 * truth.wheel_inertia_kgm2);
    }
    // Its deviations are the ones that it states, within a factor of two.
    EXPECT_LT(std::sqrt(inertia_z / kDrives), 2);
    EXPECT_GT(std::sqrt(inertia_z / kDrives), 0.4);
    EXPECT_LT(std::sqrt(damping_z / kDrives), 2);
  }
}

TEST(WheelBetween, TellsSensorsThatDoNotAgree) {
  const std::uint64_t seed = test::seed(92);
  using Verdict = WheelBetween::Verdict;
  for (const Driver& driver : kDrivers) {
    SCOPED_TRACE(driver.what);
    const Record record = drive(driver, seed);
    const auto verdict = [&](auto change) {
      Record changed = record;
      change(changed);
      return wheel_between(changed).verdict;
    };
    EXPECT_EQ(verdict([](Record& r) { std::swap(r.torque_bar_nm, r.torque_rim_nm); }), Verdict::kSwapped);
    EXPECT_EQ(verdict([](Record& r) { r.torque_rim_nm = r.torque_bar_nm; }), Verdict::kSame);
    const auto scaled = [&](double factor) {
      return verdict([&](Record& r) {
        for (double& torque : r.torque_bar_nm) torque *= factor;
      });
    };
    EXPECT_EQ(scaled(-1), Verdict::kOpposed);
    EXPECT_EQ(scaled(1.3), Verdict::kDisagree);
    EXPECT_EQ(scaled(0.7), Verdict::kDisagree);
    EXPECT_EQ(scaled(1), Verdict::kAgree);
  }
}

TEST(FirstLook, NamesTheChannelsOfRimAndBar) {
  const std::uint64_t seed = test::seed(93);
  for (const Driver& driver : kDrivers) {
    SCOPED_TRACE(driver.what);
    const Record record = drive(driver, seed);
    const std::string doubt = first_look(as_torques(record, record.torque_rim_nm, record.torque_bar_nm), {}).doubt;
    EXPECT_NE(doubt.find("these are the hand's torque on the rim and the torsion bar"), std::string::npos) << doubt;
    EXPECT_NE(doubt.find("--columns torque_rim=COLUMN,torque_bar=COLUMN"), std::string::npos) << doubt;
    const std::string other = first_look(as_torques(record, record.torque_bar_nm, record.torque_rim_nm), {}).doubt;
    EXPECT_NE(other.find("these are the torsion bar and the hand's torque on the rim"), std::string::npos) << other;
    EXPECT_EQ((doubt + other).find("--sign"), std::string::npos);
  }
}

/// A bar or a rim beside the motor below it: whatever is said names torque_bar.
TEST(FirstLook, NamesTheChannelOfABarBesideItsMotor) {
  const std::uint64_t seed = test::seed(94);
  for (const Driver& driver : kDrivers) {
    SCOPED_TRACE(driver.what);
    const Record record = drive(driver, seed);
    for (const auto* reading : {&record.torque_bar_nm, &record.torque_rim_nm}) {
      const FirstLook look = first_look(as_torques(record, *reading, record.torque_motor_nm), {});
      EXPECT_NE(look.doubt.find("--columns torque_bar=COLUMN"), std::string::npos) << look.doubt;
    }
  }
}

TEST(FirstLook, ABarGivenAsTheDriversTorqueIsAnAnswerNotACause) {
  const std::uint64_t seed = test::seed(95);
  const Record record = drive(kDrivers[0], seed);
  const FirstLook look =
      first_look(as_torques(record, record.torque_bar_nm, std::vector<double>(record.size(), 0.0)), {});
  EXPECT_NE(look.doubt.find("answers the wheel's motion with, not what moves it"), std::string::npos) << look.doubt;
  EXPECT_NE(look.doubt.find("--columns torque_bar=COLUMN"), std::string::npos) << look.doubt;
}

TEST(FirstLook, AcceptsACarsSensorsAndDoubtsThoseThatContradict) {
  const std::uint64_t seed = test::seed(96);
  for (const Driver& driver : kDrivers) {
    SCOPED_TRACE(driver.what);
    Record record = drive(driver, seed);
    const FirstLook look = first_look(record, {});
    EXPECT_EQ(look.doubt, "");
    ASSERT_EQ(look.notes.size(), 1U);
    EXPECT_NE(look.notes[0].find("torque_rim and torque_bar agree"), std::string::npos);
    EXPECT_EQ(look.units.parameter(), 1.0);
    std::swap(record.torque_bar_nm, record.torque_rim_nm);
    EXPECT_NE(first_look(record, {}).doubt.find("negative inertia"), std::string::npos);
  }
  Record record = drive(kDrivers[1], seed + 1);
  record.torque_driver_nm = record.torque_rim_nm;
  record.channels = kAngleValid | kTorqueDriverValid | kTorqueRimValid;
  EXPECT_NE(first_look(record, {}).doubt.find("torque_driver and torque_rim are one signal"), std::string::npos);
}

TEST(FirstLook, RefusesABarAndARimThatAreTurnedRound) {
  const std::uint64_t seed = test::seed(98);
  for (const Driver& driver : kDrivers) {
    SCOPED_TRACE(driver.what);
    for (const std::uint8_t channel : {kTorqueBarValid, kTorqueRimValid}) {
      Record record = drive(driver, seed);
      record.channels = static_cast<std::uint8_t>(kAngleValid | kProbeValid | channel);
      EXPECT_EQ(first_look(record, {}).doubt, "");
      for (double& torque_nm : channel == kTorqueBarValid ? record.torque_bar_nm : record.torque_rim_nm) {
        torque_nm = -torque_nm;
      }
      const std::string doubt = first_look(record, {}).doubt;
      const bool probed = driver.probe_nm > 0;  // without a probe a driver who steers makes a negative arm as well
      EXPECT_EQ(doubt.find(std::string("use --sign ") + channel_name(channel)) != std::string::npos, probed) << doubt;
    }
  }
}

TEST(Batch, OfACarsRecordIsRightWhereTheDriverSteers) {
  const std::uint64_t seed = test::seed(99);
  for (const Driver& driver : kDrivers) {
    SCOPED_TRACE(driver.what);
    const Record record = drive(driver, seed);
    const Identification found = batch_answer(record, false).found;
    const auto json = identification_json(found, std::nullopt);
    EXPECT_TRUE(json.at("free_run_nrmse").is_null());
    EXPECT_EQ(json.at("probe_driven_nrmse").is_null(), driver.probe_nm == 0);
    if (driver.probe_nm == 0) {
      EXPECT_EQ(found.method, "batch_by_torque_alone");
      EXPECT_EQ(found.stiffness_nm_per_rad.state, ParameterState::kNotExcited);
      continue;
    }
    EXPECT_EQ(found.method, "batch_instrumental_variables");
    // One drive each: 3.5 deviations are exceeded by one number in two thousand.
    EXPECT_NEAR(found.inertia_kgm2.value, 0.1, 3.5 * found.inertia_kgm2.sd);
    EXPECT_NEAR(found.damping_nms_per_rad.value, 1.45, 3.5 * found.damping_nms_per_rad.sd);
    EXPECT_NEAR(found.stiffness_nm_per_rad.value, driver.stiffness_nm_per_rad, 3.5 * found.stiffness_nm_per_rad.sd);
    EXPECT_EQ(found.inertia_kgm2.state, ParameterState::kValid);
    EXPECT_LT(found.driven->nrmse, 3 * found.driven->by_noise);
    EXPECT_NE(identification_table(found).find("probe-driven NRMSE"), std::string::npos);
  }
}

TEST(DrivingTorques, AreTheBarWhereverThereIsOne) {
  const Record record = drive(kDrivers[1], test::seed(100));
  const Record by_bar = with_driving_torques(record);
  EXPECT_EQ(by_bar.torque_motor_nm, record.torque_bar_nm);
  EXPECT_FALSE(by_bar.has(kTorqueDriverValid));  // nobody knows what the driver does
  EXPECT_EQ(by_bar.motor_channel, kTorqueBarValid);
  EXPECT_EQ(by_bar.net_torque_nm(), record.net_torque_nm());
  Record known = record;  // the motor below the bar is no input, whoever knows the driver
  known.channels |= kTorqueDriverValid;
  known.torque_driver_nm.assign(known.size(), 0.5);
  EXPECT_EQ(with_driving_torques(known).torque_motor_nm, known.torque_bar_nm);
  EXPECT_EQ(with_driving_torques(known).torque_driver_nm, known.torque_driver_nm);
  Record rim = record;
  rim.channels &= static_cast<std::uint8_t>(~kTorqueBarValid);
  EXPECT_EQ(with_driving_torques(rim).torque_motor_nm, record.torque_rim_nm);
  const Record again = with_driving_torques(by_bar);
  EXPECT_EQ(again.torque_motor_nm, by_bar.torque_motor_nm);
  EXPECT_EQ(again.motor_channel, kTorqueBarValid);
}

TEST(DrivingTorques, AreSaidWhereTheDriversOwnIsMissing) {
  Record record = drive(kDrivers[2], test::seed(101));
  EXPECT_NE(driving_words(record).find("driven by torque_bar alone"), std::string::npos);
  EXPECT_NE(own_torque_words(record).find("of torque_bar's power below 2 Hz 100 %"), std::string::npos)
      << own_torque_words(record);
  const std::string at_rest = own_torque_words(drive(kDrivers[0], test::seed(102)));
  EXPECT_NE(at_rest.find("below 2 Hz 0 %"), std::string::npos) << at_rest;
  record.channels |= kTorqueDriverValid;
  EXPECT_EQ(driving_words(record), "");
  EXPECT_EQ(own_torque_words(record), "");
}

TEST(Equation, IsInEveryOutput) {
  const std::uint64_t seed = test::seed(97);
  const Record record = drive(kDrivers[1], seed);
  const FirmwareRun run = run_firmware(record, Scalar::kFloat, {});
  const Answer answer = recursive_answer(record, run, false);
  const auto json = identification_json(answer.found, std::nullopt);
  EXPECT_EQ(json.at("equation"), "bar");
  EXPECT_EQ(json.at("wheel").at("sensors_agree"), true);
  EXPECT_NEAR(json.at("wheel").at("inertia_kgm2").at("value").get<double>(), 0.034, 0.004);
  EXPECT_NE(identification_table(answer.found).find("Tv - T_bar = J th''"), std::string::npos);
  Record paper = as_torques(record, record.torque_rim_nm, record.torque_bar_nm);
  const Answer old = recursive_answer(paper, run_firmware(paper, Scalar::kFloat, {}), false);
  EXPECT_EQ(identification_json(old.found, std::nullopt).at("equation"), "driver_motor");
  EXPECT_FALSE(identification_json(old.found, std::nullopt).contains("wheel"));
}

}  // namespace
}  // namespace steerid
