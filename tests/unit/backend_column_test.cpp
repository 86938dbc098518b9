// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The simulated column behind the port: what the channels and the truth beside them say of each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "backend/simulated_column.hpp"
#include "sensors/sensors_json.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

ColumnScenario scenario() {
  ColumnScenario scenario;
  scenario.drive.arm = {0.1, 1.45, 20};
  scenario.drive.probe.rms_nm = 1;
  scenario.drive.seed = test::seed(81);
  scenario.duration_s = 30;
  return scenario;
}

ColumnDrive drive(const ColumnScenario& scenario) {
  ColumnDrive result;
  SimulatedColumnHal hal(scenario, &result);
  while (hal.wait_tick() == Status::kOk) {
  }
  return result;
}

double rms(const std::vector<double>& x) {
  double squares = 0;
  for (const double value : x) squares += value * value;
  return std::sqrt(squares / static_cast<double>(x.size()));
}

/// Rate and acceleration of the angle at i by differences of fourth order.
double rate(const std::vector<double>& x, std::size_t i) {
  return (x[i - 2] - 8 * x[i - 1] + 8 * x[i + 1] - x[i + 2]) / (12 * kTickS);
}
double acceleration(const std::vector<double>& x, std::size_t i) {
  return (-x[i - 2] + 16 * x[i - 1] - 30 * x[i] + 16 * x[i + 1] - x[i + 2]) / (12 * kTickS * kTickS);
}

/// The equations of docs/theory.md, row by row: above the bar, and the wheel alone.
TEST(SimulatedColumn, TruthAndChannelsSatisfyTheEquations) {
  ColumnScenario what = scenario();
  what.drive.manoeuvre = Manoeuvre::kCurves;
  what.drive.change = {.course = ArmCourse::kRamp, .stiffness_nm_per_rad = 45, .at_s = 10, .length_s = 5};
  const ColumnDrive result = drive(what);
  const Record& record = result.undisturbed;
  ASSERT_EQ(record.size(), 3000U);
  ASSERT_EQ(result.truth.size(), record.size());
  std::vector<double> above, wheel;
  for (std::size_t i = 2; i + 2 < record.size(); ++i) {
    const WheelArm& arm = result.truth[i].arm;
    const double speed = rate(record.angle_rad, i);
    const double turning = acceleration(record.angle_rad, i);
    above.push_back(arm.inertia_kgm2 * turning + arm.damping_nms_per_rad * speed +
                    arm.stiffness_nm_per_rad * record.angle_rad[i] -
                    (result.truth[i].torque_driver_nm - record.torque_bar_nm[i]));
    wheel.push_back(what.column.wheel_inertia_kgm2 * turning + what.column.wheel_damping_nms_per_rad * speed -
                    (record.torque_rim_nm[i] - record.torque_bar_nm[i]));
  }
  // What differences of fourth order make of a column that sticks and slips.
  EXPECT_LT(rms(above), 0.01 * rms(record.torque_bar_nm));
  EXPECT_LT(rms(wheel), 0.01 * rms(record.torque_bar_nm));
  EXPECT_DOUBLE_EQ(result.truth.back().arm.stiffness_nm_per_rad, 45);
}

TEST(SimulatedColumn, ASampleHasTheChannelsOfACar) {
  SimulatedColumnHal hal(scenario());
  Sample sample;
  ASSERT_EQ(hal.wait_tick(), Status::kOk);
  ASSERT_EQ(hal.read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.valid_bits, kAngleValid | kTorqueMotorValid | kTorqueBarValid | kTorqueRimValid | kProbeValid);
  EXPECT_EQ(hal.read_sample(sample), Status::kNoData);
}

TEST(SimulatedColumn, SensorsAddWhatTheySay) {
  ColumnScenario what = scenario();
  what.sensors = ColumnSensorDefects::none();
  what.sensors.torque_bar.noise.sd = 0.03;
  const ColumnDrive noisy = drive(what);
  std::vector<double> error(noisy.measured.size());
  for (std::size_t i = 0; i < error.size(); ++i) {
    error[i] = noisy.measured.torque_bar_nm[i] - noisy.undisturbed.torque_bar_nm[i];
    ASSERT_EQ(noisy.measured.torque_rim_nm[i], noisy.undisturbed.torque_rim_nm[i]);
    ASSERT_EQ(noisy.measured.angle_rad[i], noisy.undisturbed.angle_rad[i]);
    ASSERT_EQ(noisy.measured.torque_driver_nm[i], 0);
  }
  EXPECT_NEAR(rms(error), 0.03, 0.002);
}

