// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid diagnose` of a record whose columns cannot be what they say.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/steerid_command.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

class NotCredible : public test::SteeridCommand {
 protected:
  NotCredible() {
    write("sim.json", R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7})");
    for (const std::string seed : {"3", "4"}) {
      const std::string log = seed + ".csv";
      EXPECT_EQ(run("simulate --task active --duration 30 --sim sim.json --seed " + seed + " --out " + log).exit_code,
                0);
    }
  }
};

TEST_F(NotCredible, NamesNothingAndProposesNoProbe) {
  const auto diagnosed = [&](const std::string& options) { return run("diagnose --sim sim.json --out a " + options); };
  ASSERT_EQ(diagnosed("--real 3.csv --no-report").exit_code, 0);
  EXPECT_EQ(Json::parse(read("a/diagnosis.json"))["verdict"], "none");
  // With its angle turned round.
  for (const std::string records : {"--real 3.csv", "--real 3.csv --real 4.csv"}) {
    const Ended ended = diagnosed(records + " --no-report --sign -1");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const Json answer = Json::parse(read("a/diagnosis.json"));
    EXPECT_EQ(answer["verdict"], "unknown") << records;
    EXPECT_NEAR(answer["probability"].get<double>(), 1, 1e-3) << records;
    EXPECT_TRUE(answer["causes"].empty()) << answer["causes"];
    for (const Json& change : answer["inclusion"]) EXPECT_EQ(change["probability"], 0) << change;
    EXPECT_EQ(answer["next_experiment"]["why"], "No probe tells anything before the record's columns are right.");
    EXPECT_TRUE(ended.out.starts_with("Nothing is named, as no answer to this record is credible: ")) << ended.out;
    EXPECT_NE(ended.out.find("with both torques turned round"), std::string::npos) << ended.out;
  }
}

}  // namespace
}  // namespace steerid
