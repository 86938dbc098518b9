// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// CAN logs that python-can has written, with a DBC that canmatrix has: what is read is what went onto the bus.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "log/dbc.hpp"
#include "log/log_reader.hpp"
#include "log_text.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::test {
namespace {

constexpr const char* kColumns = "angle=Angle,torque_bar=BarTorque,torque_motor=MotorTorque";
constexpr double kFirstS = 1795613219.0;  // of write_logs.py

class CanLogs : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string line =
        "/usr/bin/python3 -B " STEERID_WRITE_CAN_LOGS " '" + folder_.path().string() + "' 2>/dev/null";
    if (std::system(line.c_str()) != 0) {  // NOLINT(cert-env33-c): our own command with our own words
      GTEST_SKIP() << "SKIPPED for want of python3-can and python3-canmatrix, Debian packages";
    }
  }

  [[nodiscard]] std::filesystem::path file(const char* name) const { return folder_.path() / name; }
  [[nodiscard]] LogFormat format() const { return {.columns = parse_columns(kColumns), .dbc = {file("bus.dbc")}}; }

  /// Stamp and value of every frame that had the signal.
  [[nodiscard]] std::map<double, double> truth(const std::string& signal) const {
    std::map<double, double> values;
    std::ifstream in(file("truth.csv"));
    for (std::string line; std::getline(in, line);) {
      std::istringstream cells(line);
      std::string stamp;
      std::string name;
      std::string value;
      std::getline(cells, stamp, ',');
      std::getline(cells, name, ',');
      std::getline(cells, value, ',');
      if (name == signal) values[std::stod(stamp)] = std::stod(value);
    }
    return values;
  }

  TemporaryFolder folder_;
};

TEST_F(CanLogs, SignalsAreWhatWentOntoTheBus) {
  const auto bar = truth("BarTorque");
  ASSERT_EQ(bar.size(), 600U);
  for (const char* log : {"drive.log", "drive.asc", "drive.blf"}) {
    SCOPED_TRACE(log);
    const Record record = read_log(file(log), format());
    EXPECT_EQ(record.channels, kAngleValid | kTorqueBarValid | kTorqueMotorValid);
    ASSERT_GT(record.size(), 580U);  // the bar's clock is the fastest; the motor's comes every 20 ms
    const double epoch_s = record.time_s.front() > 1e6 ? kFirstS : 0;  // ASC counts from its start
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double at_s = record.time_s[i] - epoch_s;
      const auto known = bar.lower_bound(at_s - 2e-6);
      ASSERT_NEAR(known->first, at_s, 2e-6);
      ASSERT_NEAR(record.torque_bar_nm[i], known->second, 1e-9);
      // Half a step of the bus's integers, times what the cubic beside an end makes of it, and the cubic's own error.
      ASSERT_NEAR(record.angle_rad[i], (40 * std::sin(4 * at_s) - 7) * 3.14159265358979 / 180, 6e-5);
      ASSERT_NEAR(record.torque_motor_nm[i], 2 * std::cos(3 * at_s), 0.03);
    }
  }
}

TEST_F(CanLogs, WithoutADbcItIsAskedFor) {
  for (const char* log : {"drive.log", "drive.asc", "drive.blf"}) {
    try {
      (void)read_log(file(log));
      ADD_FAILURE() << "was read";
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find("name the bus's DBC file with --dbc FILE"), std::string::npos);
    }
  }
}

TEST_F(CanLogs, ALogThatIsCutIsReadUpToThere) {
  std::ifstream in(file("drive.blf"), std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  const std::string whole = bytes.str();
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 40) {
    std::ofstream(file("cut.blf"), std::ios::binary) << whole.substr(0, length);
    EXPECT_THROW((void)read_log(file("cut.blf"), format()), BadInput)
        << length;  // one container: nothing of it is whole
  }
}

