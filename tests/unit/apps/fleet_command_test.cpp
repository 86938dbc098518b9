// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Many records by the command: shards against one machine, lists, pipes, and records that break.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/steerid_command.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class FleetCommand : public test::SteeridCommand {
 protected:
  /// Four records of ten seconds, and one that cannot be read.
  FleetCommand() {
    for (const char* name : {"a", "b", "c", "d", "e"}) {
      fs::create_directories(folder() / "drives" / name);
      write(std::string("drives/") + name + "/sim.json",
            R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7})");
      const std::string log = std::string("drives/") + name + "/log.csv";
      EXPECT_EQ(run("simulate --task probe --duration 10 --seed " + std::to_string(*name) + " --sim drives/" + name +
                    "/sim.json --out " + log)
                    .exit_code,
                0);
    }
    write("drives/d/log.csv", "time_s\nnever\n");
  }

  [[nodiscard]] std::map<std::string, std::string> everything(const std::string& below) const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder() / below)) {
      const std::string name = entry.path().lexically_relative(folder()).string();
      if (entry.is_regular_file()) out[name.substr(below.size())] = read(name);
    }
    return out;
  }

  /// The same question whole and in shards, in one folder of answers and in one each.
  void expect_the_same(const std::string& question) {
    EXPECT_EQ(run(question + " --out whole").exit_code, 1);  // one record is refused
    const auto whole = everything("whole");
    EXPECT_TRUE(whole.contains("/table.csv"));
    EXPECT_TRUE(whole.contains("/fleet/records.jsonl"));
    std::string own;
    for (const char* shard : {"1/3", "2/3", "3/3"}) {
      (void)run(question + " --out shared --threads 1 --shard " + shard);
      (void)run(question + " --out own" + shard[0] + " --shard " + shard);
      own += std::string(" own") + shard[0];
    }
    const Ended merged = run("merge" + own + " --out merged");
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(merged.out, "5 records, 4 answered, 1 not usable; table in merged/table.csv\n");
    EXPECT_EQ(everything("merged"), whole);
    EXPECT_EQ(run("merge shared --out shared").exit_code, 0);
    auto shared = everything("shared");
    for (const char* shard : {"1", "2", "3"}) {
      for (const char* kind : {"jsonl", "csv"}) {
        EXPECT_EQ(shared.erase(std::string("/fleet/shard_") + shard + "_of_3." + kind), 1U);
      }
    }
    EXPECT_EQ(shared, whole);
  }
};

TEST_F(FleetCommand, DiagnosesTheSameInShards) { expect_the_same("diagnose --batch drives --no-report"); }

TEST_F(FleetCommand, IdentifiesTheSameInShards) { expect_the_same("identify --folder drives --no-report"); }

TEST_F(FleetCommand, IdentifiesAFolderAsOneByOne) {
  EXPECT_EQ(run("identify --folder drives --batch --out found").exit_code, 1);
  EXPECT_EQ(run("identify drives/a/log.csv --batch --json one.json --report one.html").exit_code, 0);
  Json of_folder = Json::parse(read("found/a/identification.json"));
  EXPECT_EQ(of_folder.erase("made_from"), 1U);
  EXPECT_EQ(of_folder, Json::parse(read("one.json")));
  EXPECT_EQ(read("found/a/report.html"), read("one.html"));
  EXPECT_FALSE(exists("found/d"));
  EXPECT_NE(run("identify --folder drives --batch --out found").out.find("4 kept"), std::string::npos);
  EXPECT_NE(run("identify --folder drives --out found").out.find(" 0 kept"), std::string::npos);
}

TEST_F(FleetCommand, TakesTheRecordsOfAList) {
  write("list.csv", "record,vehicle\ne,V1\nmissing,V1\na,V2\n");
  const Ended ended = run("identify --folder drives --list list.csv --out found --no-report");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err, "steerid: 1 of 3 records are not usable; found/table.csv says why\n");
  EXPECT_TRUE(exists("found/a/identification.json"));
  EXPECT_FALSE(exists("found/b"));
  std::istringstream table(read("found/table.csv"));
  std::string line;
  std::string names;
  while (std::getline(table, line)) names += line.substr(0, line.find(',')) + " ";
  EXPECT_EQ(names, "case e missing a ");
}

TEST_F(FleetCommand, GivesUpARecordAtWhichItDiedThreeTimes) {
  fs::create_directories(folder() / "found" / "b");
  write("found/b/.attempts", "3");  // as three dead runs leave it
  const Ended ended = run("identify --folder drives --out found --no-report");
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_TRUE(exists("found/a/identification.json"));
  EXPECT_NE(read("found/table.csv").find("\nb,,,,,,,,,,,,internal error: the program died 3 times"), std::string::npos);
  EXPECT_FALSE(exists("found/b"));
  EXPECT_EQ(run("identify --folder drives --out found --no-report").exit_code, 1);  // and is tried again
  EXPECT_TRUE(exists("found/b/identification.json"));
}

TEST_F(FleetCommand, AnswersLinesInTheirOrder) {
  write("lines", R"({"id":"x","real":"drives/a/log.csv","sim":"drives/a/sim.json"})"
                 "\nnonsense\n\n"
                 R"({"id":[2],"real":"drives/d/log.csv","sim":"drives/a/sim.json"})"
                 "\n"
                 R"({"real":"drives/b/log.csv","sim":7})"
                 "\n");
  const Ended ended = run("diagnose --json-lines --no-report <lines");
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  std::istringstream out(ended.out);
  std::vector<Json> answers;
  for (std::string line; std::getline(out, line);) answers.push_back(Json::parse(line));
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_EQ(run("diagnose --batch drives --out gaps --no-report").exit_code, 1);
  const Json whole = Json::parse(read("gaps/a/diagnosis.json"));
  EXPECT_EQ(answers[0], (Json{{"id", "x"}, {"ended", "answered"}, {"answer", whole}}));
  EXPECT_EQ(answers[1]["id"], nullptr);
  EXPECT_EQ(answers[1]["ended"], "unusable");
  EXPECT_EQ(answers[2]["id"], Json::array({2}));
  EXPECT_EQ(answers[2]["ended"], "unusable");
  EXPECT_EQ(answers[3]["id"], 5);  // its line
  EXPECT_NE(answers[3]["error"].get<std::string>().find("expected a path under \"sim\", found 7"), std::string::npos);
}

TEST_F(FleetCommand, ShardsOfOtherInputsAreNotMerged) {
  (void)run("identify --folder drives --out one --no-report --shard 1/2");
  fs::remove_all(folder() / "drives" / "e");
  (void)run("identify --folder drives --out two --no-report --shard 2/2");
  const Ended ended = run("merge one two --out merged");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("found another list of records (4 beside 5)"), std::string::npos) << ended.err;
  EXPECT_FALSE(exists("merged"));
  EXPECT_EQ(run("identify --folder drives --out two --shard 3/2").exit_code, 2);
  EXPECT_EQ(run("identify drives/a/log.csv --shard 1/2").exit_code, 2);
}

}  // namespace
}  // namespace steerid
