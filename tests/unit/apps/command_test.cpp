// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The command as a user meets it: exit codes and what stands on standard output and standard error.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "support/seed.hpp"
#include "support/steerid_command.hpp"

namespace steerid {
namespace {

class Command : public test::SteeridCommand {};

TEST_F(Command, VersionAndHelpGoToStandardOutput) {
  const Ended version = run("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out, "steerid " STEERID_VERSION "\n");
  const Ended help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("Exit codes"), std::string::npos);
  EXPECT_EQ(help.err, "");
}

TEST_F(Command, NoSubcommandIsBadUsage) {
  const Ended ended = run("");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(ended.err, "steerid: A subcommand is required\nTry `steerid --help`.\n");
}

TEST_F(Command, UnknownSubcommandIsNamed) {
  const Ended ended = run("identfy");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.err,
            "steerid: there is no command or option identfy; did you mean identify?\nTry `steerid --help`.\n");
}

TEST_F(Command, AnUnknownOptionIsNamedBeforeWhatIsMissing) {
  EXPECT_EQ(run("simulate --bogus").err,
            "steerid: there is no command or option --bogus\nTry `steerid simulate --help`.\n");
  EXPECT_EQ(run("study blind draw --bogus 3 --out x").err,
            "steerid: there is no command or option --bogus\nTry `steerid study blind draw --help`.\n");
  EXPECT_EQ(run("simulate").err, "steerid: --out is required\nTry `steerid simulate --help`.\n");
}

TEST_F(Command, AMistakePointsToTheHelpThatExplainsIt) {
  for (const char* part : {"draw", "seal", "score"}) {
    const Ended ended = run(fmt::format("study blind {}", part));
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_EQ(ended.err, fmt::format("steerid: --out is required\nTry `steerid study blind {} --help`.\n", part));
  }
}

TEST_F(Command, ASeedIsAWholeNumberOf64Bits) {
  for (const char* command :
       {"simulate --task probe --out x", "diagnose --real a.csv --sim a.json --out x", "study soak --out x",
        "study blind --out x", "study blind draw --out x", "experiment --out x", "hil --emulate an386 a.csv"}) {
    for (const char* seed : {"-1", "1.5", "one", "18446744073709551616"}) {
      const Ended ended = run(fmt::format("{} --seed {}", command, seed));
      EXPECT_EQ(ended.exit_code, 2) << command;
      EXPECT_NE(ended.err.find(fmt::format("--seed: expected a whole number from 0 to 2^64 - 1, found \"{}\"\n", seed)),
                std::string::npos)
          << ended.err;
      EXPECT_FALSE(exists("x"));
    }
  }
}

TEST_F(Command, APortThatIsNoneSaysWhatToDo) {
  ASSERT_EQ(run("simulate --task probe --duration 10 --out drive.csv").exit_code, 0);
  for (const char* port : {"drive.csv", ".", "/dev/nosuch"}) {
    const Ended ended = run(fmt::format("hil drive.csv --port {}", port));
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(ended.err.rfind(fmt::format("steerid: {}: expected the serial port of an ECU, found ", port), 0), 0U)
        << ended.err;
    EXPECT_NE(ended.err.find("name its port, as /dev/ttyACM0"), std::string::npos) << ended.err;
  }
}

TEST_F(Command, SimulateRepeatsItsLogFromTheSeedAndSaysWhatItDid) {
  const Ended first = run("simulate --task probe --hands right_12 --duration 5 --seed 3 --out a.csv");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("J 0.11 kg m2, B 2.1 Nms/rad, C 45.9 Nm/rad"), std::string::npos) << first.out;
  EXPECT_NE(first.out.find("a.csv, 500 rows"), std::string::npos) << first.out;
  ASSERT_EQ(run("simulate --task probe --hands right_12 --duration 5 --seed 3 --out b.csv").exit_code, 0);
  ASSERT_EQ(run("simulate --task probe --hands right_12 --duration 5 --seed 4 --out c.csv").exit_code, 0);
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  EXPECT_NE(read("a.csv"), read("c.csv"));
  EXPECT_NE(read("a.csv").find("\ntime_s,torque_driver_nm,torque_motor_nm,angle_rad\n"), std::string::npos);
}

