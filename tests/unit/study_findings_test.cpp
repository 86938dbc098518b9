// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Findings told as text, CSV and JSON: what is written is what was found, and a missed figure is called so.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "study/findings.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

Findings two_rows() {
  Findings found;
  found.study = "sample";
  found.title = "A sample";
  found.how = "By hand.";
  found.command = "steerid study sample";
  found.asked = {{"slowest drive", "s", 2.5, 1.5, AskedFigure::Limit::kAtMost},
                 {"share found", "%", 96, 95, AskedFigure::Limit::kAtLeast}};
  found.tables = {{"times",
                   "Times",
                   "",
                   {{"drive", {.label = "drive", .numeric = false}},
                    {"parameter", {.label = "", .numeric = false}},
                    {"median_s", {.label = "median", .unit = "s"}}},
                   {{std::string("curve"), std::string("J"), 0.25},
                    {std::string("curve"), std::string("B"), std::numeric_limits<double>::quiet_NaN()}}}};
  return found;
}

TEST(Findings, AFigureIsMetOrMissed) {
  const auto met = [](double measured, double asked, AskedFigure::Limit limit) {
    return AskedFigure{"", "", measured, asked, limit}.met();
  };
  EXPECT_TRUE(met(1, 1, AskedFigure::Limit::kAtMost));
  EXPECT_FALSE(met(1.001, 1, AskedFigure::Limit::kAtMost));
  EXPECT_TRUE(met(1, 1, AskedFigure::Limit::kAtLeast));
  EXPECT_FALSE(met(0.999, 1, AskedFigure::Limit::kAtLeast));
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(met(none, 1, AskedFigure::Limit::kAtMost));
  EXPECT_FALSE(met(none, 1, AskedFigure::Limit::kAtLeast));
}

TEST(Findings, FewDrivesAndAnIntervalThatHoldsWhatIsAskedLeaveItOpen) {
  using Standing = AskedFigure::Standing;
  AskedFigure few{"worst kind", "s", 0.5, 1, AskedFigure::Limit::kAtMost, 9};
  EXPECT_EQ(few.standing(), Standing::kOpen);
  few.drives = 10;
  EXPECT_EQ(few.standing(), Standing::kMet);
  AskedFigure rate{.what = "false resets", .unit = "1/h", .measured = 0, .asked = 1, .ci95 = report::Ends{0, 3.69}};
  EXPECT_EQ(rate.standing(), Standing::kOpen);  // none in one hour
  rate.ci95 = report::Ends{0, 0.18};            // none in twenty
  EXPECT_EQ(rate.standing(), Standing::kMet);
  rate.measured = 3;
  rate.ci95 = report::Ends{2, 4};
  EXPECT_EQ(rate.standing(), Standing::kMissed);

  Findings found = two_rows();
  found.asked[1].drives = 1;
  EXPECT_NE(findings_text(found).find("0 of 2 figures that were asked for are met, 1 are missed; 1 stay open"),
            std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(findings_json(found))["asked"][1]["standing"], "open");
}

TEST(Findings, ACellIsFoundByItsNames) {
  const Findings found = two_rows();
  EXPECT_EQ(found.figure("times", "curve, J", "median_s"), 0.25);
  EXPECT_THROW((void)found.figure("times", "curve, C", "median_s"), std::out_of_range);
  EXPECT_THROW((void)found.figure("times", "curve, J", "worst_s"), std::out_of_range);
  EXPECT_THROW((void)found.figure("speeds", "curve, J", "median_s"), std::out_of_range);
}

TEST(Findings, TheTextSaysWhatIsMissedBesideWhatIsAsked) {
  const std::string text = findings_text(two_rows());
  EXPECT_NE(text.find("1 of 2 figures"), std::string::npos);
  EXPECT_NE(text.find("MISSED  slowest drive: 2.5 s (at most 1.5 s is asked)"), std::string::npos);
  EXPECT_NE(text.find("met     share found: 96 % (at least 95 % is asked)"), std::string::npos);
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(Findings, TheCsvHasOneRowAFigure) {
  EXPECT_EQ(findings_csv(two_rows()),
            "# steerid study sample\n"
            "table,case,figure,unit,value\n"
            "asked,\"slowest drive\",measured,s,2.5\n"
            "asked,\"slowest drive\",at most,s,1.5\n"
            "asked,\"share found\",measured,%,96\n"
            "asked,\"share found\",at least,%,95\n"
            "times,\"curve, J\",median_s,s,0.25\n"
            "times,\"curve, B\",median_s,s,\n");
}

TEST(Findings, TheJsonHoldsTheSame) {
  const auto json = nlohmann::json::parse(findings_json(two_rows()));
  EXPECT_EQ(json["schema"], "steerid.study/1");
  EXPECT_EQ(json["asked"][0]["at_most"], 1.5);
  EXPECT_EQ(json["asked"][0]["met"], false);
  EXPECT_EQ(json["asked"][1]["met"], true);
  EXPECT_EQ(json["asked"][1]["standing"], "met");
  EXPECT_EQ(json["tables"]["times"][0]["median_s"], 0.25);
  EXPECT_EQ(json["tables"]["times"][1]["drive"], "curve");
  EXPECT_TRUE(json["tables"]["times"][1]["median_s"].is_null());
}

TEST(Quantiles, AreOrderStatistics) {
  EXPECT_EQ(quantile({3, 1, 2, 4}, 0.5), 2);
  EXPECT_EQ(quantile({3, 1, 2, 4}, 0.9), 4);
  EXPECT_EQ(quantile({3, 1, 2, 4}, 0), 1);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace steerid
