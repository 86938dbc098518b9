// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log_text.hpp"

namespace steerid::test {
namespace {

/// The record that rows(count) stands for.
void expect_rows(const Record& record, std::size_t count) {
  ASSERT_EQ(record.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_NEAR(record.time_s[i], 0.01 * static_cast<double>(i), 1e-12);
    EXPECT_EQ(record.torque_driver_nm[i], static_cast<double>(i));
    EXPECT_EQ(record.torque_motor_nm[i], -static_cast<double>(i));
    EXPECT_EQ(record.angle_rad[i], 0.125 * static_cast<double>(i));
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Every cell in quotes.
std::string all_quoted(const std::string& text) {
  std::string out(1, '"');
  out.append(replaced(replaced(text, ",", "\",\""), "\n", "\"\n\""));
  out.pop_back();
  return out;
}

TEST(LogRead, ContractColumns) { expect_rows(read_text(kHeader + rows(60)), 60); }

TEST(LogRead, TheSameRecordInEveryDialect) {
  const std::string plain = kHeader + rows(60);
  const std::string dialects[] = {
      replaced(plain, "\n", "\r\n"),
      std::string("\xef\xbb\xbf").append(plain),
      replaced(plain, ",", ";"),
      replaced(plain, ",", "\t"),
      replaced(plain, ",", " , "),
      replaced(plain, ",", "\t,"),
      replaced(plain, "\n", "\n\n"),
      replaced(plain, "\n", "\n# a comment, with a comma and a \"quote\n"),
      std::string("# first\n\n  # second\n").append(plain),
      all_quoted(plain),
      plain.substr(0, plain.size() - 1),
      replaced(plain, ",0,", ",+0,"),
  };
  for (const std::string& text : dialects) {
    SCOPED_TRACE(text.substr(0, 120));
    expect_rows(read_text(text), 60);
  }
}

TEST(LogRead, ALastLineThatIsCutOffIsLeftOutAndSaidSo) {
  const std::string whole = kHeader + rows(60);
  const std::string zeros(std::size_t{1} << 20, '\0');  // of a file whose room was reserved before it was written
  for (const std::string cut : {"0.60,60,-6", "0.60,60,", "0.60", "0.60,60,-60,7.5e", "0.60,60,-60,\"7."}) {
    for (const std::string& behind : {std::string(), zeros}) {
      SCOPED_TRACE(cut + (behind.empty() ? "" : " and zeros"));
      RecordQuality noticed;
      expect_rows(read_text(whole + cut + behind, {}, &noticed), 60);
      EXPECT_EQ(noticed.notes, std::vector<std::string>{"line 62 of drive.csv, the last, is cut off: left out"});
      EXPECT_THROW((void)read_text(whole + cut + "\n" + behind), BadInput);  // its writer has ended it
    }
  }
  RecordQuality noticed;
  expect_rows(read_text(whole + zeros, {}, &noticed), 60);
  EXPECT_TRUE(noticed.notes.empty());
  EXPECT_THROW((void)read_text(kHeader + std::string("0.60,60")), BadInput);  // all that there is
}

TEST(LogRead, ColumnsInAnyOrderBesideOthersThatAreNoNumbers) {
  std::string text = "angle_rad,\"gear, comment\",time_s,torque_motor_nm\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},\"N, \"\"neutral\"\"\",{},{}\n", 2 * i, 0.02 * i, 3 * i);
  RecordQuality noticed;
  const Record record = read_text(text, {}, &noticed);
  ASSERT_EQ(record.size(), 50U);
  EXPECT_EQ(record.angle_rad[7], 14.0);
  EXPECT_EQ(record.torque_motor_nm[7], 21.0);
  EXPECT_EQ(record.torque_driver_nm[7], 0.0);
  ASSERT_EQ(record.torque_driver_nm.size(), 50U);
  EXPECT_EQ(noticed.notes, std::vector<std::string>{"no column for torque_driver: taken as zero"});
}

TEST(LogRead, TheChannelsOfACar) {
  std::string text = "time_s,torque_bar_nm,torque_motor_nm,torque_rim_nm,probe_nm,angle_rad\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},{},1,{},{},2\n", 0.01 * i, 3 * i, 4 * i, 5 * i);
  RecordQuality noticed;
  const Record record = read_text(text, {.reversed = parse_sign("probe")}, &noticed);
  EXPECT_EQ(record.torque_bar_nm[7], 21.0);
  EXPECT_EQ(record.torque_rim_nm[7], 28.0);
  EXPECT_EQ(record.probe_nm[7], -35.0);
  EXPECT_EQ(record.channels, kAngleValid | kTorqueMotorValid | kTorqueBarValid | kTorqueRimValid | kProbeValid);
  EXPECT_EQ(record.equation(), Equation::kBar);
  EXPECT_EQ(record.net_torque_nm(7), -21.0);  // the motor acts below the bar
  EXPECT_EQ(record.torque_driver_nm, std::vector<double>(50, 0.0));
  EXPECT_TRUE(noticed.notes.empty());
}

TEST(LogRead, ABarOrARimNeedsNoOtherTorque) {
  std::string text = "t,sensor,theta\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},{},2\n", 10 * i, 1000 * i);
  const auto read = [&](const std::string& channel) {
    return read_text(text, {.columns = parse_columns("time=t:ms,angle=theta:rad," + channel + "=sensor:mnm")});
  };
  EXPECT_EQ(read("torque_bar").channels, kAngleValid | kTorqueBarValid);
  EXPECT_EQ(read("torque_bar").torque_bar_nm[3], 3.0);
  EXPECT_TRUE(read("torque_bar").torque_rim_nm.empty());
  EXPECT_EQ(read("torque_rim").channels, kAngleValid | kTorqueRimValid);
  EXPECT_EQ(read("torque_rim").equation(), Equation::kRim);
  // Without either, the paper's equation holds, and what is absent counts as zero.
  EXPECT_EQ(read("torque_motor").channels, kAllChannelsValid);
}

/// As of a drive without hands, whose bar is all that acts on the wheel.
TEST(LogRead, AColumnThatIsNamedForOneChannelIsTakenForNoOther) {
  std::string text = "time_s,torque_bar_nm,torque_motor_nm,angle_rad\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},{},1,2\n", 0.01 * i, 3 * i);
  const Record record = read_text(text, {.columns = parse_columns("torque_motor=torque_bar_nm")});
  EXPECT_EQ(record.channels, kAllChannelsValid);
  EXPECT_EQ(record.torque_motor_nm[7], 21.0);
}