TEST_F(Command, SimulateReplaysItsOwnLogOnToItsOwnAngle) {
  write("sim.json", R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7,
                        "sensors":{"angle":{"noise":{"sd_rad":0.001}}}})");
  ASSERT_EQ(run("simulate --task probe --sim sim.json --duration 20 --out log.csv").exit_code, 0);
  const Ended replay = run("simulate --sim sim.json --replay log.csv --out predicted.csv");
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  std::istringstream log(read("log.csv"));
  std::istringstream predicted(read("predicted.csv"));
  std::string row;
  while (std::getline(log, row) && row.starts_with('#')) continue;
  std::getline(predicted, row);
  EXPECT_EQ(row, "time_s,angle_rad");
  double squares = 0;
  int rows = 0;
  double time_s = 0;
  double driver = 0;
  double motor = 0;
  double angle = 0;
  double time_again_s = 0;
  double free_run = 0;
  char comma = 0;
  while (log >> time_s >> comma >> driver >> comma >> motor >> comma >> angle) {
    ASSERT_TRUE(predicted >> time_again_s >> comma >> free_run);
    ASSERT_EQ(time_s, time_again_s);
    squares += (angle - free_run) * (angle - free_run);
    ++rows;
  }
  EXPECT_EQ(rows, 2000);
  // Only the file's angle noise of 1 mrad is left: its rms over 2000 samples is known to 4.5/sqrt(4000) = 7 %.
  EXPECT_NEAR(std::sqrt(squares / rows), 0.001, 0.00007);
}

TEST_F(Command, SimulateRefusesBadOptionsWithTwoAndBadFilesWithOne) {
  for (const char* bad :
       {"--task nap --out x", "--task probe --hands left --out x", "--task probe --duration 0 --out x",
        "--task probe --effect magic --out x", "--task probe", "--out x", "--replay x --out y",
        "--task probe --effect backlash --effect compliance --out x"}) {
    EXPECT_EQ(run(std::string("simulate ") + bad).exit_code, 2) << bad;
    EXPECT_EQ(read("x"), "") << bad;
  }
  write("sim.json", R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7,
                        "sensors":{"angle":{"noise":{"sd_nm":1}}}})");
  const Ended ended = run("simulate --task probe --sim sim.json --out x.csv");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("sim.json, at /sensors/angle/noise/sd_nm: expected one of sd_rad"), std::string::npos)
      << ended.err;
  EXPECT_EQ(run("simulate --task probe --sim missing.json --out x.csv").exit_code, 1);
  EXPECT_EQ(run("simulate --task probe --out missing/x.csv").exit_code, 1);
}

TEST_F(Command, SimulatePlaysTheProbeThatADiagnosisProposes) {
  const std::string probe = R"({"rms_nm":0.8,"low_hz":1,"high_hz":2,"period_s":5,"duration_s":20})";
  write("diagnosis.json", R"({"verdict":"none","next_experiment":{"why":"","probe":)" + probe + "}}");
  write("probe.json", probe);
  ASSERT_EQ(run("simulate --task probe --probe diagnosis.json --noise none --out a.csv").exit_code, 0);
  ASSERT_EQ(run("simulate --task probe --probe probe.json --noise none --out b.csv").exit_code, 0);
  // Twenty seconds, repeating after five, 0.8 Nm rms.
  std::stringstream rows(read("a.csv"));
  std::string line;
  std::vector<double> motor;
  while (std::getline(rows, line)) {
    double time = 0;
    double driver = 0;
    double value = 0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &time, &driver, &value) == 3) motor.push_back(value);
  }
  ASSERT_EQ(motor.size(), 2000U);
  double squares = 0;
  for (std::size_t i = 0; i < motor.size(); ++i) squares += motor[i] * motor[i];
  EXPECT_NEAR(std::sqrt(squares / 2000), 0.8, 0.001);
  EXPECT_NEAR(motor[100], motor[600], 0.002);
  const auto without_head = [](const std::string& text) { return text.substr(text.find("time_s")); };
  EXPECT_EQ(without_head(read("a.csv")), without_head(read("b.csv")));

  write("bad.json", R"({"rms_nm":0.8,"low_hz":1,"high_hz":0.5,"period_s":5,"duration_s":20})");
  const Ended ended = run("simulate --task probe --probe bad.json --out x.csv");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("bad.json: expected a probe whose high_hz"), std::string::npos) << ended.err;
  for (const char* neither : {"25", "nosuchfile", "."}) {
    const Ended refused = run(fmt::format("simulate --task probe --probe {} --out x.csv", neither));
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.err,
              fmt::format("steerid: --probe: expected Nm rms from 0 to 20 or the file of a probe, found {}, "
                          "which is neither\nTry `steerid simulate --help`.\n",
                          neither));
  }
  write("bad.json", "{\"rms_nm\":0.8,\n \"low_hz\":1,,}");
  const Ended broken = run("simulate --task probe --probe bad.json --out x.csv");
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_EQ(broken.err.rfind("steerid: bad.json, line 2, column 13: expected JSON, found", 0), 0U) << broken.err;
}

