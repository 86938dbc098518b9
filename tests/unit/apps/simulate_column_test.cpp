// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// steerid simulate --task drive as a user meets it: a log of a car's channels, the truth beside it, and what is
// refused.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "support/steerid_command.hpp"

namespace steerid {
namespace {

class SimulateColumn : public test::SteeridCommand {
 protected:
  /// Rows of a CSV below its comments and its header.
  [[nodiscard]] std::vector<std::vector<double>> rows(const std::string& file, std::string* header = nullptr) const {
    std::vector<std::vector<double>> all;
    std::istringstream text(read(file));
    bool named = false;
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with('#')) continue;
      if (!named) {
        named = true;
        if (header != nullptr) *header = line;
        continue;
      }
      std::istringstream cells(line);
      std::vector<double> row;
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
      all.push_back(row);
    }
    return all;
  }
};

TEST_F(SimulateColumn, WritesTheChannelsOfACarAndTheTruthBesideThem) {
  const Ended ended =
      run("simulate --task drive --manoeuvre curves --duration 40 --change step --change-to 33 --change-at 5 "
          "--release 20 4 --out drive.csv --truth truth.csv");
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  std::string header;
  const auto log = rows("drive.csv", &header);
  EXPECT_EQ(header, "time_s,torque_bar_nm,torque_motor_nm,torque_rim_nm,probe_nm,angle_rad");
  const auto truth = rows("truth.csv", &header);
  EXPECT_EQ(header, "time_s,inertia_kgm2,damping_nms_per_rad,stiffness_nm_per_rad,torque_driver_nm");
  ASSERT_EQ(log.size(), 4000U);
  ASSERT_EQ(truth.size(), log.size());
  for (std::size_t i = 0; i < log.size(); ++i) ASSERT_EQ(log[i][0], truth[i][0]);
  EXPECT_NEAR(truth[400][3], 10.2, 1e-9);  // the average driver who steers, one hand at three o'clock
  EXPECT_NEAR(truth[1000][3], 33, 1e-9);
  EXPECT_EQ(truth[2200][3], 0);
  EXPECT_EQ(truth[2200][4], 0);
  EXPECT_NEAR(truth[2200][1], 0.034, 1e-9);
  EXPECT_NEAR(truth.back()[3], 33, 1e-9);
}

/// The exact arm: at rest nothing is missing; of one who steers the answer says that what he does hides the rest.
TEST_F(SimulateColumn, ItsDriveIsDiagnosedByTheTorsionBar) {
  for (const std::string steering : {"0", "0.1"}) {
    const Ended driven = run("simulate --task drive --hands both_3_9 --duration 30 --probe 1.5 --steering " + steering +
                             " --out drive.csv --truth truth.csv");
    ASSERT_EQ(driven.exit_code, 0) << driven.err;
    const std::vector<double> arm = rows("truth.csv").front();
    std::ostringstream simulation;
    simulation << R"({"inertia_kgm2":)" << arm[1] << R"(,"damping_nms_per_rad":)" << arm[2]
               << R"(,"stiffness_nm_per_rad":)" << arm[3] << "}";
    write("sim.json", simulation.str());
    const Ended ended = run("diagnose --real drive.csv --sim sim.json --out gap --no-report");
    if (steering == "0") {
      ASSERT_EQ(ended.exit_code, 0) << ended.err;
      EXPECT_NE(ended.out.find("verdict    none"), std::string::npos) << ended.out;
      EXPECT_NE(ended.out.find("driven by torque_bar alone"), std::string::npos) << ended.out;
    } else {
      ASSERT_EQ(ended.exit_code, 0) << ended.err;
      EXPECT_NE(ended.out.find("the driver steers by a torque that is in no column"), std::string::npos) << ended.out;
      EXPECT_TRUE(ended.out.find("verdict    none") != std::string::npos ||
                  ended.out.find("verdict    parameters") != std::string::npos)
          << ended.out;
    }
  }
}

