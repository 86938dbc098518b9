// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Two simulated drives, byte for byte. README.md beside this file says how to write the traces anew.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "backend/simulated.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

/// Every tenth sample as the port delivers it. Integers: no formatting of doubles is part of the comparison.
std::string trace(const Scenario& scenario) {
  SimulatedHal hal(scenario);
  std::string text = "stamp_us,torque_driver_mnm,torque_motor_mnm,angle_urad,sequence,valid_bits\n";
  Sample sample;
  for (int tick = 0; hal.wait_tick() == Status::kOk; ++tick) {
    const bool received = hal.read_sample(sample) == Status::kOk;
    if (tick % 10 != 0) continue;
    text += received ? fmt::format("{},{},{},{},{},{}\n", sample.stamp_us, sample.torque_driver_mnm,
                                   sample.torque_motor_mnm, sample.angle_urad, sample.sequence, sample.valid_bits)
                     : fmt::format("lost at tick {}\n", tick);
  }
  return text;
}

void expect_unchanged(const std::string& file, const std::string& now) {
  const std::string path = std::string(TRACES) + "/" + file;
  if (std::getenv("STEERID_WRITE_TRACES") != nullptr) {
    std::ofstream(path, std::ios::binary) << now;
    GTEST_SKIP() << "wrote " << path << "; nothing was compared";
  }
  std::ifstream stream(path, std::ios::binary);
  ASSERT_TRUE(stream) << path << " cannot be read";
  std::istringstream kept_lines((std::stringstream() << stream.rdbuf()).str());
  std::istringstream now_lines(now);
  std::string kept_line;
  std::string now_line;
  for (int line = 1; std::getline(kept_lines, kept_line); ++line) {
    ASSERT_TRUE(std::getline(now_lines, now_line))
        << path << " goes on at line " << line << ", the simulation does not";
    ASSERT_EQ(kept_line, now_line) << path << ", line " << line;
  }
  ASSERT_FALSE(std::getline(now_lines, now_line)) << path << " ends before the simulation";
}

TEST(SimulatedTraces, PassiveWithProbeAndDryFriction) {
  Scenario scenario;
  scenario.task = task_settings(TaskKind::kPassive, HandPosition::kRight130, 20'180'301);
  scenario.task.probe.rms_nm = 1.0;
  scenario.task.unmeasured_percent = 2.0;
  scenario.wheel = scenario.task.arm;
  scenario.effects.emplace_back(effect::coulomb_friction);
  scenario.effects.emplace_back(effect::lag);
  expect_unchanged("passive_friction.csv", trace(scenario));
}

TEST(SimulatedTraces, ActiveWithFaultySensors) {
  Scenario scenario;
  scenario.task = task_settings(TaskKind::kActive, HandPosition::kBoth3And9, 20'180'302);
  scenario.task.eps = EpsTorque::kHeld;
  scenario.wheel = scenario.task.arm;
  SensorDefects& sensors = scenario.sensors;
  sensors.jitter.spread_us = 1'500;
  sensors.message_loss = {.fraction = 0.02, .mean_run = 3, .flagged = false, .during = {}};
  sensors.angle.lag.time_constant_s = 0.004;
  sensors.angle.delay.delay_us = 7'300;
  sensors.angle.stuck.during = {.onset_s = 20.0, .length_s = 1.5};
  sensors.torque_driver.gain.factor = 1.02;
  sensors.torque_driver.saturation.limit = 9.0;
  sensors.torque_motor.bias = {.offset = 0.1, .drift_per_s = 0.001, .during = {.onset_s = 30.0, .length_s = 20.0}};
  sensors.torque_motor.dropout = {.fraction = 0.05, .mean_run = 2, .flagged = true, .during = {}};
  expect_unchanged("active_faulty_sensors.csv", trace(scenario));
}

}  // namespace
}  // namespace steerid
