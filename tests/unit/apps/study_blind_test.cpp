// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short blind study by the command itself: three processes, a seal, a score.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/temporary_folder.hpp"

namespace steerid {
namespace {

int steerid_with(const std::string& arguments) {
  const std::string line = std::string(STEERID_COMMAND) + " " + arguments + " > /dev/null 2>&1";
  const int status = std::system(line.c_str());  // NOLINT(cert-env33-c): our own command with our own words
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(StudyBlind, DrawsSealsDiagnosesAndScores) {
  const test::TemporaryFolder folder;
  const std::string out = folder.path().string();
  // Of these six five hold an effect of the vocabulary, one one from outside it. None takes long.
  ASSERT_EQ(steerid_with("study blind --cases 6 --seed 15 --out " + out), 0);
  const auto key = nlohmann::json::parse(text_of(folder.path() / "sealed" / "key.json"));
  EXPECT_EQ(key.at("sets").at("single").size(), 6U);

  const auto scores = nlohmann::json::parse(text_of(folder.path() / "blind.json")).at("single");
  EXPECT_EQ(scores.at("cases"), 6);
  EXPECT_EQ(scores.at("refused"), 0);
  // Six verdicts drawn by lot out of 25 have three right in 1 of 860 studies; a diagnosis that is right in three
  // records of four has fewer in 1 of 27.
  EXPECT_GE(scores.at("right").at("some").get<int>(), 3) << scores.dump(1);
  EXPECT_EQ(scores.at("false_alarms").at("some"), 0) << scores.dump(1);

  // Who touches the answers afterwards is found out.
  std::filesystem::permissions(folder.path() / "sealed" / "key.json", std::filesystem::perms::owner_all);
  std::ofstream(folder.path() / "sealed" / "key.json", std::ios::app) << "\n";
  EXPECT_EQ(steerid_with("study blind score --out " + out), 1);
}

TEST(StudyBlind, DrawsWheelsThatALoopHolds) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(steerid_with("study blind draw --cases 2 --seed 4 --position-loop --out " + folder.path().string()), 0);
  const auto key = nlohmann::json::parse(text_of(folder.path() / "key.json"));
  for (const auto& truth : key) EXPECT_EQ(truth.at("plant").at("task"), "loop");
}

TEST(StudyBlind, NeedsAPlaceAndOneKindOfRecord) {
  EXPECT_EQ(steerid_with("study blind"), 2);
  EXPECT_EQ(steerid_with("study blind --two-effects --leave-one-out --out /tmp/never"), 2);
  EXPECT_EQ(steerid_with("study nothing --out /tmp/never"), 2);
}

}  // namespace
}  // namespace steerid
