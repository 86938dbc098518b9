// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whatever a reader lets through is diagnosed or refused with one sentence. Records with a known cause, damaged by
// chance; STEERID_MUTATIONS says how many.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>

#include "gap/consistent_answer.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/diagnosis_json.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/mutated_record.hpp"
#include "log/bad_input.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

std::size_t mutations() {
  constexpr std::size_t kFew = 12;
  const char* wanted = std::getenv("STEERID_MUTATIONS");
  return wanted == nullptr ? kFew : std::strtoull(wanted, nullptr, 10);
}

Record drawn(std::uint64_t seed) {
  test::DrawnDrive what;
  what.duration_s = 15;
  if (seed % 2 == 0) what.dry_friction_nm = 0.4;
  if (seed % 3 == 0) what.delay_s = 0.03;
  return test::drive(what, seed);
}

void expect_answer(const Diagnosis& diagnosis) {
  double sum = 0;
  for (const RankedEffect& one : diagnosis.ranking) {
    EXPECT_GE(one.probability, 0);
    sum += one.probability;
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_EQ(diagnosis.verdict, diagnosis.ranking.front().id);
  EXPECT_NO_THROW((void)diagnosis_json(diagnosis).dump());
  const std::string json = diagnosis.with_effect.to_json();
  EXPECT_NO_THROW((void)Simulation::from_json(json, "sim_with_effect.json")) << json;
}

void expect_sentence(const std::string& says) {
  EXPECT_FALSE(says.empty());
  EXPECT_EQ(says.find('\n'), std::string::npos) << says;
}

/// The rows that `keeps` is true of.
Record with_rows(const Record& whole, const std::function<bool(std::size_t)>& keeps) {
  Record record;
  record.motor_channel = whole.motor_channel;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (!keeps(i)) continue;
    record.time_s.push_back(whole.time_s[i]);
    record.torque_driver_nm.push_back(whole.torque_driver_nm[i]);
    record.torque_motor_nm.push_back(whole.torque_motor_nm[i]);
    record.angle_rad.push_back(whole.angle_rad[i]);
  }
  return record;
}

/// Rows lost at random, as a logger behind a network loses them, of a simulation that is exact.
TEST(MutatedRecords, WithRowsLostAtRandomAreStillExplained) {
  test::DrawnDrive what;
  Simulation exact;
  exact.wheel = what.wheel;
  const Record whole = test::drive(what, test::seed(4300));
  test::Noise draw(test::seed(4301));
  const auto verdict = [&](double share) {
    return diagnose(with_rows(whole, [&](std::size_t) { return !(draw.uniform() < share); }), exact).verdict;
  };
  for (const double share : {0.02, 0.1}) EXPECT_EQ(verdict(share), "none") << share;
  // A record that is split at every two lost rows is explained with four of twelve seeds, one whose lost rows are
  // bridged with eleven of twelve. Six draws of eight are so by chance once in 50 times then, and 39 times in 40 now.
  constexpr int kDraws = 8;
  int explained = 0;
  for (int i = 0; i < kDraws; ++i) explained += verdict(0.2) == "none" ? 1 : 0;
  EXPECT_GE(explained, 6);
}

TEST(MutatedRecords, WithoutAStretchThatTellsTheNoiseAreRefused) {
  const test::DrawnDrive what;
  Simulation exact;
  exact.wheel = what.wheel;
  const Record whole = test::drive(what, test::seed(4302));
  const auto in_stretches_of = [&](std::size_t rows) {  // and 100 ms between
    return with_rows(whole, [rows](std::size_t i) { return i % (rows + 10) < rows; });
  };
  EXPECT_EQ(diagnose(in_stretches_of(250), exact).verdict, "none");
  EXPECT_THROW((void)diagnose(in_stretches_of(150), exact), BadInput);
}

TEST(MutatedRecords, AreDiagnosedOrRefusedWithASentence) {
  const std::uint64_t first = test::seed(4200);
  std::size_t refused = 0;
  for (std::uint64_t i = first; i < first + mutations(); ++i) {
    std::string what;
    const Record record = test::Mutations(i).of(drawn(i), what);
    SCOPED_TRACE("STEERID_SEED=" + std::to_string(i) + " STEERID_MUTATIONS=1: " + what);
    std::cout << i << ": " << what << std::flush;
    try {
      const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(test::DrawnDrive{}.wheel));
      EXPECT_TRUE(test::is_consistent(diagnosis));
      std::cout << " -> " << diagnosis.verdict << std::endl;
      expect_answer(diagnosis);
    } catch (const BadInput& error) {
      std::cout << " -> " << error.what() << std::endl;
      expect_sentence(error.what());
      ++refused;
    }
  }
  // Both are met, or the damage is too small or too large to test anything.
  if (mutations() < 12) return;
  EXPECT_GT(refused, 0U);
  EXPECT_LT(refused, mutations());
}

bool says_time_was_up(const Diagnosis& diagnosis) {
  return std::ranges::any_of(diagnosis.notes,
                             [](const std::string& note) { return note.starts_with("the time limit was reached"); });
}

/// The time limit is asked between the parts, and its clock may stand anywhere.
TEST(MutatedRecords, ATimeLimitLeavesAnAnswerThatSaysWhatIsMissing) {
  test::DrawnDrive what;
  what.duration_s = 20;
  what.torque = [](double t, double, double v) { return -3.0 * v * (t > 10 ? 1 : 0); };  // in no vocabulary
  const Record record = test::drive(what, test::seed(4300));
  DiagnoseOptions options;
  options.out_of_time = [] { return true; };
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel), options);
  expect_answer(diagnosis);
  EXPECT_TRUE(says_time_was_up(diagnosis));
  what.torque = test::DrawnDrive{}.torque;  // what is in no vocabulary takes half a minute to the end
  const Record explained = test::drive(what, test::seed(4300));
  EXPECT_FALSE(says_time_was_up(diagnose(explained, test::off_by_five_percent(what.wheel))));
}

TEST(MutatedRecords, ATimeLimitEndsTheSearchForChangesToo) {
  test::DrawnDrive what;
  what.duration_s = 20;
  what.dry_friction_nm = 0.4;
  what.delay_s = 0.03;
  const Record record = test::drive(what, test::seed(4400));
  const Simulation simulation = Simulation::from_json(
      R"({"inertia_kgm2": 0.11, "damping_nms_per_rad": 1.5, "stiffness_nm_per_rad": 22.7,
          "effects": [{"effect": "coulomb_friction", "parameters": {"friction_nm": 0.4}}]})",
      "sim.json");
  DiagnoseOptions options;
  options.out_of_time = [] { return true; };
  const Diagnosis diagnosis = diagnose(record, simulation, options);
  expect_answer(diagnosis);
  EXPECT_TRUE(says_time_was_up(diagnosis));
  EXPECT_FALSE(says_time_was_up(diagnose(record, simulation)));
}

}  // namespace
}  // namespace steerid::gap
