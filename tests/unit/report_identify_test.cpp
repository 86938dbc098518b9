// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "report/identify_report.hpp"

namespace steerid::report {
namespace {

/// Three samples of an arm whose J settles and whose C was never excited.
IdentifyReport small_report() {
  IdentifyReport report;
  report.record_name = "drive.csv";
  report.time_s = {0, 1, 2};
  report.angle_rad = {0.1, 0.3, -0.2};
  report.torque_motor_nm = {1, 2, 3};
  report.free_run_angle_rad = {0.1, 0.25, -0.1};
  report.trace_time_s = report.time_s;
  report.inertia.recursive = {0.11, 0.001, "valid"};
  report.inertia.trace = {{5, 0.12, 0.11}, {9, 0.002, 0.001}, {{0, 1, "converging"}, {1, 2, "valid"}}};
  report.damping.recursive = {1.5, 0.02, "holding"};
  report.damping.trace = {{1, 1.4, 1.5}, {1, 0.1, 0.02}, {{0, 2, "holding"}}};
  report.stiffness.recursive = {20, std::numeric_limits<double>::infinity(), "not excited"};
  report.stiffness.trace = {{20, 20, 20}, {9, 9, 9}, {{0, 2, "not excited"}}};
  report.natural_frequency_reason = "C is not identified";
  return report;
}

template <class T>
std::vector<T> parts_of(const Page& page) {
  std::vector<T> out;
  for (const Part& part : page.parts) {
    if (const T* found = std::get_if<T>(&part)) out.push_back(*found);
  }
  return out;
}

const LineChart& titled(const std::vector<LineChart>& charts, const std::string& title) {
  for (const LineChart& chart : charts) {
    if (chart.title == title) return chart;
  }
  throw std::out_of_range("no chart " + title);
}

TEST(IdentifyReport, TheHeadlineSaysWhatIsAndWhatIsNotIdentified) {
  const Headline headline = parts_of<Headline>(identify_page(small_report())).at(0);
  EXPECT_EQ(headline.verdict, "J and B are identified; C is not.");
  EXPECT_EQ(headline.tone, Tone::kCaution);
  EXPECT_EQ(headline.numbers.at(0).value, "0.1100");
  EXPECT_EQ(headline.numbers.at(0).note, "\u00b1 0.0010");
  EXPECT_EQ(headline.numbers.at(2).state, "not excited");
  EXPECT_EQ(headline.numbers.at(2).note, "");
  EXPECT_EQ(headline.numbers.at(3).value, "none");
  EXPECT_EQ(headline.numbers.at(3).note, "C is not identified");
}

TEST(IdentifyReport, TheToneFollowsTheStates) {
  IdentifyReport report = small_report();
  report.stiffness.recursive.state = "valid";
  EXPECT_EQ(parts_of<Headline>(identify_page(report)).at(0).tone, Tone::kGood);
  for (IdentifiedParameter* p : {&report.inertia, &report.damping, &report.stiffness}) p->recursive.state = "fault";
  const Headline headline = parts_of<Headline>(identify_page(report)).at(0);
  EXPECT_EQ(headline.tone, Tone::kBad);
  EXPECT_EQ(headline.verdict, "No parameter is identified from this record.");
  report.inertia.batch = ParameterAnswer{0.11, 0.001, "valid"};
  report.damping.batch = ParameterAnswer{1.5, 0.01, "valid"};
  report.stiffness.batch = ParameterAnswer{22, 9, "not excited"};
  const Headline by_batch = parts_of<Headline>(identify_page(report)).at(0);
  EXPECT_EQ(by_batch.tone, Tone::kCaution);
  EXPECT_EQ(by_batch.verdict,
            "At its end the firmware identifies no parameter; the batch fit to the whole record identifies J and B.");
  report.damping.recursive.state = "holding";
  EXPECT_EQ(parts_of<Headline>(identify_page(report)).at(0).verdict,
            "At its end the firmware identifies B; the batch fit to the whole record identifies J and B.");
}

TEST(IdentifyReport, BatchAndPublishedColumnsStandOnlyWhereThereIsSomething) {
  IdentifyReport report = small_report();
  EXPECT_EQ(parts_of<Table>(identify_page(report)).at(0).columns.size(), 4U);
  report.damping.batch = ParameterAnswer{1.51, 0.01, "valid"};
  report.inertia.published = 0.112;
  const Page page = identify_page(report);
  const Table table = parts_of<Table>(page).at(0);
  ASSERT_EQ(table.columns.size(), 7U);
  EXPECT_EQ(std::get<std::string>(table.rows.at(1).at(4)), "1.510 \u00b1 0.010");
  EXPECT_EQ(std::get<std::string>(table.rows.at(0).at(6)), "0.1120");
  EXPECT_EQ(titled(parts_of<LineChart>(page), "Inertia J").marks.at(0).label, "published");
  EXPECT_EQ(titled(parts_of<LineChart>(page), "Damping B").marks.at(0).label, "batch");
  document_json(page);  // throws when a row does not fit its columns
}

// J is valid from 1 s on, where its band reaches from 0.12 - 1.96 * 0.002 = 0.11608 to 0.12392 and from 0.10804 to
// 0.11196: together 0.10804 to 0.12392, and 15 % of that on either side.
TEST(IdentifyReport, TheAxisShowsWhatIsKnownNotThePrior) {
  const auto charts = parts_of<LineChart>(identify_page(small_report()));
  const auto range = titled(charts, "Inertia J").y.range.value();
  EXPECT_NEAR(range[0], 0.10804 - 0.15 * 0.01588, 1e-9);
  EXPECT_NEAR(range[1], 0.12392 + 0.15 * 0.01588, 1e-9);
}

TEST(IdentifyReport, AParameterThatIsNeverValidStillHasARange) {
  const auto range = titled(parts_of<LineChart>(identify_page(small_report())), "Stiffness C").y.range.value();
  EXPECT_LT(range[0], 20);
  EXPECT_GT(range[1], 20);
}

TEST(IdentifyReport, TheResidualIsMeasuredLessModel) {
  const auto charts = parts_of<LineChart>(identify_page(small_report()));
  const Series& residual = titled(charts, "Residual, measured less free run").series.at(0);
  EXPECT_NEAR(residual.y.at(0), 0.0, 1e-12);
  EXPECT_NEAR(residual.y.at(1), 0.05, 1e-12);
  EXPECT_NEAR(residual.y.at(2), -0.1, 1e-12);
}

TEST(IdentifyReport, WhatIsMissingIsLeftOut) {
  IdentifyReport report = small_report();
  report.free_run_angle_rad.clear();
  const auto charts = parts_of<LineChart>(identify_page(report));
  EXPECT_EQ(charts.size(), 5U);                           // angle, torque, J, B, C; neither free run nor amplitudes
  EXPECT_EQ(titled(charts, "Torque").series.size(), 1U);  // the driver's torque was not recorded
}

}  // namespace
}  // namespace steerid::report
