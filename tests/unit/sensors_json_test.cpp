// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "sensors/sensors_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

SensorDefects parse(const std::string& text) { return sensors_from_json(nlohmann::json::parse(text), "sim.json"); }

std::string complaint(const std::string& text) {
  try {
    (void)parse(text);
  } catch (const BadInput& bad) {
    return bad.what();
  }
  return "accepted";
}

TEST(SensorsJson, NamesEveryDefectOfAChannel) {
  const SensorDefects d = parse(R"({"angle": {
      "lag": {"time_constant_s": 0.004}, "delay": {"delay_s": 0.0125}, "gain": {"factor": 1.02},
      "bias": {"offset_rad": 0.1, "drift_rad_per_s": -0.001}, "noise": {"sd_rad": 0.0007},
      "saturation": {"limit_rad": 2.5}, "resolution": {"step_rad": 0.0005},
      "dropout": {"fraction": 0.02, "mean_run": 3, "flagged": true, "onset_s": 5},
      "stuck": {"onset_s": 30, "length_s": 2}}})");
  EXPECT_EQ(d.angle.lag.time_constant_s, 0.004);
  EXPECT_EQ(d.angle.delay.delay_us, 12'500);
  EXPECT_EQ(d.angle.gain.factor, 1.02);
  EXPECT_EQ(d.angle.bias.offset, 0.1);
  EXPECT_EQ(d.angle.bias.drift_per_s, -0.001);
  EXPECT_EQ(d.angle.noise.sd, 0.0007);
  EXPECT_EQ(d.angle.saturation.limit, 2.5);
  EXPECT_EQ(d.angle.resolution.step, 0.0005);
  EXPECT_EQ(d.angle.dropout.fraction, 0.02);
  EXPECT_EQ(d.angle.dropout.mean_run, 3);
  EXPECT_TRUE(d.angle.dropout.flagged);
  EXPECT_EQ(d.angle.dropout.during.onset_s, 5);
  EXPECT_EQ(d.angle.stuck.during.onset_s, 30);
  EXPECT_EQ(d.angle.stuck.during.length_s, 2);
  // Nothing spreads to the other channels.
  EXPECT_EQ(d.torque_driver.noise.sd, 0);
  EXPECT_EQ(d.torque_motor.gain.factor, 1);
}

TEST(SensorsJson, NamesTorquesInNewtonMetresAndWhatConcernsAllChannels) {
  const SensorDefects d = parse(R"({"torque_driver": {"noise": {"sd_nm": 0.03}},
      "torque_motor": {"saturation": {"limit_nm": 4}},
      "jitter": {"spread_s": 0.002, "stamped": false}, "message_loss": {"fraction": 0.01, "mean_run": 2}})");
  EXPECT_EQ(d.torque_driver.noise.sd, 0.03);
  EXPECT_EQ(d.torque_motor.saturation.limit, 4);
  EXPECT_EQ(d.jitter.spread_us, 2'000);
  EXPECT_FALSE(d.jitter.stamped);
  EXPECT_EQ(d.message_loss.fraction, 0.01);
  EXPECT_EQ(d.message_loss.mean_run, 2);
}

TEST(SensorsJson, RefusesWhatItDoesNotUnderstand) {
  EXPECT_EQ(complaint(R"({"angle": {"noise": {"sd_nm": 1}}})"),
            "sim.json, at /sensors/angle/noise/sd_nm: expected one of sd_rad, onset_s, length_s, found \"sd_nm\"");
  EXPECT_EQ(complaint(R"({"angle": {"noise": {"sd_rad": -1}}})"),
            "sim.json, at /sensors/angle/noise/sd_rad: expected a number from 0 to 1000000, found -1");
  EXPECT_EQ(complaint(R"({"jitter": {"stamped": 1}})"),
            "sim.json, at /sensors/jitter/stamped: expected true or false, found 1");
  EXPECT_EQ(complaint(R"([1])"), "sim.json, at /sensors: expected an object in braces, found [1]");
  EXPECT_EQ(complaint(R"({"angle": {"delay": {"delay_s": 0.6}}})"),
            "sim.json, at /sensors/angle/delay/delay_s: expected a number from 0 to 0.5, found 0.6");
  EXPECT_EQ(complaint(R"({"angel": {}})"),
            "sim.json, at /sensors/angel: expected one of torque_driver, torque_motor, angle, jitter, message_loss, "
            "found \"angel\"");
}

}  // namespace
}  // namespace steerid
