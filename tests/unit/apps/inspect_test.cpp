// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid inspect` on logs of other tools, and what the other commands make of the line that it prints.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "log/log_reader.hpp"
#include "support/steerid_command.hpp"

namespace steerid::test {
namespace {

using nlohmann::json;

class Inspect : public SteeridCommand {
 protected:
  void SetUp() override {
    ASSERT_EQ(run("simulate --task probe --hands both_3_9 --duration 40 --seed 3 --out drive.csv").exit_code, 0);
    drive_ = read_log(folder() / "drive.csv");
  }

  /// The drive as another tool would write it; {0} s, {1} Nm driver, {2} Nm motor, {3} rad, {4} deg, {5} ms, {6} counts
  /// of 0.01 deg, {7} and {8} the torques in percent of 3 Nm.
  void write_as(const std::string& file, const std::string& header, const std::string& row, char point = '.',
                std::size_t step = 1) const {
    std::string text = header + "\n";
    for (std::size_t i = 0; i < drive_.size(); i += step) {
      std::string line =
          fmt::format(fmt::runtime(row), drive_.time_s[i], drive_.torque_driver_nm[i], drive_.torque_motor_nm[i],
                      drive_.angle_rad[i], 180 / std::numbers::pi * drive_.angle_rad[i], 1000 * drive_.time_s[i],
                      std::round(18000 / std::numbers::pi * drive_.angle_rad[i]), drive_.torque_driver_nm[i] / 0.03,
                      drive_.torque_motor_nm[i] / 0.03);
      for (char& c : line) c = c == '.' ? point : c;
      text += line + "\n";
    }
    write(file, text);
  }

  [[nodiscard]] json answer(const std::string& file) const { return json::parse(read(file)); }

  [[nodiscard]] double inertia(const std::string& arguments) const {
    const Ended ended = run("identify " + arguments + " --batch --json found.json");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const json found = answer("found.json");
    return found["batch"]["inertia_kgm2"]["value"].is_number() ? found["batch"]["inertia_kgm2"]["value"].get<double>()
                                                               : std::nan("");
  }

  [[nodiscard]] std::string line_of(const std::string& arguments) const {
    const Ended ended = run("inspect " + arguments + " --json seen.json");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const std::size_t at = ended.out.find("\n--columns '");  // as a user copies it
    EXPECT_NE(at, std::string::npos) << ended.out;
    const std::string line = ended.out.substr(at + 1, ended.out.find('\n', at + 1) - at - 1);
    std::string plain = answer("seen.json")["columns"];
    for (std::size_t quote = 0; (quote = plain.find('\'', quote)) != std::string::npos; quote += 4) {
      plain.replace(quote, 1, "'\\''");
    }
    EXPECT_EQ(line, "--columns '" + plain + "'");
    return line;
  }

