// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The driver's own arm as a user gets it: a drive with the hands off for the wheel alone, then a drive less that wheel.
#include "apps/own_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "app/driver_state.hpp"
#include "fit/wheel_friction.hpp"
#include "log/bad_input.hpp"
#include "support/steerid_command.hpp"

namespace steerid {
namespace {

// What is no wheel without hands to the firmware is none to the batch fit.
static_assert(DriverStateLimits{}.hands_off_below == 1e6 * kEmptyWheel);

// The simulated wheel has J 0.034 (plant/column.hpp); the arm of truth.csv less that.
constexpr double kWheelInertia = 0.034;

using OwnArmCommand = test::SteeridCommand;

/// The last row's value of a column.
double last_of(const std::string& csv, const std::string& column) {
  std::istringstream rows(csv);
  std::string row;
  std::string last;
  int at = -1;
  while (std::getline(rows, row)) {
    if (row.empty() || row.front() == '#') continue;
    if (at < 0) {
      std::istringstream names(row);
      std::string name;
      for (int i = 0; std::getline(names, name, ','); ++i) at = name == column ? i : at;
    }
    last = row;
  }
  std::istringstream values(last);
  std::string value;
  for (int i = 0; i <= at && std::getline(values, value, ','); ++i) {
  }
  return std::stod(value);
}

TEST_F(OwnArmCommand, IsTheArmLessTheWheelOfARecordWithTheHandsOff) {
  ASSERT_EQ(run("simulate --task drive --steering 0 --release 1 58 --duration 58 --out off.csv").exit_code, 0);
  const Ended alone = run("identify off.csv --batch --json wheel.json");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  ASSERT_EQ(run("simulate --task drive --hands both_3_9 --steering 0.05 --out on.csv --truth truth.csv").exit_code, 0);
  const Ended ended = run("identify on.csv --batch --wheel wheel.json --json arm.json");
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("driver's own arm, less the wheel of wheel.json"), std::string::npos) << ended.out;