TEST_F(Command, IdentifyFindsTheSimulatedArm) {
  ASSERT_EQ(run("simulate --task probe --duration 40 --seed 3 --out drive.csv").exit_code, 0);
  const Ended ended = run("identify drive.csv --batch --json a.json --trace t.csv --report r.html");
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("recursive"), std::string::npos);
  EXPECT_NE(ended.out.find("Gauss-Newton"), std::string::npos);

  // The wheel simulated by default; 3 % is far above what 40 s of probe leave (a fraction of a percent) and far below
  // the prior, which is 27 % off in J.
  const auto json = nlohmann::json::parse(read("a.json"));
  for (const auto& answer : {json, json.at("batch")}) {
    EXPECT_NEAR(answer.at("inertia_kgm2").at("value").get<double>() / 0.11, 1.0, 0.03);
    EXPECT_NEAR(answer.at("damping_nms_per_rad").at("value").get<double>() / 1.5, 1.0, 0.03);
    EXPECT_NEAR(answer.at("stiffness_nm_per_rad").at("value").get<double>() / 22.7, 1.0, 0.03);
    EXPECT_EQ(answer.at("stiffness_nm_per_rad").at("state"), "valid");
    EXPECT_LT(answer.at("free_run_nrmse").get<double>(), 0.05);
  }
  const std::string trace = read("t.csv");
  EXPECT_EQ(std::count(trace.begin(), trace.end(), '\n'), 4001);  // header and 40 s at 100 Hz
  EXPECT_EQ(read("r.html").rfind("<!doctype html>", 0), 0U);
}

TEST_F(Command, IdentifyRepeatsBitForBit) {
  ASSERT_EQ(run("simulate --task active --duration 20 --seed 4 --out drive.csv").exit_code, 0);
  ASSERT_EQ(run("identify drive.csv --batch --json a.json --trace a.csv --report a.html").exit_code, 0);
  ASSERT_EQ(run("identify drive.csv --batch --json b.json --trace b.csv --report b.html").exit_code, 0);
  EXPECT_EQ(read("a.json"), read("b.json"));
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  EXPECT_EQ(read("a.html"), read("b.html"));
}

TEST_F(Command, IdentifySaysWhatARecordDoesNotExcite) {
  // One slow sine fixes two numbers, C - J w^2 and B w: C cannot be told apart from J. The angle is the steady state of
  // J = 0.11, B = 1.5, C = 22.7 in closed form with 1 mrad of even noise; at 0.025 Hz, J w^2 is 0.01 % of C.
  const double omega = 2.0 * std::numbers::pi * 0.025;
  const std::complex<double> response = 1.0 / std::complex<double>(22.7 - 0.11 * omega * omega, 1.5 * omega);
  std::string log = "time_s,torque_driver_nm,angle_rad\n";
  std::mt19937 bits(static_cast<std::uint32_t>(test::seed(7)));
  for (int i = 0; i < 8000; ++i) {
    const double time_s = 0.01 * i;
    const std::complex<double> torque_nm = std::polar(5.0, omega * time_s);
    const double noise_rad = 0.002 * (static_cast<double>(bits()) / 4294967296.0 - 0.5);
    log += fmt::format("{:.2f},{:.6f},{:.6f}\n", time_s, torque_nm.real(), (torque_nm * response).real() + noise_rad);
  }
  write("slow.csv", log);
  const Ended ended = run("identify slow.csv --batch --json a.json");
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const auto json = nlohmann::json::parse(read("a.json"));
  for (const auto& answer : {json, json.at("batch")}) {
    EXPECT_NE(answer.at("inertia_kgm2").at("state"), "valid") << ended.out;
    EXPECT_NEAR(answer.at("stiffness_nm_per_rad").at("value").get<double>(), 22.7, 0.1) << ended.out;
    EXPECT_TRUE(answer.at("natural_frequency_hz").at("value").is_null()) << ended.out;
    EXPECT_NE(answer.at("natural_frequency_hz").at("reason"), "");
  }
}

