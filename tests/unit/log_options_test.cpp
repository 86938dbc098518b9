// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "log/log_format.hpp"

namespace steerid::test {
namespace {

const ColumnChoice& choice(const ColumnChoices& choices, Channel channel) {
  return choices[static_cast<std::size_t>(channel)];
}

TEST(LogOptions, Columns) {
  const ColumnChoices choices = parse_columns(" time = t ms : ms,torque_motor=force_n,angle=theta:Deg");
  EXPECT_EQ(choice(choices, Channel::kTime).name, "t ms");
  EXPECT_EQ(choice(choices, Channel::kTime).unit, "ms");
  EXPECT_EQ(choice(choices, Channel::kTorqueMotor).name, "force_n");
  EXPECT_EQ(choice(choices, Channel::kTorqueMotor).unit, "");
  EXPECT_EQ(choice(choices, Channel::kAngle).unit, "Deg");
  EXPECT_EQ(choice(choices, Channel::kTorqueDriver).name, "");
}

TEST(LogOptions, EveryFormOfSign) {
  const Reversed none{};
  const Reversed torques = {false, true, true, false, true, true, true};
  const Reversed driver = {false, true, false, false};
  const Reversed motor_and_angle = {false, false, true, true};
  EXPECT_EQ(parse_sign("-1"), torques);
  EXPECT_EQ(parse_sign("torque_driver"), driver);
  EXPECT_EQ(parse_sign("-torque_driver"), driver);
  EXPECT_EQ(parse_sign("torque_driver=-1"), driver);
  EXPECT_EQ(parse_sign("torque_driver=-1, torque_motor = 1"), driver);
  EXPECT_EQ(parse_sign("torque_driver=1"), none);
  EXPECT_EQ(parse_sign(" torque_motor , -angle"), motor_and_angle);
  EXPECT_EQ(parse_sign("-torque_bar"), (Reversed{false, false, false, false, true, false, false}));
  EXPECT_EQ(parse_sign("torque_rim=-1,probe"), (Reversed{false, false, false, false, false, true, true}));
}

template <typename Parse>
std::string refusal(Parse parse, const std::string& text) {
  try {
    (void)parse(text);
  } catch (const BadOption& error) {
    return error.what();
  }
  return "was taken";
}

TEST(LogOptions, BadColumnsEachWithASentence) {
  const std::string known =
      "--columns: expected CHANNEL=COLUMN with CHANNEL one of time, torque_driver, torque_motor, angle, "
      "torque_bar, torque_rim, probe, found ";
  EXPECT_EQ(refusal(parse_columns, ""), known + "\"\"");
  EXPECT_EQ(refusal(parse_columns, "time"), known + "\"time\"");
  EXPECT_EQ(refusal(parse_columns, "speed=v"), known + "\"speed=v\"");
  EXPECT_EQ(refusal(parse_columns, "time=t,"), known + "\"\"");
  EXPECT_EQ(refusal(parse_columns, "time="), "--columns: expected time=COLUMN, found no column's name");
  EXPECT_EQ(refusal(parse_columns, "angle=:deg"), "--columns: expected angle=COLUMN, found no column's name");
  EXPECT_EQ(refusal(parse_columns, "time=t:min"),
            "--columns time=\"t\": expected one of the units s, ms, us after the colon, found \"min\"");
  EXPECT_EQ(refusal(parse_columns, "angle=a:nm"),
            "--columns angle=\"a\": expected one of the units rad, deg, mrad, urad, m after the colon, found \"nm\"");
  EXPECT_EQ(refusal(parse_columns, "time=a,time=b"), "--columns: expected each channel once, found time twice");
  EXPECT_EQ(refusal(parse_columns, "time=a,angle=a"), "--columns: expected each column once, found \"a\" twice");
}

TEST(LogOptions, BadSigns) {
  for (const std::string text :
       {"", "1", "-", "--angle", "time", "torque", "angle=2", "angle=", "-angle=-1", "angle,", "-1,angle", "=-1"}) {
    EXPECT_TRUE(refusal(parse_sign, text).starts_with("--sign: expected -1, or a list of")) << text;
  }
}

}  // namespace
}  // namespace steerid::test
