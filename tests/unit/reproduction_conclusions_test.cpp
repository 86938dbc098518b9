// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The experiment's sentences: each says one thing of one kind of numbers and the other of the other.
#include <gtest/gtest.h>

#include "reproduction/conclusions.hpp"

namespace steerid {
namespace {

MeasuredErrors errors(double rms, double valid, double covered) {
  MeasuredErrors out;
  out.records = 60;
  out.rms.fill(rms);
  out.valid_share.fill(valid);
  out.covered.fill(covered);
  return out;
}

TEST(Conclusions, AParameterIsRightOnlyWithErrorValidityAndIntervals) {
  EXPECT_EQ(fault_of(errors(0.01, 1, 0.95), 2), Fault::kNone);
  EXPECT_EQ(fault_of(errors(0.11, 1, 0.95), 2), Fault::kError);
  EXPECT_EQ(fault_of(errors(0.01, 0.4, 1), 2), Fault::kSeldomValid);
  EXPECT_EQ(fault_of(errors(0.01, 1, 0.42), 2), Fault::kIntervals);
  // At most 52 of 60 hold the truth with a chance of .98 % where 95 % is true, at most 53 with 3.0 % (binomial).
  EXPECT_EQ(fault_of(errors(0.01, 1, 52.0 / 60), 2), Fault::kIntervals);
  EXPECT_EQ(fault_of(errors(0.01, 1, 53.0 / 60), 2), Fault::kNone);
  EXPECT_EQ(fault_of(errors(std::nan(""), 1, 1), 2), Fault::kError);
}

TEST(Conclusions, TheHeadlineNamesTheWorseTask) {
  const std::array good{errors(0.004, 1, 0.95), errors(0.006, 1, 0.95)};
  EXPECT_EQ(on_parameters(good), "C is right (0.6 % rms); J is right (0.6 % rms); B is right (0.6 % rms)");
  const std::array one_bad{errors(0.004, 1, 0.95), errors(0.004, 1, 0.42)};
  EXPECT_NE(on_parameters(one_bad).find("intervals of C hold the truth in 42 % of its answers"), std::string::npos);
  const std::array off{errors(0.004, 1, 0.95), errors(0.24, 1, 0.95)};
  EXPECT_NE(on_parameters(off).find("C is off by 24 % rms"), std::string::npos);
  const std::array rare{errors(0.004, 0.1, 0.95), errors(0.004, 1, 0.95)};
  EXPECT_NE(on_parameters(rare).find("C is valid in 10 % of the records only"), std::string::npos);
  constexpr std::array<std::size_t, 1> kStiffness{2};
  EXPECT_TRUE(right(good, kStiffness));
  EXPECT_FALSE(right(one_bad, kStiffness));
}

TEST(Conclusions, TheFitIsHeldAgainstThePapers) {
  EXPECT_NE(on_fit(99.1).find("99.1 % of the amplitude under 5 Hz, as in"), std::string::npos);
  EXPECT_NE(on_fit(96.9).find("96.9 % of the amplitude under 5 Hz, less than"), std::string::npos);
}

LabelCorrelation label(std::size_t which, std::size_t quantity, double p) {
  LabelCorrelation one{
      .label = which, .quantity = quantity, .records = 120, .plain = {}, .paired = {}, .ratio = {}, .effect = {}};
  one.effect.subjects = 10;
  one.effect.level_mean = {9.0, 27.0};
  one.effect_holm_p = p;
  return one;
}

TEST(Conclusions, ALabelAgreesWithThePaperOrNot) {
  EXPECT_NE(on_label(label(0, 2, 0.001)).find("works"), std::string::npos);
  EXPECT_NE(on_label(label(0, 2, 0.001)).find("as the paper says"), std::string::npos);
  EXPECT_NE(on_label(label(0, 2, 0.2)).find("where the paper says it does"), std::string::npos);
  EXPECT_NE(on_label(label(0, 0, 0.001)).find("where the paper says it does not"), std::string::npos);
  LabelCorrelation none = label(0, 3, 1);
  none.effect = {};
  EXPECT_NE(on_label(none).find("not tested, 0 subjects"), std::string::npos);
}

TEST(Conclusions, TheBasinAndTheExcitationFollowTheirNumbers) {
  EXPECT_NE(on_basin(0.4, 0.7).find("widens the basin, and does not make it whole"), std::string::npos);
  EXPECT_NE(on_basin(0.7, 0.4).find("narrows"), std::string::npos);
  EXPECT_NE(on_basin(0.7, 1.0).find("and makes it whole"), std::string::npos);
  ExcitationRow row{
      Performed::kToTheLetter, TaskKind::kPassive, HandPosition::kRight3, {}, {0.0}, {{5.0, 0.3, 0.001}}, {}};
  EXPECT_EQ(on_excitation(row),
            "To the letter and without a probe, the passive task shows C (to 0.1 %), and leaves J and B unexcited.");
  row.relative_sd = {{0.01, 0.02, 0.001}};
  EXPECT_EQ(on_excitation(row).find("unexcited"), std::string::npos);
}

}  // namespace
}  // namespace steerid
