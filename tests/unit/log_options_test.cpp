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

TEST(LogOptions, CountsHaveAScaleAndAnOffset) {
  const ColumnChoices choices = parse_columns("angle=enc:deg*0.0219-180,torque_bar=adc:nm*-4.88e-3+10,time=n:ms*2");
  EXPECT_EQ(choice(choices, Channel::kAngle), (ColumnChoice{"enc", "deg", 0.0219, -180}));
  EXPECT_EQ(choice(choices, Channel::kTorqueBar), (ColumnChoice{"adc", "nm", -0.00488, 10}));
  EXPECT_EQ(choice(choices, Channel::kTime), (ColumnChoice{"n", "ms", 2, 0}));
  EXPECT_EQ(choice(parse_columns("probe=a:N*m"), Channel::kProbe), (ColumnChoice{"a", "N*m"}));
  EXPECT_EQ(choice(parse_columns("probe=a:nm+1"), Channel::kProbe), (ColumnChoice{"a", "nm", 1, 1}));
}

TEST(LogOptions, NamesInQuotes) {
  const ColumnChoices choices = parse_columns(R"(angle="theta, ""left"": x=1":deg,torque_bar="a:b")");
  EXPECT_EQ(choice(choices, Channel::kAngle), (ColumnChoice{R"(theta, "left": x=1)", "deg"}));
  EXPECT_EQ(choice(choices, Channel::kTorqueBar), (ColumnChoice{"a:b"}));
}

TEST(LogOptions, WhatIsWrittenIsReadBack) {
  for (const ColumnChoice& one :
       {ColumnChoice{"enc", "deg", 0.0219, -180}, ColumnChoice{"a,b", "", 1, 0},
        ColumnChoice{" x\"y:z ", "mrad", 2, 0.5}, ColumnChoice{"\u00b0", "rad", 1e-9, 1e-9}}) {
    EXPECT_EQ(choice(parse_columns(choice_text(Channel::kAngle, one)), Channel::kAngle), one) << one.name;
  }
}

TEST(LogOptions, SeveralFilesHaveSeveralTimes) {
  const ColumnChoices choices = parse_columns("time=a/t,time=b/zeit:ms,time=c/t");
  EXPECT_EQ(choice(choices, Channel::kTime), (ColumnChoice{"a/t"}));
  EXPECT_EQ(choices.more_times, (std::vector<ColumnChoice>{{"b/zeit", "ms"}, {"c/t"}}));
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
            "--columns time=\"t\": expected one of the units s, ms, us, ns after the colon, and for counts "
            "*SCALE+OFFSET behind it, found \"min\"");
  EXPECT_EQ(refusal(parse_columns, "angle=a:nm"),
            "--columns angle=\"a\": expected one of the units rad, deg, mrad, urad, turn, m after the colon, and for "
            "counts *SCALE+OFFSET behind it, found \"nm\"");
  EXPECT_EQ(refusal(parse_columns, "time=a,time=b"),
            "--columns: expected each channel once, found time twice; of several files say time=FILE/COLUMN");
  EXPECT_EQ(refusal(parse_columns, "probe=a,probe=b"), "--columns: expected each channel once, found probe twice");
  for (const char* text : {"angle=a:deg*", "angle=a:deg*0", "angle=a:deg*x", "angle=a:deg*1e999", "angle=a:deg*2+",
                           "angle=a:deg*2+1x", "angle=a:deg*2*3", "angle=a:deg*nan", "angle=a:*2"}) {
    EXPECT_TRUE(refusal(parse_columns, text).starts_with("--columns angle=\"a\": expected one of the units")) << text;
  }
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