  const auto wheel = nlohmann::json::parse(read("wheel.json")).at("batch");
  EXPECT_NEAR(wheel.at("inertia_kgm2").at("value").get<double>(), kWheelInertia, 0.1 * kWheelInertia);
  EXPECT_NE(wheel.at("stiffness_nm_per_rad").at("state"), "valid");
  const auto batch = nlohmann::json::parse(read("arm.json")).at("batch");
  const auto own = batch.at("own_arm");
  for (const char* key : {"inertia_kgm2", "damping_nms_per_rad"}) {
    const auto number = [&](const nlohmann::json& of, const char* what) { return of.at(key).at(what).get<double>(); };
    EXPECT_NEAR(number(own, "value"), number(batch, "value") - number(wheel, "value"), 1e-12);
    EXPECT_NEAR(number(own, "sd"), std::hypot(number(batch, "sd"), number(wheel, "sd")), 1e-12);
  }
  EXPECT_EQ(own.at("stiffness_nm_per_rad"), batch.at("stiffness_nm_per_rad"));
}

// The same drive with and without the wheel's friction taken off.
TEST_F(OwnArmCommand, TakesTheFrictionOfTheWheelOffTheBar) {
  constexpr double kFriction_nm = 0.1;
  write("column.json", R"({"wheel_friction_nm": 0.1})");
  const std::string drive = "simulate --task drive --column column.json --probe 1 ";
  ASSERT_EQ(run(drive + "--steering 0 --release 1 58 --duration 58 --out off.csv").exit_code, 0);
  const Ended alone = run("identify off.csv --batch --json wheel.json");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_NE(alone.out.find("wheel's friction"), std::string::npos) << alone.out;
  const auto wheel = nlohmann::json::parse(read("wheel.json")).at("batch");
  EXPECT_NEAR(wheel.at("friction_nm").at("value").get<double>(), kFriction_nm,
              0.3 * kFriction_nm);  // 20 % too large by a noisy angle

  ASSERT_EQ(run(drive + "--hands both_3_9 --steering 0.05 --out both.csv --truth truth.csv").exit_code, 0);
  std::string log = read("both.csv");
  const std::string rim = "torque_rim_nm";
  write("on.csv", log.replace(log.find("," + rim) + 1, rim.size(), "something_else"));  // behind the comments
  const double truth = last_of(read("truth.csv"), "damping_nms_per_rad");
  const auto damping = [&](const std::string& arguments, const std::string& friction_by, const char* of) {
    const Ended ended = run("identify --batch --json arm.json " + arguments);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const auto arm = nlohmann::json::parse(read("arm.json"));
    const std::string said =
        friction_by.empty() ? "is taken off its torque" : friction_by + ", is taken off its torque";
    EXPECT_EQ(ended.out.find(said) != std::string::npos, !friction_by.empty()) << ended.out;
    return (*of == '\0' ? arm : arm.at(of)).at("damping_nms_per_rad").at("value").get<double>();
  };
  for (const char* of : {"", "batch"}) {
    EXPECT_GT(damping("on.csv", "", of), 1.15 * truth) << of;
    EXPECT_NEAR(damping("on.csv --wheel wheel.json", "wheel.json", of), truth, 0.12 * truth) << of;
    EXPECT_NEAR(damping("both.csv", "torque_rim and torque_bar", of), truth, 0.15 * truth) << of;
  }
  write("torn.json",
        R"({"inertia_kgm2":{"value":0.03,"sd":0.001,"state":"valid"},)"
        R"("damping_nms_per_rad":{"value":0.05,"sd":0.001,"state":"valid"},"friction_nm":{"value":-1,"sd":0}})");
  EXPECT_NE(run("identify on.csv --wheel torn.json").err.find("friction_nm of a wheel alone"), std::string::npos);
}

TEST_F(OwnArmCommand, RefusesAWheelThatIsNone) {
  ASSERT_EQ(run("simulate --task drive --steering 0 --out on.csv").exit_code, 0);
  ASSERT_EQ(run("identify on.csv --batch --json held.json").exit_code, 0);
  const Ended held = run("identify on.csv --wheel held.json");
  EXPECT_EQ(held.exit_code, 1);
  EXPECT_NE(held.err.find("held.json: expected a wheel alone, which has no stiffness"), std::string::npos) << held.err;
  write("bad.json", R"({"inertia_kgm2":{"value":0.03,"sd":0.001,"state":"not excited"}})");
  EXPECT_NE(run("identify on.csv --wheel bad.json").err.find("inertia_kgm2 of a wheel alone, valid"),
            std::string::npos);
  write("list.json", "[1]");
  EXPECT_EQ(run("identify on.csv --wheel list.json").exit_code, 1);
}

// A wheel with its column is another body than the wheel above the torsion bar, and is none to take off.
TEST_F(OwnArmCommand, TakesTheWheelOfTheSameEquationAlone) {
  const auto answer = [](const char* equation, const char* rest) {
    return std::string(R"({"equation":")") + equation +
           R"(","inertia_kgm2":{"value":0.03,"sd":0.001,"state":"valid"},)" +
           R"("damping_nms_per_rad":{"value":0.05,"sd":0.001,"state":"valid"})" + rest + "}";
  };
  ASSERT_EQ(run("simulate --task drive --steering 0 --out bar.csv").exit_code, 0);
  ASSERT_EQ(run("simulate --task probe --out motor.csv").exit_code, 0);
  write("column.json", answer("driver_motor", ""));
  write("above.json", answer("bar", ""));
  for (const char* wrong : {"bar.csv --wheel column.json", "motor.csv --wheel above.json"}) {
    const Ended ended = run(std::string("identify ") + wrong);
    EXPECT_EQ(ended.exit_code, 1) << wrong;
    EXPECT_NE(ended.err.find("found the equation "), std::string::npos) << ended.err;
  }
  EXPECT_EQ(run("identify bar.csv --wheel above.json").exit_code, 0);

  write("hangs.json", answer("driver_motor", R"(,"stiffness_nm_per_rad":{"value":0.5,"sd":0.1,"state":"valid"},
    "credible":false,"reasons":["with dry friction of 0.2 Nm B would be less"])"));
  const Ended hangs = run("identify motor.csv --wheel hangs.json --json arm.json");
  ASSERT_EQ(hangs.exit_code, 0) << hangs.err;
  EXPECT_NE(
      hangs.out.find("the wheel of hangs.json may be wrong, and with it the driver's own arm: it is not credible; "
                     "with dry friction of 0.2 Nm"),
      std::string::npos)
      << hangs.out;
  const auto found = nlohmann::json::parse(read("arm.json"));
  EXPECT_NEAR(found.at("own_arm").at("stiffness_nm_per_rad").at("value").get<double>(),
              found.at("stiffness_nm_per_rad").at("value").get<double>() - 0.5, 1e-9);
}

TEST(OwnArm, HasNoStateWhereNothingIsLeft) {
  Identification found;
  found.equation = Equation::kBar;
  found.inertia_kgm2 = {.value = 0.035, .sd = 0.001, .state = ParameterState::kValid};
  found.damping_nms_per_rad = {.value = 1, .sd = 0.03, .state = ParameterState::kValid};
  const WheelAlone wheel{{0.034, 0.0005}, {0.06, 0.01}, "wheel.json"};
  const auto own = own_arm(found, wheel);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->inertia_kgm2.state, ParameterState::kNotExcited);
  EXPECT_EQ(own->damping_nms_per_rad.state, ParameterState::kValid);
  EXPECT_DOUBLE_EQ(own->damping_nms_per_rad.value, 0.94);
  found.equation = Equation::kRim;
  EXPECT_FALSE(own_arm(found, wheel));
}

}  // namespace
}  // namespace steerid