TEST(LogRead, UnitsBySuffixInAnyCase) {
  std::string text = "t_ms,driver_mNm,motor_N,wheel_Deg\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},{},{},{}\n", 10 * i, 1500, -2, 90);
  const LogFormat format{.columns =
                             parse_columns("time=t_ms,torque_driver=driver_mNm,torque_motor=motor_N,angle=wheel_Deg")};
  RecordQuality noticed;
  const Record record = read_text(text, format, &noticed);
  EXPECT_EQ(record.time_s[29], 0.29);  // division by a power of ten gives the nearest double, as typing 0.29 does
  EXPECT_EQ(record.torque_driver_nm[0], 1.5);
  EXPECT_EQ(record.torque_motor_nm[0], -2.0);
  EXPECT_DOUBLE_EQ(record.angle_rad[0], 0.5 * std::numbers::pi);
  EXPECT_TRUE(noticed.notes.empty());
}

TEST(LogRead, UnitsStatedWinOverTheSuffix) {
  std::string text = "clock_s,torque_motor_nm,theta\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},1,{}\n", 10000 * i, 250000);
  const LogFormat format{.columns = parse_columns("time=clock_s:us,angle=theta:urad")};
  const Record record = read_text(text, format);
  EXPECT_EQ(record.time_s[3], 0.03);
  EXPECT_EQ(record.angle_rad[3], 0.25);
}

