// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Published rows, the arithmetic of equation 5, and spreads: against numbers worked out by hand from the printed
// tables.
#include <gtest/gtest.h>

#include <cmath>

#include "reproduction/table_rows.hpp"

namespace steerid {
namespace {

const FrequencyCheck& check_of(TaskKind task, HandPosition hands) {
  static std::vector<FrequencyCheck> checks;
  checks.push_back(check_frequency(published_row(task, hands)));
  return checks.back();
}

TEST(PublishedTables, AgreeWithTheNominalArms) {
  for (const PublishedRow& row : kPublishedRows) {
    const WheelArm nominal = nominal_arm(row.task, row.hands);
    EXPECT_EQ(row.nominal().inertia_kgm2, nominal.inertia_kgm2);
    EXPECT_EQ(row.nominal().damping_nms_per_rad, nominal.damping_nms_per_rad);
    EXPECT_EQ(row.nominal().stiffness_nm_per_rad, nominal.stiffness_nm_per_rad);
    for (const PublishedRange& range :
         {row.inertia_kgm2, row.damping_nms_per_rad, row.stiffness_nm_per_rad, row.natural_frequency_hz}) {
      EXPECT_LT(range.low, range.nominal);
      EXPECT_GT(range.high, range.nominal);
    }
  }
}

// w = sqrt((1 - xi^2) C/J): J 0.11, B 1.5, C 22.7 have xi = 1.5/(2 sqrt(2.497)) = 0.4746, w = 14.367 x 0.8802 = 12.645
// rad/s; C/B = 15.133 /s. The printed 3.3 Hz are 20.73 rad/s: more than any inertia gives.
TEST(FrequencyCheck, NoInertiaGivesThePrintedFrequencyAtThreeOClock) {
  const FrequencyCheck& check = check_of(TaskKind::kPassive, HandPosition::kRight3);
  EXPECT_NEAR(check.damping_ratio, 0.4746, 5e-5);
  EXPECT_NEAR(check.equation_5_hz.value_or(0), 2.0125, 5e-4);
  EXPECT_NEAR(check.undamped_hz, 2.2863, 5e-4);
  EXPECT_NEAR(check.highest_hz, 2.4085, 5e-4);
  EXPECT_FALSE(check.larger_inertia_kgm2);
}

// J 0.11, B 2.1, C 45.9: w^2 = 417.27 - 9.5455^2 = 326.16, 2.874 Hz, the one row that agrees with its printed 2.8 Hz.
TEST(FrequencyCheck, TwelveOClockAgrees) {
  const FrequencyCheck& check = check_of(TaskKind::kPassive, HandPosition::kRight12);
  EXPECT_NEAR(check.equation_5_hz.value_or(0), 2.8743, 5e-4);
  ASSERT_TRUE(check.larger_inertia_kgm2);
  EXPECT_NEAR(*check.larger_inertia_kgm2, 0.11, 0.01);
}

// 3.1 Hz with B 0.7 and C 17: w = 19.478, w^2 = 379.4; J = (17 +- sqrt(289 - 185.9))/758.8 = 0.00902 or 0.03579.
TEST(FrequencyCheck, OneThirtyNeedsAThirdOfThePrintedInertia) {
  const FrequencyCheck& check = check_of(TaskKind::kPassive, HandPosition::kRight130);
  ASSERT_TRUE(check.larger_inertia_kgm2);
  EXPECT_NEAR(*check.larger_inertia_kgm2, 0.03579, 2e-5);
  EXPECT_NEAR(*check.smaller_inertia_kgm2, 0.00902, 2e-5);
  // Either one does give 3.1 Hz.
  for (const double inertia : {*check.smaller_inertia_kgm2, *check.larger_inertia_kgm2}) {
    const double square = 17.0 / inertia - std::pow(0.7 / (2 * inertia), 2);
    EXPECT_NEAR(std::sqrt(square) / (2 * M_PI), 3.1, 1e-9);
  }
}

// xi of the active rows: 2.9/(2 sqrt(1.122)) = 1.369, 3.0/(2 sqrt(1.012)) = 1.491, 3.1/(2 sqrt(1.1)) = 1.478.
TEST(FrequencyCheck, TheActiveRowsAreOverdampedAndNoInertiaHelps) {
  const std::array expected{1.369, 1.491, 1.478};
  for (std::size_t i = 0; i < 3; ++i) {
    const FrequencyCheck& check = check_of(TaskKind::kActive, kAllHandPositions[i]);
    EXPECT_NEAR(check.damping_ratio, expected[i], 5e-4);
    EXPECT_FALSE(check.equation_5_hz);
    EXPECT_FALSE(check.larger_inertia_kgm2);
    EXPECT_LT(check.highest_hz, 0.57);  // 10.2/2.9/2 pi = 0.560 is the most of the three; 0.7 and 0.8 are printed
  }
}

TEST(Spread, IsTheMedianAndTheEnds) {
  EXPECT_EQ(spread_of({}).count, 0U);
  const Spread odd = spread_of({5, 1, 3});
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.low, 1);
  EXPECT_EQ(odd.high, 5);
  EXPECT_EQ(spread_of({4, 1, 2, 10}).median, 3);
}

TEST(Accuracy, PoolsWhatIsMissingOverAllRecords) {
  IdentifiedRecord first;
  first.quality.curves = {{1, 2}, {10, 10}, {9, 10}};  // 1 of 20 missing
  IdentifiedRecord second;
  second.quality.curves = {{1, 2}, {50, 30}, {50, 31}};  // 1 of 80
  const std::array both{first, second};
  EXPECT_DOUBLE_EQ(accuracy_of(both).pooled_percent, 98.0);
}

ArmAnswer valid_answer(double inertia, double damping, double stiffness) {
  return {{inertia, damping, stiffness}, {}, {ParameterState::kValid, ParameterState::kValid, ParameterState::kValid}};
}

TEST(ArmAnswer, HasNoFrequencyWithoutAllThree) {
  ArmAnswer answer = valid_answer(0.11, 1.5, 22.7);
  ASSERT_TRUE(answer.frequency());
  EXPECT_NEAR(answer.frequency()->hz, 2.0125, 5e-4);
  answer.state[0] = ParameterState::kNotExcited;
  EXPECT_FALSE(answer.frequency());
  EXPECT_EQ(valid_answer(0.11, 2.9, 10.2).frequency()->defined, NaturalFrequency::Defined::kOverdamped);
}

TEST(TableRows, CountOnlyWhatIsValidAndNameTheOverdamped) {
  ExperimentRun run;
  run.subjects = virtual_subjects(1);
  run.plain.resize(kRecordsOfAKind);
  run.probed.resize(kRecordsOfAKind);
  std::size_t overdamped = 0;
  for (std::size_t i = 0; i < kRecordsOfAKind; ++i) {
    const TaskKind task = i < kRecordsOfAKind / 2 ? TaskKind::kPassive : TaskKind::kActive;
    const HandPosition hands = kAllHandPositions[i / kSubjects % 6];
    run.probed[i].subject = run.plain[i].subject = i % kSubjects;
    run.probed[i].what.task = task;
    run.probed[i].what.hands = hands;
    run.probed[i].what.arm = run.subjects[i % kSubjects].arm(task, hands);
    const WheelArm& arm = run.probed[i].what.arm;
    // xi >= 1 is B^2 >= 4 J C.
    overdamped += arm.damping_nms_per_rad * arm.damping_nms_per_rad >= 4 * arm.inertia_kgm2 * arm.stiffness_nm_per_rad;
    run.probed[i].batch = valid_answer(arm.inertia_kgm2, arm.damping_nms_per_rad, arm.stiffness_nm_per_rad);
  }
  const std::vector<TableRow> rows = table_rows(run);
  ASSERT_EQ(rows.size(), 12U);
  std::size_t named = 0;
  for (const TableRow& row : rows) {
    EXPECT_EQ(row.plain[0].count, 0U);  // nothing valid there
    EXPECT_EQ(row.probed[0].count, kSubjects);
    EXPECT_EQ(row.probed[3].count + row.overdamped_probed, kSubjects);
    EXPECT_EQ(row.overdamped_probed, row.overdamped_truth);
    EXPECT_EQ(row.probed[2].median, row.truth[2].median);
    named += row.overdamped_truth;
  }
  EXPECT_EQ(named, overdamped);
  EXPECT_EQ(overdamped_records(run).size(), overdamped);
}

}  // namespace
}  // namespace steerid
