// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "report/page.hpp"

namespace steerid::report {
namespace {

using nlohmann::json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

json first_part(Part part) {
  return json::parse(document_json(Page{.title = "t", .parts = {std::move(part)}}))["parts"][0];
}

LineChart chart_of(Series series) {
  return {.title = "chart", .x = {"Time", "s"}, .y = {"Angle", "rad"}, .series = {std::move(series)}};
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(Page, WhatIsNotFiniteBecomesNull) {
  const double inf = std::numeric_limits<double>::infinity();
  const json series =
      first_part(chart_of({"s", Meaning::kInertia, {0, 1, 2}, {1.5, kNan, -inf}, {inf, 0.1, kNan}}))["series"][0];
  EXPECT_EQ(series["y"], json::parse("[1.5,null,null]"));
  EXPECT_EQ(series["sd"], json::parse("[null,0.1,null]"));
  EXPECT_EQ(series["meaning"], "inertia");
}

TEST(Page, NumbersCarryNoMoreDigitsThanAChartShows) {
  const std::string text = document_json(Page{
      .title = "t", .parts = {chart_of({"s", Meaning::kPlain, {1700000000.01, 1700000000.02}, {1.0 / 3, 2e-9 / 3}})}});
  EXPECT_NE(text.find("[1700000000.01,1700000000.02]"), std::string::npos) << text;
  EXPECT_NE(text.find("[0.3333333,6.666667e-10]"), std::string::npos) << text;
}

TEST(Page, LongSeriesAreThinnedAndSaySo) {
  std::vector<double> x(100'000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  const json series = first_part(chart_of({"s", Meaning::kPlain, x, x, x}))["series"][0];
  EXPECT_EQ(series["samples"], 100'000);
  EXPECT_EQ(series["x"].size(), kSamplesKept);
  EXPECT_EQ(series["sd"], series["y"]);  // the same samples are kept of both
}

TEST(Page, StringsCannotLeaveTheScript) {
  const std::string awkward = "</script><!-- <script> & \" ' \\ \xff \u2028";
  const std::string plain = html(Page{.title = "t"});
  const std::string text = html(Page{.title = awkward, .subtitle = awkward, .parts = {Note{awkward, {awkward}}}});
  EXPECT_EQ(count(text, "</script>"), count(plain, "</script>"));
  EXPECT_EQ(count(text, "<!--"), count(plain, "<!--"));
  EXPECT_NE(text.find("<title>&lt;/script&gt;&lt;!-- &lt;script&gt; &amp; &quot; ' \\ \uFFFD \u2028</title>"),
            std::string::npos);
  const std::string open = "<script type=\"application/json\" id=\"document\">";
  const std::size_t from = text.find(open) + open.size();
  const json document = json::parse(text.substr(from, text.find("</script>", from) - from));
  EXPECT_EQ(document["subtitle"], "</script><!-- <script> & \" ' \\ \uFFFD \u2028");
}

TEST(Page, AsksNothingOfTheNetworkAndIsBelowOneMegabyte) {
  const std::string text = html(Page{.title = "t"});
  EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(count(text, "@STEERID_"), 0U);
  // ECharts alone is above 300 kB: less would be a page that cannot draw.
  EXPECT_GT(text.size(), 300'000U);
  EXPECT_LT(text.size(), 1'000'000U);
}

TEST(Page, ContradictionsAreRefused) {
  EXPECT_THROW(first_part(chart_of({"s", Meaning::kPlain, {0, 1}, {0}})), std::invalid_argument);
  EXPECT_THROW(first_part(chart_of({"s", Meaning::kPlain, {0, 1}, {0, 1}, {0}})), std::invalid_argument);
  EXPECT_THROW(first_part(Table{.title = "t", .columns = {{"a"}, {"b"}}, .rows = {{1.0}}}), std::invalid_argument);
  EXPECT_THROW(first_part(Histogram{.title = "h", .x = {"x"}, .name = "n", .edges = {0, 1}, .counts = {1, 2}}),
               std::invalid_argument);
  EXPECT_THROW(
      first_part(Bars{.title = "b", .categories = {"a"}, .value = {"v"}, .series = {{"s", Meaning::kPlain, {}}}}),
      std::invalid_argument);
  Bars marked{.title = "b", .categories = {"a"}, .value = {"v"}, .series = {{"s", Meaning::kPlain, {1}}}};
  marked.marks = {{.at = 1}};
  EXPECT_NO_THROW(first_part(marked));
  marked.marks = {{.axis = Mark::Along::kY, .at = 1}};  // bars lie along x: it would be a category
  EXPECT_THROW(first_part(marked), std::invalid_argument);
  EXPECT_THROW(first_part(Heatmap{.title = "h", .columns = {"a"}, .rows = {"r"}, .values = {{1, 2}}, .value = {"v"}}),
               std::invalid_argument);
}

TEST(Page, IsWrittenAsItIsAndTheSameTwice) {
  const auto path = std::filesystem::path(testing::TempDir()) / "steerid_report_page_test.html";
  const Page page{.title = "t", .parts = {chart_of({"s", Meaning::kPlain, {0, 1}, {kNan, 1}})}};
  write_page(path, page);
  std::ifstream in(path, std::ios::binary);
  const std::string read{std::istreambuf_iterator<char>(in), {}};
  EXPECT_TRUE(read == html(page));
  std::filesystem::remove(path);
}

TEST(StateSpans, OneSpanARunAndNoGapsBetween) {
  const std::vector<double> time_s = {0, 1, 2, 3, 4};
  const char* const states[] = {"starting", "valid", "valid", "holding", "valid"};  // NOLINT(modernize-avoid-c-arrays)
  const auto spans = state_spans(time_s, [&](std::size_t i) { return states[i]; });
  ASSERT_EQ(spans.size(), 4U);
  const std::vector<StateSpan> expected = {{0, 1, "starting"}, {1, 3, "valid"}, {3, 4, "holding"}, {4, 4, "valid"}};
  for (std::size_t i = 0; i < spans.size(); ++i) {
    EXPECT_EQ(spans[i].from, expected[i].from);
    EXPECT_EQ(spans[i].to, expected[i].to);
    EXPECT_EQ(spans[i].state, expected[i].state);
  }
}

}  // namespace
}  // namespace steerid::report