TEST_F(CanLogs, ATextThatIsCutIsReadUpToItsLastWholeFrame) {
  for (const std::string name : {"drive.log", "drive.asc"}) {
    std::ifstream in(file(name.c_str()), std::ios::binary);
    std::stringstream bytes;
    bytes << in.rdbuf();
    std::string whole = bytes.str();
    const std::size_t last = whole.rfind('\n', whole.size() * 3 / 4) + 1;
    std::ofstream(file("cut.log"), std::ios::binary) << whole.substr(0, last);
    const std::size_t rows = read_log(file("cut.log"), format()).size();
    EXPECT_GT(rows, 50U);
    const std::size_t next = whole.find('\n', last);
    for (std::size_t length = last + 1; length < next; ++length) {
      SCOPED_TRACE(name + whole.substr(last, length - last));
      std::ofstream(file("cut.log"), std::ios::binary) << whole.substr(0, length);
      EXPECT_NEAR(static_cast<double>(read_log(file("cut.log"), format()).size()), static_cast<double>(rows), 1);
    }
  }
}

TEST(CanLog, ASlowOneIsNotAskedForTheUnitOfAColumnThatItHasNot) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bus.dbc") << "BO_ 256 Wheel: 4 A\n"
                                              " SG_ Angle : 0|16@1- (0.001,0) [0|0] \"rad\" A\n"
                                              " SG_ MotorTorque : 16|16@1- (0.001,0) [0|0] \"Nm\" A\n";
  std::ofstream log(folder.path() / "bus.log");
  for (int i = 0; i < 60; ++i) log << "(17." << 100000 + 10000 * i << ") can0 100#01000200\n";
  log.close();
  const LogFormat format{.columns = parse_columns("angle=Angle,torque_motor=MotorTorque"),
                         .dbc = {folder.path() / "bus.dbc"}};
  EXPECT_NO_THROW(static_cast<void>(read_log(folder.path() / "bus.log", format)));
  log.open(folder.path() / "bus.log");
  for (int i = 0; i < 60; ++i) log << "(" << 17 + i << ".000000) can0 100#01000200\n";
  log.close();
  try {
    static_cast<void>(read_log(folder.path() / "bus.log", format));
    ADD_FAILURE() << "a frame a second was read";
  } catch (const BadInput& error) {
    const std::string says = error.what();
    EXPECT_NE(says.find("expected 50 rows a second or more, found 1 (median); record faster"), std::string::npos)
        << says;
    EXPECT_EQ(says.find("--columns"), std::string::npos) << says;
  }
}

TEST(Dbc, NumbersOfEveryKind) {
  const auto messages = parse_dbc(
      "BO_ 100 A: 8 X\n SG_ f : 0|32@1- (1,0) [0|0] \"\" X\n SG_ m : 39|12@0+ (2,1) [0|0] \"\xb0\" X\n"
      "BO_ 2147483749 B: 8 X\nSIG_VALTYPE_ 100 f : 1;\n",
      "bus.dbc");
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_TRUE(messages[1].extended);
  EXPECT_EQ(messages[1].id, 101U);
  CanFrame frame{.bytes = 8};
  frame.data = {0x00, 0x00, 0xc0, 0xbf, 0xab, 0xc0};  // -1.5 as a float; 0xabc
  EXPECT_EQ(messages[0].signals[0].value(frame), -1.5);
  EXPECT_EQ(messages[0].signals[1].value(frame), 2 * 0xabc + 1);
  EXPECT_EQ(messages[0].signals[1].unit, "\u00b0");
  frame.bytes = 5;
  EXPECT_FALSE(messages[0].signals[1].value(frame));
}

TEST(Dbc, WhatIsNoneEndsInOneSentence) {
  for (const char* text :
       {"", "BO_ x A: 8 X\n", "SG_ f : 0|8@1+ (1,0) [0|0] \"\" X\n", "BO_ 1 A: 8 X\n SG_ f : 0|99@1+ (1,0)\n",
        "BO_ 1 A: 8 X\n SG_ f : 600|8@1+ (1,0)\n", "BO_ 1 A: 8 X\n SG_ f 0|8@1+ (1,0)\n"}) {
    EXPECT_THROW((void)parse_dbc(text, "bus.dbc"), BadInput) << text;
  }
}

}  // namespace
}  // namespace steerid::test
