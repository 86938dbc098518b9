// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page of a study: the answer in a sentence, a chart of each parameter over all cases, the full tables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/study_files.hpp"

namespace steerid {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kNames[] = {"inertia J", "damping B", "stiffness C"};
constexpr const char* kSymbols[] = {"J", "B", "C"};

/// The method's figures over all cases and parameters.
template <class Figure>
Interval range_of(const StudyResult& result, std::size_t method, Figure figure) {
  Interval range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const CaseResult& one : result.cases) {
    for (const ParameterScore& p : one.scores[method].parameters) {
      range.low = std::min(range.low, figure(p));
      range.high = std::max(range.high, figure(p));
    }
  }
  return range;
}

double ratio_of(const ParameterScore& p) { return p.ratio; }
double coverage_of(const ParameterScore& p) { return p.coverage ? 100 * *p.coverage : kNothing; }

report::Headline headline(const StudyResult& result) {
  report::Headline head;
  head.verdict = fmt::format(
      "{}: {} drives of {:.0f} s in each of {} cases, seed {}.", result.plan.title, result.drives,
      static_cast<double>(result.cases.front().what.drive.samples) / kStudyRate_hz, result.cases.size(), result.seed);
  for (std::size_t m = 0; m < std::min<std::size_t>(3, result.plan.methods.size()); ++m) {
    const std::string label(name(result.plan.methods[m]));
    const Interval ratio = range_of(result, m, ratio_of);
    const Interval coverage = range_of(result, m, coverage_of);
    head.numbers.push_back(
        {.label = label,
         .value = fmt::format("{:.2f} to {:.2f}", ratio.low, ratio.high),
         .unit = "times the bound",
         .note = fmt::format("95 % intervals cover {:.1f} to {:.1f} %", coverage.low, coverage.high)});
  }
  return head;
}

/// One chart a parameter: a group of bars a case, a bar a method.
template <class Figure, class Ends>
report::Bars bars(const StudyResult& result, std::size_t parameter, const std::string& what, Figure figure, Ends ends) {
  report::Bars chart;
  chart.title = fmt::format("{}: {}", kNames[parameter], what);
  for (const CaseResult& one : result.cases) chart.categories.push_back(one.what.wheel + ", " + one.what.noise);
  for (std::size_t m = 0; m < result.plan.methods.size(); ++m) {
    report::BarSeries series;
    series.name = name(result.plan.methods[m]);
    for (const CaseResult& one : result.cases) {
      const ParameterScore& p = one.scores[m].parameters[parameter];
      series.values.push_back(figure(p));
      series.low.push_back(ends(p).low);
      series.high.push_back(ends(p).high);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

void add_ratio_charts(report::Page& page, const StudyResult& result) {
  page.parts.push_back(
      report::Section{"How close to the bound",
                      "Root mean square error over the Cramer-Rao bound; 1 is the best that any unbiased "
                      "method can do. Whiskers: what so many drives leave open, 95 %."});
  for (std::size_t i = 0; i < 3; ++i) {
    report::Bars chart =
        bars(result, i, "error over the bound", ratio_of, [](const ParameterScore& p) { return p.ratio_95; });
    chart.value = {.label = "RMSE / bound", .log = true};
    chart.marks.push_back({.at = 1.0, .label = "the bound"});
    page.parts.push_back(std::move(chart));
  }
}

void add_coverage_charts(report::Page& page, const StudyResult& result) {
  page.parts.push_back(report::Section{
      "Whether a standard deviation is one",
      "Share of drives whose 95 % interval holds the truth. Whiskers: what so many drives leave open, 95 %."});
  for (std::size_t i = 0; i < 3; ++i) {
    report::Bars chart = bars(result, i, "coverage of the 95 % interval", coverage_of, [](const ParameterScore& p) {
      return p.coverage ? Interval{100 * p.coverage_95.low, 100 * p.coverage_95.high} : Interval{kNothing, kNothing};
    });
    chart.value = {.label = "covered", .unit = "%"};
    for (const double limit : {93.0, 97.0}) {
      chart.marks.push_back({.at = limit, .label = fmt::format("{} %", limit)});
    }
    page.parts.push_back(std::move(chart));
  }
}

report::Table table(const StudyResult& result, const CaseResult& one) {
  report::Table table;
  const WheelArm& wheel = one.what.drive.wheel;
  table.title = fmt::format("{}, {}", one.what.wheel, one.what.noise);
  table.caption = fmt::format("J {} kg m2, B {} Nms/rad, C {} Nm/rad", wheel.inertia_kgm2, wheel.damping_nms_per_rad,
                              wheel.stiffness_nm_per_rad);
  table.columns = {{.label = "method", .numeric = false}};
  for (const char* symbol : kSymbols) {
    table.columns.push_back({.label = fmt::format("{} bias", symbol), .unit = "%", .digits = 2});
    table.columns.push_back({.label = fmt::format("{} RMSE over bound", symbol), .digits = 3});
    table.columns.push_back({.label = fmt::format("{} covered", symbol), .unit = "%", .digits = 3});
  }
  table.columns.push_back({.label = "NEES", .digits = 3});
  table.columns.push_back({.label = "answered", .digits = 4});
  table.columns.push_back({.label = "restarted", .digits = 4});
  for (std::size_t m = 0; m < one.scores.size(); ++m) {
    const MethodScore& s = one.scores[m];
    std::vector<report::Cell> row = {std::string(name(result.plan.methods[m]))};
    for (const ParameterScore& p : s.parameters) {
      row.insert(row.end(), {p.bias_percent, p.ratio, coverage_of(p)});
    }
    row.insert(row.end(),
               {s.nees.value_or(kNothing), static_cast<double>(s.answered), static_cast<double>(s.restarted)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

report::Page study_page(const StudyResult& result) {
  report::Page page;
  page.title = "Study: " + result.plan.name;
  page.subtitle = result.plan.title;
  page.parts.push_back(headline(result));
  if (result.plan.name == "uncertainty") {
    add_coverage_charts(page, result);
    add_ratio_charts(page, result);
  } else {
    add_ratio_charts(page, result);
    add_coverage_charts(page, result);
  }
  const Interval nees = result.cases.front().scores.front().nees_95;
  page.parts.push_back(report::Section{
      "All figures",
      fmt::format("NEES is 3 when a stated covariance is true, and lies between {:.2f} and {:.2f} in 95 % of studies "
                  "of so many drives.",
                  nees.low, nees.high)});
  for (const CaseResult& one : result.cases) page.parts.push_back(table(result, one));
  page.footer = fmt::format("steerid study {} --drives {} --seed {}", result.plan.name, result.drives, result.seed);
  return page;
}

}  // namespace steerid