TEST_F(Command, BadDataIsOneSentenceAndLeavesNoOutput) {
  write("bad.csv", "time_s,torque_driver_nm,angle_rad\n0.00,1,0\n0.01,one,0\n");
  const Ended ended = run("identify bad.csv --json a.json");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(ended.err.rfind("steerid: bad.csv, line 3, column 'torque_driver_nm': expected", 0), 0U) << ended.err;
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1);
  EXPECT_FALSE(exists("a.json"));
}

TEST_F(Command, AnOutputThatCannotBeWrittenIsNamed) {
  ASSERT_EQ(run("simulate --task probe --duration 10 --seed 1 --out drive.csv").exit_code, 0);
  write("sim.json", R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7})");
  // Before anything is computed: nothing has been said by then.
  for (const char* arguments :
       {"identify drive.csv --json no/such/folder/a", "identify drive.csv --trace no/such/folder/a",
        "identify drive.csv --report no/such/folder/a", "simulate --task probe --out no/such/folder/a",
        "simulate --sim sim.json --replay drive.csv --out no/such/folder/a",
        "hil --emulate an386 --firmware none.elf drive.csv --json no/such/folder/a"}) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.exit_code, 1) << arguments;
    EXPECT_NE(ended.err.find("no/such/folder"), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "") << arguments;
    EXPECT_FALSE(exists("no"));
  }
}

TEST_F(Command, AFolderThatCannotBeMadeIsNamed) {
  write("sim.json", R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7})");
  ASSERT_EQ(run("simulate --task probe --sim sim.json --duration 20 --out log.csv").exit_code, 0);
  write("file", "");
  // Before anything is computed: nothing has been said by then.
  for (const char* arguments :
       {"diagnose --real log.csv --sim sim.json --no-report", "diagnose --batch . --no-report", "experiment",
        "study efficiency --drives 10", "study closed_loop --drives 10", "study soak --updates 10000",
        "study blind --cases 1", "study blind seal --cases 1", "study blind draw --cases 1"}) {
    const Ended ended = run(std::string(arguments) + " --out file/gap");
    EXPECT_EQ(ended.exit_code, 1) << arguments;
    EXPECT_EQ(ended.out, "") << arguments;
    EXPECT_EQ(ended.err.rfind("steerid: file/gap: expected a folder that can be made", 0), 0U) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  }
}

TEST_F(Command, TriesAFolderWithoutLeavingAnythingInIt) {
  ASSERT_EQ(run("simulate --task probe --duration 10 --seed 1 --out drive.csv").exit_code, 0);
  write("kept.json", "as it was");
  EXPECT_EQ(run("identify drive.csv --json kept.json --report no/such/folder/a").exit_code, 1);
  EXPECT_EQ(read("kept.json"), "as it was");
  EXPECT_EQ(run("hil --emulate an386 --firmware none.elf drive.csv --json hil.json").exit_code, 1);
  EXPECT_FALSE(exists("hil.json"));
  const auto partial = [](const auto& entry) {
    return entry.path().filename().string().find("partial") != std::string::npos;
  };
  EXPECT_EQ(
      std::count_if(std::filesystem::directory_iterator(folder()), std::filesystem::directory_iterator(), partial), 0);
}

TEST_F(Command, BadOptionsOfIdentifyAreBadUsage) {
  for (const char* arguments : {"identify", "identify a.csv --scalar half", "identify a.csv --columns speed=v",
                                "identify a.csv --sign 2", "identify a.csv --wrong"}) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.exit_code, 2) << arguments;
    EXPECT_EQ(ended.out, "") << arguments;
    EXPECT_EQ(ended.err.rfind("steerid: ", 0), 0U) << ended.err;
  }
}

TEST_F(Command, AStudyTakesItsOwnSizesOnly) {
  for (const char* arguments :
       {"study tracking --out s --updates 20000", "study soak --out s --drives 20", "study faults --out s --hours 2",
        "study efficiency --out s --hours 2", "study tracking --out s --unmeasured 2",
        "study faults --out s --angle-offset 0.02", "study efficiency --out s --angle-offset 0.02",
        "study efficiency --out s --unmeasured 2", "study tracking --out s --minutes 2",
        "study validity --out s --minutes 0", "study faults --out s --unmeasured 60", "study"}) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.exit_code, 2) << arguments;
    EXPECT_FALSE(exists("s")) << arguments;
  }
}

TEST_F(Command, AStudyWithFindingsWritesItsThreeFiles) {
  const Ended ended = run("study soak --out s --updates 20000");
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  for (const char* name : {"s/soak.csv", "s/soak.json", "s/soak.html"}) EXPECT_TRUE(exists(name)) << name;
  EXPECT_NE(ended.out.find("at most 0 is asked"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace steerid