TEST_F(SimulateColumn, RepeatsItselfByItsSeed) {
  ASSERT_EQ(run("simulate --task drive --duration 5 --seed 3 --out a.csv --truth ta.csv").exit_code, 0);
  ASSERT_EQ(run("simulate --task drive --duration 5 --seed 3 --out b.csv --truth tb.csv").exit_code, 0);
  ASSERT_EQ(run("simulate --task drive --duration 5 --seed 4 --out c.csv").exit_code, 0);
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  EXPECT_EQ(read("ta.csv"), read("tb.csv"));
  EXPECT_NE(read("a.csv"), read("c.csv"));
}

/// A column of a file, held still by its friction: what the motor asks for does not turn it.
TEST_F(SimulateColumn, TakesTheColumnOfAFile) {
  write("column.json", R"({"rack_friction_nm": 20, "road_rms_nm": 0,  // locked
                           "sensors": {"torque_bar": {"noise": {"sd_nm": 0.5}}}})");
  ASSERT_EQ(run("simulate --task drive --column column.json --steering 0 --duration 20 --out log.csv").exit_code, 0);
  double squares = 0;
  for (const auto& row : rows("log.csv")) {
    EXPECT_EQ(row[5], 0);
    squares += row[1] * row[1];
  }
  EXPECT_NEAR(squares / 2000, 0.25, 0.03);
}

/// Held above the bar the wheel stands, while the motor turns the column against the bar.
TEST_F(SimulateColumn, HoldsTheWheelOfAFileByItsFriction) {
  write("column.json", R"({"wheel_friction_nm": 20, "sensors": {}})");
  const Ended ended =
      run("simulate --task drive --column column.json --hands both_3_9 --steering 0 --duration 20 --out log.csv");
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("friction 0.75 Nm, 20 Nm above the bar,"), std::string::npos) << ended.out;
  double squares = 0;
  for (const auto& row : rows("log.csv")) {
    EXPECT_EQ(row[3], 0);  // the hand does nothing
    EXPECT_EQ(row[5], 0);
    squares += row[1] * row[1];
  }
  EXPECT_GT(squares / 2000, 0.01);
}

TEST_F(SimulateColumn, RefusesWhatDoesNotBelongTogether) {
  write("sim.json", R"({"inertia_kgm2": 0.1, "damping_nms_per_rad": 1.5, "stiffness_nm_per_rad": 20,
                        "effects": [{"effect": "coulomb_friction"}]})");
  write("light.json", R"({"inertia_kgm2": 0.02, "damping_nms_per_rad": 1.5, "stiffness_nm_per_rad": 20})");
  struct Case {
    std::string arguments;
    int exit_code;
    std::string says;
  };
  for (const Case& one : {
           Case{"--task drive --effect lag", 2, "--effect is no option of --task drive"},
           Case{"--task drive --eps held", 2, "--eps is no option of --task drive"},
           Case{"--task passive --column sim.json", 2, "--column is an option of --task drive only"},
           Case{"--task probe --truth t.csv", 2, "--truth is an option of --task drive only"},
           Case{"--task drive --change ramp", 2, "--change and --change-to belong together"},
           Case{"--task drive --change-to 30", 2, "--change and --change-to belong together"},
           Case{"--task drive --release 3 0.01", 2, "--release 3 0.01: expected at least 0.15 s"},
           Case{"--task drive --release 3 2 --release 4 2", 2, "--release 4 2: expected at least"},
           Case{"--task drive --release 3 nan", 2, "found \"nan\""},
           Case{"--task drive --manoeuvre curve", 2, "did you mean curves?"},
           Case{"--task drive --truth out.csv", 2, "out.csv"},
           Case{"--task drive --sim sim.json", 1, "belong into the file of --column"},
           Case{"--task drive --sim light.json", 1, "give a larger arm or a lighter wheel"},
           Case{"--task drive --column sim.json", 1, "found the key \"damping_nms_per_rad\""},
           Case{"--task drive --column missing.json", 1, "missing.json"},
       }) {
    const Ended ended = run("simulate " + one.arguments + " --out out.csv");
    EXPECT_EQ(ended.exit_code, one.exit_code) << one.arguments << "\n" << ended.err;
    EXPECT_NE(ended.err.find(one.says), std::string::npos) << one.arguments << "\n" << ended.err;
    EXPECT_FALSE(exists("out.csv")) << one.arguments;
  }
}

}  // namespace
}  // namespace steerid