TEST(LogRead, AUnitThatIsNotStatedIsTakenInSiAndSaidSo) {
  std::string text = "clock,torque_motor_nm,theta_nm\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},1,2\n", 0.01 * i);
  RecordQuality noticed;
  const Record record = read_text(text, {.columns = parse_columns("time=clock,angle=theta_nm")}, &noticed);
  EXPECT_EQ(record.angle_rad[0], 2.0);
  const std::vector<std::string> expected = {"column \"clock\" states no unit of time: taken as s",
                                             "column \"theta_nm\" states no unit of angle: taken as rad",
                                             "no column for torque_driver: taken as zero"};
  EXPECT_EQ(noticed.notes, expected);
}

TEST(LogRead, SignsTurnTheirChannelsOnly) {
  const std::string text = kHeader + rows(50);
  const Record both = read_text(text, {.reversed = parse_sign("-1")});
  EXPECT_EQ(both.torque_driver_nm[9], -9.0);
  EXPECT_EQ(both.torque_motor_nm[9], 9.0);
  EXPECT_EQ(both.angle_rad[9], 1.125);
  EXPECT_GT(both.time_s[9], 0.0);
  const Record angle = read_text(text, {.reversed = parse_sign("-angle")});
  EXPECT_EQ(angle.torque_driver_nm[9], 9.0);
  EXPECT_EQ(angle.angle_rad[9], -1.125);
}

TEST(LogRead, MissingValuesLeaveTheirRowsOut) {
  std::string text = kHeader + rows(20);
  text += "0.20,,1,1\n0.21,nan,1,1\n0.22,1,NA,1\n0.23,1,1,-NaN\n0.24,1,1, null \nnan,1,1,1\n";
  text += rows(40, 26);
  RecordQuality noticed;
  const Record record = read_text(text, {}, &noticed);
  EXPECT_EQ(record.size(), 60U);
  EXPECT_EQ(noticed.rows, 60U);
  EXPECT_EQ(noticed.dropped_rows, 6U);
  ASSERT_EQ(noticed.gaps.size(), 1U);
  EXPECT_EQ(noticed.gaps[0].start_s, 0.19);
  EXPECT_NEAR(noticed.gaps[0].length_s, 0.07, 1e-12);
  EXPECT_EQ(noticed.notes, std::vector<std::string>{"6 rows with an empty or NaN cell left out, the first in line 22"});
}

TEST(LogRead, AMissingValueInAColumnThatIsNotNeededIsNoMatter) {
  std::string text = "time_s,torque_motor_nm,spare,angle_rad\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},1,nan,2\n", 0.01 * i);
  EXPECT_EQ(read_text(text).size(), 50U);
}

TEST(LogRead, NumbersOfEveryForm) {
  std::string text = kHeader + rows(49);
  text += "4.9e-1,+1.5E+2,-.5,1e-400\n";  // the last one is too small for a double: zero
  const Record record = read_text(text);
  EXPECT_EQ(record.time_s[49], 0.49);
  EXPECT_EQ(record.torque_driver_nm[49], 150.0);
  EXPECT_EQ(record.torque_motor_nm[49], -0.5);
  EXPECT_EQ(record.angle_rad[49], 0.0);
}

TEST(LogRead, FiftyHertzIsFastEnoughWithRoundedStamps) {
  std::string text = kHeader;
  for (int i = 0; i < 50; ++i) text += fmt::format("{:.3f},1,1,1\n", 0.0201 * i);
  EXPECT_EQ(read_text(text).size(), 50U);
}

TEST(LogRead, LinesLieAcrossBlocks) {
  // Rows of 29 bytes do not divide the block of 2^18: every kind of cut comes up within 29 blocks.
  std::string text = kHeader;
  const std::size_t count = 300'000;
  text.reserve(count * 30);
  for (std::size_t i = 0; i < count; ++i) text += fmt::format("{:09.2f},{:08},-1,.5\n", 0.01 * double(i), i % 100'000);
  const Record record = read_text(text);
  ASSERT_EQ(record.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(record.torque_driver_nm[i], static_cast<double>(i % 100'000)) << i;
    ASSERT_EQ(record.angle_rad[i], 0.5) << i;
  }
}

}  // namespace
}  // namespace steerid::test
