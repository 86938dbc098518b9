// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The daemon's config file: what it means, and what is said of a wrong one.
#include "linux_ecu/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "linux_gpiod/failure.hpp"

namespace steerid::linux_ecu {
namespace {

using linux_gpiod::Bias;
using linux_gpiod::Failure;
using testing::HasSubstr;

/// What is said of `text`, which must be refused.
std::string complaint(const std::string& text) {
  try {
    static_cast<void>(parse_config(text, "ecu.json"));
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "accepted";
}

TEST(EcuConfig, TheExampleHasEveryKey) {
  const Config config = read_config(STEERID_EXAMPLE_CONFIG);
  EXPECT_EQ(config.can, "can0");
  EXPECT_EQ(config.state_file, "/var/lib/steerid/estimate");
  EXPECT_EQ(config.wheel, 1U);
  EXPECT_EQ(config.priority, 50);
  EXPECT_EQ(config.channels, kAngleValid | kTorqueBarValid | kTorqueMotorValid | kProbeValid);
  ASSERT_TRUE(config.lines.sample_ready && config.lines.probe_enable && config.lines.valid && config.lines.fault);
  ASSERT_TRUE(config.lines.heartbeat);
  EXPECT_EQ(config.lines.sample_ready->chip, "gpiochip0");
  EXPECT_EQ(config.lines.sample_ready->offset, 4U);
  EXPECT_EQ(config.lines.sample_ready->bias, Bias::kPullDown);
  EXPECT_EQ(config.lines.heartbeat->name, "HEARTBEAT_TO_EPS");
  EXPECT_EQ(config.lines.heartbeat->chip, "");
}

TEST(EcuConfig, OnlyTheCanInterfaceIsRequired) {
  const Config config = parse_config(R"({"can": "vcan0"})", "ecu.json");
  EXPECT_EQ(config.can, "vcan0");
  EXPECT_FALSE(config.lines.valid);
  EXPECT_EQ(config.priority, 50);
  EXPECT_EQ(config.wheel, 1U);
  EXPECT_EQ(config.wheel_friction_nm, 0);
  EXPECT_EQ(config.channels, kEveryChannel);
}

TEST(EcuConfig, ChannelsThatIdentifyNothingAreRefused) {
  const auto with = [](const std::string& list) { return "{\"can\": \"can0\",\n\"channels\": " + list + "}"; };
  EXPECT_EQ(complaint(with(R"(["torque_rim"])")), "accepted");
  EXPECT_EQ(complaint(with(R"(["torque_motor", "torque_driver"])")), "accepted");
  EXPECT_THAT(complaint(with(R"(["probe", "torque_motor"])")), HasSubstr("ecu.json:2: channels identifies nothing"));
  EXPECT_THAT(complaint(with("[]")), HasSubstr("channels identifies nothing; name torque_bar"));
  EXPECT_THAT(complaint(with(R"(["torque_bus"])")), HasSubstr("channels must be a list such as"));
  EXPECT_THAT(complaint(with(R"("torque_bar")")), HasSubstr("channels must be a list such as"));
  EXPECT_THAT(complaint(with("[3]")), HasSubstr("channels must be a list such as"));
}

TEST(EcuConfig, EveryComplaintNamesFileLineAndKeyAndSaysWhatToDo) {
  EXPECT_THAT(complaint("{}"), HasSubstr("ecu.json:1: needs \"can\""));
  EXPECT_THAT(complaint("{\n\"can\": 7}"), HasSubstr("ecu.json:2: can must be a text in quotes"));
  EXPECT_THAT(complaint("{\n\"can\": \"can0\"\n\"wheel\": 1}"), HasSubstr("ecu.json:3: is not JSON here"));
  EXPECT_THAT(complaint("{\"can\": \"can0\",\n\"wheel\": -1}"),
              HasSubstr("ecu.json:2: wheel must be a whole number from 0 to 4294967295"));
  EXPECT_EQ(parse_config(R"({"can": "can0", "wheel_friction_nm": 0.1})", "ecu.json").wheel_friction_nm, 0.1);
  for (const char* wrong : {"-0.1", "21", "\"0.1\"", "null"}) {
    EXPECT_THAT(complaint(std::string("{\"can\": \"can0\", \"wheel_friction_nm\": ") + wrong + "}"),
                HasSubstr("wheel_friction_nm must be a number from 0 to 20"));
  }
  EXPECT_THAT(complaint("{\"can\": \"can0\", \"priority\": 100}"), HasSubstr("priority must be"));
  EXPECT_THAT(complaint("{\"can\": \"can0\", \"priority\": 1e300}"), HasSubstr("priority must be"));
  EXPECT_THAT(complaint("{\"can\": \"can0\", \"wheel\": 18446744073709551615}"), HasSubstr("wheel must be"));
  EXPECT_THAT(complaint("{\"can\": \"a_name_of_16_chars\"}"), HasSubstr("at most 15"));
  EXPECT_THAT(complaint("[]"), HasSubstr("must be an object"));
  EXPECT_THAT(complaint("{\"can\": \"can0\",\n\n\"cam\": 1}"),
              HasSubstr("ecu.json:3: cam is not known here; known are can, lines"));
}

TEST(EcuConfig, ComplaintsAboutALineNameTheLine) {
  const auto with = [](const std::string& line) {
    return "{\"can\": \"can0\",\n\"lines\": {\n\"fault\": {\"chip\": \"gpiochip0\", \"line\": 1},\n\"valid\": " + line +
           "}}";
  };
  EXPECT_EQ(complaint(with(R"({"chip": "gpiochip0", "line": 3})")), "accepted");
  EXPECT_THAT(complaint(with(R"({"chip": "gpiochip0"})")), HasSubstr("ecu.json:4: lines.valid needs \"line\""));
  EXPECT_THAT(complaint(with(R"({"line": 3})")), HasSubstr("lines.valid needs \"chip\""));
  EXPECT_THAT(complaint(with(R"({"line": -3, "chip": "gpiochip0"})")), HasSubstr("lines.valid.line must be"));
  EXPECT_THAT(complaint(with(R"({"line": "", "chip": "gpiochip0"})")), HasSubstr("lines.valid.line must be"));
  EXPECT_THAT(complaint(with(R"({"line": "A", "active_low": 1})")), HasSubstr("active_low must be true or false"));
  EXPECT_THAT(complaint(with(R"({"line": "A", "bias": "up"})")), HasSubstr("\"pull-up\""));
  EXPECT_THAT(complaint(with("4")), HasSubstr("lines.valid must be an object"));
}

TEST(EcuConfig, AFileThatIsNotThereIsNamed) {
  EXPECT_THROW(
      {
        try {
          static_cast<void>(read_config("/no/such/ecu.json"));
        } catch (const Failure& failure) {
          EXPECT_THAT(failure.what(), HasSubstr("/no/such/ecu.json: No such file"));
          throw;
        }
      },
      Failure);
}

}  // namespace
}  // namespace steerid::linux_ecu
