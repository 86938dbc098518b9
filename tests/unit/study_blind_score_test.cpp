// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The blind study's scores on tables small enough to be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "log/bad_input.hpp"
#include "study/blind_files.hpp"
#include "study/blind_score.hpp"
#include "study/several_score.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::blind_study {
namespace {

/// A record of `label` that was called `verdict` with probability p, the rest on `second`.
Case called(const std::string& label, const std::string& verdict, double p, const std::string& second) {
  Case one{.name = label + " " + verdict, .truth = {}, .answer = Answer{}};
  one.truth.label = label;
  one.truth.effects = label == "none" || label == "parameters" ? std::vector<std::string>{} : std::vector{label};
  one.answer->verdict = verdict;
  one.answer->probability = {{"none", 0}, {"parameters", 0}, {"delay", 0}, {"lag", 0}, {"reflex", 0}, {"unknown", 0}};
  one.answer->probability[verdict] = p;
  one.answer->probability[second] = 1 - p;
  return one;
}

TEST(BlindScore, CountsVerdictsRanksAndProbabilities) {
  std::vector<Case> cases = {
      called("delay", "delay", 0.9, "lag"),      // right: Brier 0.01 + 0.01
      called("delay", "lag", 0.6, "delay"),      // second: Brier 0.36 + 0.36
      called("none", "none", 1.0, "lag"),        // 0, but lag got 1 - 1 = 0
      called("none", "delay", 0.8, "none"),      // false alarm: 0.64 + 0.64
      called("unknown", "unknown", 0.7, "lag"),  // 0.09 + 0.09
      called("lag", "unknown", 0.5, "delay"),    // needless: lag 0: 0.25 + 0.25 + 1
  };
  const Scores s = score(cases);
  EXPECT_EQ(s.cases, 6U);
  EXPECT_EQ(s.right.some, 3U);
  EXPECT_EQ(s.top1.some, 3U);
  EXPECT_EQ(s.top3.some, 6U);  // lag shares the third place with what has no probability either
  EXPECT_EQ(s.false_alarms.some, 1U);
  EXPECT_EQ(s.false_alarms.all, 2U);
  EXPECT_EQ(s.abstained.some, 1U);
  EXPECT_EQ(s.abstained.all, 1U);
  EXPECT_EQ(s.needlessly_unknown.some, 1U);
  EXPECT_EQ(s.needlessly_unknown.all, 5U);
  EXPECT_NEAR(s.mean_probability, (0.9 + 0.4 + 1.0 + 0.2 + 0.7 + 0.0) / 6, 1e-12);
  EXPECT_NEAR(s.brier, (0.02 + 0.72 + 0.0 + 1.28 + 0.18 + 1.5) / 6, 1e-12);
  EXPECT_EQ(s.labels.at("delay").verdicts.at("lag"), 1U);
  EXPECT_EQ(s.labels.at("delay").right.some, 1U);
}

TEST(BlindScore, ARefusedRecordIsWrongAndStatesNothing) {
  Case one = called("delay", "delay", 1, "lag");
  one.answer.reset();
  const Scores s = score(std::vector{one});
  EXPECT_EQ(s.refused, 1U);
  EXPECT_EQ(s.right.some, 0U);
  EXPECT_EQ(s.top3.some, 0U);
  EXPECT_EQ(s.mean_probability, 0);
  EXPECT_EQ(s.brier, 1);
  EXPECT_EQ(s.labels.at("delay").verdicts.at("refused"), 1U);
}

TEST(BlindScore, EquivalentVerdictsCountApart) {
  Case one = called("delay", "lag", 0.6, "delay");
  one.answer->equivalent = {"delay"};
  const Scores s = score(std::vector{one});
  EXPECT_EQ(s.right.some, 0U);
  EXPECT_EQ(s.right_or_equivalent.some, 1U);
}

TEST(BlindScore, ReliabilityComparesWhatIsSaidWithWhatIsTrue) {
  std::vector<Case> cases;
  for (int i = 0; i < 10; ++i) cases.push_back(called("delay", i < 7 ? "delay" : "lag", 0.92, "reflex"));
  const Scores s = score(cases);
  // All in the band of 0.9 to 0.95: 0.92 said, 0.7 true.
  EXPECT_NEAR(s.calibration_error, 0.22, 1e-12);
  std::size_t filled = 0;
  for (const ReliabilityBand& band : s.reliability) {
    if (band.right.all == 0) continue;
    ++filled;
    EXPECT_NEAR(band.low, 0.9, 1e-12);
    EXPECT_NEAR(band.mean_probability, 0.92, 1e-12);
    EXPECT_NEAR(band.right.value(), 0.7, 1e-12);
  }
  EXPECT_EQ(filled, 1U);
}

TEST(BlindScore, DetectionGoesByGapOverFloor) {
  std::vector<Case> cases = {called("delay", "none", 1, "lag"), called("delay", "lag", 1, "delay"),
                             called("delay", "delay", 1, "lag")};
  cases[0].truth.gap_over_floor = 1.6;
  cases[1].truth.gap_over_floor = 2.0;  // an edge belongs to the band above it
  cases[2].truth.gap_over_floor = 30;
  const Scores s = score(cases);
  EXPECT_EQ(s.detection[0].noticed.some, 0U);
  EXPECT_EQ(s.detection[0].noticed.all, 1U);
  EXPECT_EQ(s.detection[1].noticed.some, 1U);
  EXPECT_EQ(s.detection[1].right.some, 0U);
  EXPECT_EQ(s.detection.back().right.some, 1U);
}

TEST(BlindScore, RecoveryIsOfTheRightOnes) {
  std::vector<Case> cases;
  for (const double found : {0.9, 1.0, 1.3}) {
    Case one = called("delay", "delay", 1, "lag");
    one.truth.parameters["delay"] = {{"delay_s", -1.0}, {"phase_rad", 0.1}};
    one.truth.arm = {{"inertia_kgm2", 0.1}};
    one.answer->causes = {
        {"delay", {{"delay_s", {-found, {-found - 0.15, -found + 0.15}}}, {"phase_rad", {3, {2, 4}}}}}};
    one.answer->arm = {{"inertia_kgm2", {0.1 * found, {0.1, 0.11}}}};
    one.answer->closed_fraction = Estimated{found, {found - 0.05, found + 0.05}};
    cases.push_back(one);
  }
  cases.push_back(called("delay", "lag", 1, "delay"));  // wrong: does not count
  const Scores s = score(cases);
  const Recovery& delay = s.recovery.at("delay.delay_s");
  EXPECT_EQ(delay.cases, 3U);
  EXPECT_NEAR(delay.median_error_percent, 10, 1e-9);
  EXPECT_NEAR(delay.p90_error_percent, 10 + 0.8 * 20, 1e-9);  // nine tenths of the way over 0, 10 and 30
  EXPECT_EQ(delay.covered.some, 2U);
  EXPECT_EQ(s.recovery.count("delay.phase_rad"), 0U);
  EXPECT_EQ(s.recovery.at("inertia_kgm2").covered.some, 3U);
  EXPECT_NEAR(s.median_closed, 1.0, 1e-12);
  EXPECT_EQ(s.closed_covers.some, 1U);
  EXPECT_EQ(s.closed_covers.all, 3U);
}

TEST(BlindScore, ASwingsInstantIsKnownButForWholePeriods) {
  const auto swing = [](double shape, double found_s) {
    Case one = called("delay", "delay", 1, "lag");
    one.truth.parameters["delay"] = {{"shape", shape}, {"length_s", 10}, {"time_s", 42}};
    one.answer->causes = {{"delay", {{"time_s", {found_s, {found_s - 0.5, found_s + 0.5}}}}}};
    return score(std::vector{one}).recovery.at("delay.time_s");
  };
  EXPECT_EQ(swing(2, 42.2).covered.some, 1U);
  EXPECT_EQ(swing(2, 12.2).covered.some, 1U);
  EXPECT_NEAR(swing(2, 12.2).median_error_percent, 100 * 0.2 / 12, 1e-9);
  EXPECT_EQ(swing(2, 17.2).covered.some, 0U);  // half a period is another swing
  EXPECT_EQ(swing(1, 12.2).covered.some, 0U);  // a ramp has no periods
}

TEST(BlindScore, PairsAreNamedWholeOrInPart) {
  const auto pair = [](std::vector<std::string> named) {
    Case one = called("delay", named.empty() ? "none" : named.front(), 1, "parameters");
    one.truth.effects = {"delay", "reflex"};
    for (const std::string& id : named) one.answer->causes.push_back({id, {}});
    return one;
  };
  const PairScores s =
      score_pairs(std::vector{pair({"reflex", "delay"}), pair({"delay"}), pair({"lag", "delay"}), pair({})});
  EXPECT_EQ(s.cases, 4U);
  EXPECT_EQ(s.both_named.some, 1U);
  EXPECT_EQ(s.one_named.some, 3U);
  EXPECT_EQ(s.only_true.some, 3U);
}

TEST(BlindScore, ChangesCountWithWhatIsDoneToAnEffect) {
  const auto several = [](std::vector<NamedCause> named, std::map<Change, double> inclusion) {
    Case one = called("delay", named.empty() ? "unknown" : named.front().effect, 1, "parameters");
    one.truth.several_case = "mixed";
    one.truth.changes = {{"delay", "add"}, {"backlash", "remove"}};
    one.answer->causes = std::move(named);
    one.answer->inclusion = std::move(inclusion);
    return one;
  };
  const NamedCause delay{"delay", {}, "add"};
  const NamedCause gone{"backlash", {}, "remove"};
  const NamedCause resized{"backlash", {}, "resize"};
  Case refused = several({}, {});
  refused.answer.reset();
  const SeveralScores s = score_several(std::vector{
      several({delay, gone}, {{{"delay", "add"}, 0.9}, {{"backlash", "remove"}, 0.8}}), several({delay}, {}),
      several({delay, resized}, {{{"delay", "add"}, 0.9}, {{"backlash", "resize"}, 0.6}}), several({}, {}), refused});
  EXPECT_EQ(s.cases, 5U);
  EXPECT_EQ(s.refused, 1U);
  EXPECT_EQ(s.all.exact.some, 1U);
  EXPECT_EQ(s.all.all_named.some, 1U);
  EXPECT_EQ(s.all.only_true.some, 4U);  // who names nothing names nothing false
  EXPECT_EQ(s.of.at("mixed").exact.all, 5U);
  // Squares of .1, .2, .1 and .6 over five records; distances of .1 of two, .2 of one and .6 of one.
  EXPECT_NEAR(s.brier, (0.01 + 0.04 + 0.01 + 0.36) / 5, 1e-12);
  EXPECT_NEAR(s.calibration_error, (2 * 0.1 + 0.2 + 0.6) / 4, 1e-12);
}

TEST(BlindScore, LeaveOneOutAcceptsUnknownAndWhatWasCalledEquivalent) {
  std::vector<Case> without = {called("delay", "unknown", 1, "lag"), called("delay", "lag", 1, "delay"),
                               called("delay", "reflex", 1, "delay")};
  std::vector<Case> whole = without;
  for (std::size_t i = 0; i < 3; ++i) without[i].name = whole[i].name = std::to_string(i);
  for (Case& one : whole) one.answer->equivalent = {"lag"};
  const LeaveOneOutScores s = score_leave_one_out(without, whole);
  EXPECT_EQ(s.unknown.some, 2U);
  EXPECT_EQ(s.effects.at("delay").impostors.at("lag"), 1U);
  EXPECT_EQ(s.effects.at("delay").impostors.at("reflex"), 1U);
  EXPECT_EQ(score_leave_one_out(without, {}).unknown.some, 1U);
}

TEST(BlindScore, CoulombFrictionWithAnOffsetIsAsymmetricFriction) {
  const auto left_out = [](std::vector<std::string> named) {
    Case one = called("asymmetric_friction", named.front(), 1, "lag");
    for (const std::string& id : named) one.answer->causes.push_back({id, {}});
    return score_leave_one_out(std::vector{one}, {}).unknown.some;
  };
  EXPECT_EQ(left_out({"coulomb_friction", "torque_bias"}), 1U);
  EXPECT_EQ(left_out({"coulomb_friction"}), 0U);
  EXPECT_EQ(left_out({"stribeck_friction", "torque_bias"}), 0U);
}

TEST(BlindScore, AShareCarriesWilsonsInterval) {
  const Share share{.some = 8, .all = 10};
  // Newcombe 1998, table I: 81 of 263 has 0.2553 to 0.3662.
  const Interval published = Share{81, 263}.ci95();
  EXPECT_NEAR(published.low, 0.2553, 5e-5);
  EXPECT_NEAR(published.high, 0.3662, 5e-5);
  EXPECT_NEAR(share.value(), 0.8, 1e-12);
  EXPECT_TRUE(std::isnan(Share{}.value()));
}

// ---- files ----

constexpr const char* kKey = R"({"case000":{"label":"delay","effects":["delay"],"parameters":{"delay":{"delay_s":0.02}},
  "plant":{"task":"probe","arm":{"inertia_kgm2":0.1,"damping_nms_per_rad":1.2,"stiffness_nm_per_rad":25}},"ratio":3.5}})";