  Record drive_;
};

TEST_F(Inspect, AGermanLogIsReadAsTheContractsIs) {
  write_as("de.csv", "Zeit [ms];Fahrermoment [Nm];Motormoment [Nm];Lenkwinkel [\xb0];Gang",
           "{5:.3f};{1:.9f};{2:.9f};{4:.9f};N", ',');
  const std::string line = line_of("de.csv");
  EXPECT_EQ(line,
            "--columns 'time=Zeit [ms]:ms,torque_driver=Fahrermoment [Nm]:nm,torque_motor=Motormoment "
            "[Nm]:nm,angle=Lenkwinkel [\u00b0]:deg'");
  EXPECT_NEAR(inertia("de.csv " + line), inertia("drive.csv"), 1e-5);
}

TEST_F(Inspect, EveryCommandAcceptsTheLine) {
  write_as("odd.csv", "Zeit [ms];\"Fahrermoment; 'links' [Nm]\";Motormoment [Nm];Lenkwinkel: Rad [\xb0]",
           "{5:.3f};{1:.9f};{2:.9f};{4:.9f}", ',');
  const std::string line = line_of("odd.csv");
  ASSERT_EQ(run("template sim --out sim.json").exit_code, 0);
  for (const std::string command :
       {"identify odd.csv", "simulate --sim sim.json --replay odd.csv --out replayed.csv", "inspect odd.csv",
        "diagnose --real odd.csv --sim sim.json --out gap --no-report"}) {
    const Ended ended = run(command + " " + line);
    EXPECT_EQ(ended.exit_code, 0) << command << ": " << ended.err;
  }
  // Without an ECU it is the port that is missed, after the log was read.
  EXPECT_NE(run("hil odd.csv --port sim.json " + line).err.find("expected the serial port"), std::string::npos);
  EXPECT_NE(run("hil odd.csv --port sim.json").err.find("expected columns time_s"), std::string::npos);
}

TEST_F(Inspect, TheContractsLogHasEveryColumnNamed) {
  EXPECT_EQ(line_of("drive.csv"),
            "--columns 'time=time_s:s,torque_driver=torque_driver_nm:nm,torque_motor=torque_motor_nm:nm,"
            "angle=angle_rad:rad'");
  const json seen = answer("seen.json");
  EXPECT_EQ(seen["schema"], "steerid.inspection/1");
  EXPECT_NEAR(seen["record"]["rate_hz"].get<double>(), 100, 1e-6);
  ASSERT_EQ(seen["files"][0]["columns"].size(), 3U);
  EXPECT_EQ(seen["files"][0]["columns"][2]["channel"], "angle");
  EXPECT_EQ(seen["files"][0]["columns"][2]["values"], drive_.size());
}

TEST_F(Inspect, TwoFilesWithClocksOfTheirOwn) {
  write_as("eps.csv", "t_ms,driver_torque_nm,motor_torque_nm", "{5},{1},{2}");
  write_as("wheel.csv", "stamp_s,theta_deg", "{0},{4}");
  const std::string line = line_of("eps.csv wheel.csv");
  EXPECT_NEAR(inertia("eps.csv --with wheel.csv " + line), inertia("drive.csv"), 1e-5);
}

TEST_F(Inspect, TwoClocksThatDisagreeAreAlignedByTheLagThatExplainsThem) {
  write_as("eps.csv", "time_s,torque_driver_nm,torque_motor_nm", "{0},{1},{2}");
  for (const double ahead_s : {0.37, 1.7e9}) {  // another start, and an epoch
    std::string text = "time_s,angle_rad\n";
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      text += fmt::format("{:.6f},{:.9f}\n", drive_.time_s[i] + ahead_s, drive_.angle_rad[i]);
    }
    write("wheel.csv", text);
    const Ended ended = run("inspect eps.csv wheel.csv --align");
    EXPECT_NE(ended.out.find("wheel.csv: "), std::string::npos) << ended.out << ended.err;
    if (ahead_s < 1) {
      EXPECT_NE(ended.out.find("wheel.csv: moved by -0.37"), std::string::npos) << ended.out;
    }
    EXPECT_NEAR(inertia("eps.csv --with wheel.csv --align"), inertia("drive.csv"), 0.002);
  }
  write_as("wheel.csv", "time_s,angle_rad", "{0},{3}");
  EXPECT_NE(run("inspect eps.csv wheel.csv --align").out.find("wheel.csv: no lag within 2 s"), std::string::npos);
}

TEST_F(Inspect, DegreesInAColumnOfRadiansAreNotCredible) {
  write_as("degrees.csv", "time_s,torque_driver_nm,torque_motor_nm,angle_rad", "{0},{1},{2},{4}");
  const Ended ended = run("identify degrees.csv --batch --json found.json");
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("not credible: J would be"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("--columns angle=angle_rad:deg"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find(" valid"), std::string::npos) << ended.out;
  EXPECT_EQ(read("found.json").find("\"valid\""), std::string::npos);
  EXPECT_NE(line_of("degrees.csv").find("angle=angle_rad:deg"), std::string::npos);
  EXPECT_NEAR(inertia("degrees.csv --columns angle=angle_rad:deg"), inertia("drive.csv"), 1e-5);
}

TEST_F(Inspect, AnAngleAndATorqueNamedForEachOtherAreNotCredible) {
  write_as("swapped.csv", "time_s,torque_driver_nm,angle_rad,torque_motor_nm", "{0},{1},{2},{3}");
  const std::string sentence = "angle and torque_motor are named for each other";
  const Ended ended = run("identify swapped.csv --batch --json found.json");
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("not credible: " + sentence), std::string::npos) << ended.out;
  EXPECT_EQ(read("found.json").find("\"valid\""), std::string::npos);
  ASSERT_EQ(run("template sim --out sim.json").exit_code, 0);
  const Ended diagnosed = run("diagnose --real swapped.csv --sim sim.json --out gap --no-report");
  EXPECT_EQ(diagnosed.exit_code, 1) << diagnosed.out;
  EXPECT_NE(diagnosed.err.find(sentence), std::string::npos) << diagnosed.err;
  EXPECT_FALSE(exists("gap/diagnosis.json"));
  // The line that inspect proposes reads it rightly.
  EXPECT_NEAR(inertia("swapped.csv " + line_of("swapped.csv")), inertia("drive.csv"), 1e-5);
}

TEST_F(Inspect, CountsAndPercentAreAskedFor) {
  write_as("counts.csv", "time_s,torque_driver_nm,torque_motor_nm,angle_rad", "{0},{1},{2},{6}");
  const Ended counts = run("identify counts.csv");
  EXPECT_NE(counts.out.find("the column has whole numbers, as counts are; say how much one is"), std::string::npos)
      << counts.out;
  EXPECT_NEAR(inertia("counts.csv --columns 'angle=angle_rad:deg*0.01'"), inertia("drive.csv"), 2e-4);
  write_as("percent.csv", "time_s,torque_driver_nm,torque_motor_nm,angle_rad", "{0},{7},{8},{3}");  // of 3 Nm
  const Ended percent = run("identify percent.csv");
  EXPECT_NE(percent.out.find("or in mNm, counts or percent? Say so with"), std::string::npos) << percent.out;
  EXPECT_NEAR(inertia("percent.csv --columns 'torque_driver=torque_driver_nm:nm*0.03,"
                      "torque_motor=torque_motor_nm:nm*0.03'"),
              inertia("drive.csv"), 1e-5);
}

/// What makes up best for torques in mNm was named as the cause: a lag of 0.5 s that closes all of the gap.
TEST_F(Inspect, ARecordInAnotherUnitThanItsSimulationIsNotDiagnosed) {
  std::string text = "time_s,torque_driver_nm,torque_motor_nm,angle_rad\n";
  for (std::size_t i = 0; i < drive_.size(); ++i) {
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.9f}\n", drive_.time_s[i], 1000 * drive_.torque_driver_nm[i],
                        1000 * drive_.torque_motor_nm[i], drive_.angle_rad[i]);
  }
  write("mnm.csv", text);
  ASSERT_EQ(run("template sim --out sim.json").exit_code, 0);
  const std::string line = "diagnose --real mnm.csv --sim sim.json --out gap --no-report --time-limit 1";
  const Ended refused = run(line);
  EXPECT_EQ(refused.exit_code, 1) << refused.out;
  EXPECT_NE(refused.err.find("mnm.csv: the simulation is of a wheel of"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("--columns CHANNEL=COLUMN:mnm"), std::string::npos) << refused.err;
  EXPECT_FALSE(exists("gap/diagnosis.json"));
  const Ended stated = run(line + " --columns torque_driver=torque_driver_nm:mnm,torque_motor=torque_motor_nm:mnm");
  EXPECT_EQ(stated.exit_code, 0) << stated.err;
}

TEST_F(Inspect, AStatedUnitIsTaken) {
  write_as("degrees.csv", "time_s,torque_driver_nm,torque_motor_nm,angle_rad", "{0},{1},{2},{4}");
  const Ended ended = run("identify degrees.csv --columns angle=angle_rad:rad");
  EXPECT_EQ(ended.out.find("not credible: J would be"), std::string::npos) << ended.out;
}

TEST_F(Inspect, WhatIsMissingIsNamedAtOnce) {
  write("odd.csv", "a;b\n1;2\n2;3\n");
  const Ended ended = run("inspect odd.csv");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("expected columns time_s; angle_rad; torque_bar_nm"), std::string::npos) << ended.err;
  EXPECT_EQ(run("inspect").exit_code, 2);
  EXPECT_EQ(run("inspect -").exit_code, 2);
  EXPECT_EQ(run("inspect none.csv").exit_code, 1);
}

}  // namespace
}  // namespace steerid::test
