// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid diagnose --batch`: what is kept, what is refused, and how it ends.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/steerid_command.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;

class DiagnoseBatch : public test::SteeridCommand {
 protected:
  /// A record of ten seconds beside a simulation that is its wheel.
  DiagnoseBatch() {
    fs::create_directories(folder() / "drives" / "a");
    write("drives/a/sim.json", R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7})");
    EXPECT_EQ(run("simulate --task probe --duration 10 --sim drives/a/sim.json --out drives/a/log.csv").exit_code, 0);
  }

  [[nodiscard]] Ended diagnose(const std::string& more = "") const {
    return run("diagnose --batch drives --out gaps --no-report " + more);
  }

  /// Whether a run with these options kept the answer that was there.
  [[nodiscard]] bool kept(const std::string& more = "") const {
    const Ended ended = diagnose(more);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    return ended.out.find(" 1 kept") != std::string::npos;
  }
};

TEST_F(DiagnoseBatch, KeepsAnAnswerToTheSameQuestionOnly) {
  EXPECT_FALSE(kept());
  EXPECT_TRUE(kept());
  EXPECT_FALSE(kept("--seed 2"));
  EXPECT_FALSE(kept("--without delay"));
  EXPECT_TRUE(kept("--without delay"));
  // Other words of the same meaning are another question: nobody has to know what they mean.
  EXPECT_FALSE(kept("--columns angle=angle_rad"));
  EXPECT_TRUE(kept("--columns angle=angle_rad"));
  EXPECT_FALSE(kept());

  // A file that changed without becoming newer, as one that is copied with its time.
  const auto time = fs::last_write_time(folder() / "drives/a/sim.json");
  write("drives/a/sim.json", R"({"inertia_kgm2":0.12,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7})");
  fs::last_write_time(folder() / "drives/a/sim.json", time);
  EXPECT_FALSE(kept());
  write("other.json", read("drives/a/sim.json"));
  EXPECT_TRUE(kept("--sim other.json"));  // the same in another place

  // Another program: its mark is all that it can be known by.
  auto answer = nlohmann::ordered_json::parse(read("gaps/a/diagnosis.json"));
  answer["made_from"]["program"] = std::string(64, '0');
  write("gaps/a/diagnosis.json", answer.dump());
  EXPECT_FALSE(kept());
  fs::remove(folder() / "gaps/a/sim_with_effect.json");
  EXPECT_FALSE(kept());
  write("gaps/a/diagnosis.json", "{");
  EXPECT_FALSE(kept());
}

TEST_F(DiagnoseBatch, RefusesTwoRecordsOfOneName) {
  write("drives/a.csv", read("drives/a/log.csv"));
  write("drives/a.json", read("drives/a/sim.json"));
  const Ended ended = diagnose();
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err,
            "steerid: drives: expected records of different names, found a/log.csv and a.csv; rename one of them\n");
  EXPECT_FALSE(exists("gaps"));
}

TEST_F(DiagnoseBatch, TakesItsOwnTableForNoRecord) {
  write("drives/b.csv", read("drives/a/log.csv"));
  write("drives/b.json", read("drives/a/sim.json"));
  fs::remove_all(folder() / "drives" / "a");
  const std::string among_the_records = "diagnose --batch drives --out drives --no-report";
  ASSERT_EQ(run(among_the_records).exit_code, 0);
  const Ended again = run(among_the_records);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find("1 records, 1 kept"), std::string::npos) << again.out;

  write("drives/table.csv", read("drives/b.csv"));
  const Ended ended = run(among_the_records);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err,
            "steerid: drives/table.csv: expected the table of an earlier batch, which is written here, found a record; "
            "rename it or name another --out\n");
  EXPECT_EQ(read("drives/table.csv"), read("drives/b.csv"));
}

TEST_F(DiagnoseBatch, EndsWithOneWhenARecordIsRefusedAfterTheOthersAreDone) {
  write("drives/0.csv", "time_s,torque_driver_nm,angle_rad\n0.00,1,0\n0.01,one,0\n");
  write("drives/0.json", read("drives/a/sim.json"));
  fs::create_directories(folder() / "gaps" / "0");
  write("gaps/0/diagnosis.json", "{}");  // of an earlier run: it must not pass for this one's
  const Ended ended = diagnose();
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err, "steerid: 1 of 2 records are not usable; gaps/table.csv says why\n");
  EXPECT_TRUE(exists("gaps/a/diagnosis.json"));
  EXPECT_FALSE(exists("gaps/0"));
  const std::string table = read("gaps/table.csv");
  EXPECT_NE(table.find("\n0,,,,,,,,\"drives/0.csv, line 3, column 'torque_driver_nm': expected"), std::string::npos)
      << table;
}

TEST_F(DiagnoseBatch, AnOptionThatCannotBeReadIsBadUsage) {
  EXPECT_EQ(diagnose("--columns speed=v").exit_code, 2);
  EXPECT_FALSE(exists("gaps"));
}

}  // namespace
}  // namespace steerid