TEST(SimulatedColumn, TheMotorDeliversTheProbeLateSmallerAndClipped) {
  for (const double delay_s : {0.0, 0.02, 0.1}) {
    ColumnScenario what = scenario();
    what.column.assist_gain = 0;
    what.column.probe_gain = 0.7;
    what.column.probe_delay_s = delay_s;
    what.column.motor_limit_nm = 1;
    what.sensors = ColumnSensorDefects::none();
    const ColumnDrive result = drive(what);
    const auto behind = static_cast<std::size_t>(std::lround(delay_s / kTickS));
    std::size_t clipped = 0;
    for (std::size_t i = behind; i < result.measured.size(); ++i) {
      const double wanted = 0.7 * result.measured.probe_nm[i - behind];
      ASSERT_NEAR(result.measured.torque_motor_nm[i], std::clamp(wanted, -1.0, 1.0), 1e-9) << delay_s << " s, " << i;
      clipped += std::abs(wanted) > 1 ? 1 : 0;
    }
    EXPECT_GT(clipped, 100U);
  }
}

/// Between two ticks, too: the probe is a sine of known delay.
TEST(SimulatedColumn, ADelayOfHalfATickIsOne) {
  ColumnScenario what = scenario();
  what.column.assist_gain = 0;
  what.column.probe_delay_s = 0.015;
  what.sensors = ColumnSensorDefects::none();
  what.drive.probe = {.rms_nm = 1, .low_hz = 1, .high_hz = 1, .period_s = 1};
  const ColumnDrive result = drive(what);
  for (std::size_t i = 100; i < 200; ++i) {
    const double phase = 2 * std::numbers::pi * (0.01 * static_cast<double>(i) - 0.015);
    const double in_phase = result.measured.probe_nm[100];    // at whole seconds
    const double quadrature = result.measured.probe_nm[125];  // a quarter later
    ASSERT_NEAR(result.measured.torque_motor_nm[i], in_phase * std::cos(phase) + quadrature * std::sin(phase), 1e-5);
  }
}

TEST(SimulatedColumn, GrantsWhatTheTaskRequestsWhenItIsTold) {
  for (const bool granted : {false, true}) {
    ColumnScenario what = scenario();
    what.drive.probe.rms_nm = 0;
    what.grant_probe_requests = granted;
    what.sensors = ColumnSensorDefects::none();
    ColumnDrive result;
    SimulatedColumnHal hal(what, &result);
    for (int i = 0; i < 10; ++i) {
      ASSERT_EQ(hal.wait_tick(), Status::kOk);
      EXPECT_EQ(hal.request_probe_torque(500), Status::kOk);
    }
    EXPECT_NEAR(result.measured.probe_nm.back(), granted ? 0.5 : 0.0, 1e-12);
    EXPECT_EQ(hal.request_probe_torque(5'001), Status::kOutOfRange);
  }
}

TEST(SimulatedColumn, RepeatsItselfBitForBit) {
  const ColumnDrive once = drive(scenario());
  const ColumnDrive again = drive(scenario());
  EXPECT_EQ(once.measured.torque_bar_nm, again.measured.torque_bar_nm);
  EXPECT_EQ(once.measured.angle_rad, again.measured.angle_rad);
  ColumnScenario other = scenario();
  ++other.drive.seed;
  EXPECT_NE(drive(other).measured.torque_bar_nm, once.measured.torque_bar_nm);
}

TEST(ColumnSensors, AreReadFromTheColumnsFile) {
  const auto sensors = nlohmann::json::parse(
      R"({"torque_bar": {"noise": {"sd_nm": 0.04}}, "probe": {"delay": {"delay_s": 0.01}},
          "angle": {"resolution": {"step_rad": 0.002}}, "message_loss": {"fraction": 0.1}})");
  const ColumnSensorDefects read = column_sensors_from_json(sensors, "column.json");
  EXPECT_EQ(read.torque_bar.noise.sd, 0.04);
  EXPECT_EQ(read.probe.delay.delay_us, 10'000);
  EXPECT_EQ(read.wheel.angle.resolution.step, 0.002);
  EXPECT_EQ(read.wheel.message_loss.fraction, 0.1);
  EXPECT_THROW((void)column_sensors_from_json(nlohmann::json::parse(R"({"torque_driver": {}})"), "column.json"),
               std::runtime_error);
}

}  // namespace
}  // namespace steerid