constexpr const char* kDiagnosis = R"({"verdict":"delay","ranking":[{"effect":"delay","probability":0.97},
  {"effect":"lag","probability":0.03}],"causes":[{"effect":"delay","parameters":{"delay_s":0.021},"closes":0.9,
  "ci95":{"delay_s":[0.019,null]}}],"equivalent":["lag"],"gap":{"closed_fraction":0.9,"closed_fraction_ci95":[0.8,1.1]},
  "base":{"inertia_kgm2":{"value":0.101,"ci95":[0.09,0.11]},"damping_nms_per_rad":{"value":null,"ci95":[null,null]}}})";

TEST(BlindFiles, KeyAndDiagnosisAreReadAsTheyAreWritten) {
  const auto key = read_key(kKey, "key.json");
  EXPECT_EQ(key.at("case000").parameters.at("delay").at("delay_s"), 0.02);
  EXPECT_EQ(key.at("case000").gap_over_floor, 3.5);
  EXPECT_THROW((void)read_key("{\"case000\":{}}", "key.json"), BadInput);

  const test::TemporaryFolder folder;
  const auto file = folder.path() / "diagnosis.json";
  EXPECT_FALSE(read_answer(file).has_value());
  std::ofstream(file) << kDiagnosis;
  const Answer answer = read_answer(file).value();
  EXPECT_EQ(answer.causes.at(0).parameters.at("delay_s").ci95.low, 0.019);
  EXPECT_TRUE(std::isinf(answer.causes.at(0).parameters.at("delay_s").ci95.high));
  EXPECT_EQ(answer.probability.at("lag"), 0.03);
  EXPECT_EQ(answer.closed_fraction->ci95.high, 1.1);
  EXPECT_TRUE(std::isnan(answer.arm.at("damping_nms_per_rad").value));
  std::ofstream(file) << "{}";
  EXPECT_THROW((void)read_answer(file), BadInput);
}

TEST(BlindFiles, EveryKindOfStudyIsWritten) {
  Study study{.seed = 7, .key_sha256 = "abc"};
  study.cases = {called("delay", "delay", 0.9, "lag"), called("none", "none", 1, "lag")};
  study.pairs = {called("delay", "delay", 0.9, "lag")};
  study.left_out = {called("delay", "unknown", 0.9, "lag")};
  const test::TemporaryFolder folder;
  write_blind_study(folder.path(), study);
  std::ifstream csv(folder.path() / "blind.csv");
  std::string line;
  std::size_t lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 1 + 2 + 1 + 1U);
  EXPECT_NE(blind_json(study).find("\"leave_one_out\""), std::string::npos);
  EXPECT_NE(blind_text(study).find("verdict right"), std::string::npos);
  EXPECT_NE(report::html(blind_page(study)).find("Which is taken for which"), std::string::npos);
}

}  // namespace
}  // namespace steerid::blind_study
