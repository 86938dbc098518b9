// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a report is made of: one value type for each part of a page. They hold data and words only; how a part looks
// is decided in page/ (its twin there is page/src/document.ts).
//
// Numbers: a NaN or infinity is a gap, never an error. Long series are thinned when the page is written (thin.hpp).
// Words: any UTF-8; bytes that are not become U+FFFD. Nothing in a string is read as markup.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace steerid::report {

/// What a line, a cloud or a bar stands for. The colour follows from it alone and is the same in every report.
enum class Meaning {
  kMeasured,
  kModel,
  kResidual,
  kInertia,
  kDamping,
  kStiffness,
  kTorqueDriver,
  kTorqueMotor,
  kTorqueRim,
  kReference,  ///< what others published, or a limit
  kPlain,      ///< none of these
};

/// How good the news is.
enum class Tone { kNeutral, kGood, kCaution, kBad };

struct Axis {
  std::string label = {};
  std::string unit = {};                            ///< empty for a pure number
  bool log = false;                                 ///< values of zero and below are left out
  std::optional<std::array<double, 2>> range = {};  ///< as the data has it when absent
};

/// A straight dashed line across a chart.
struct Mark {
  enum class Along { kX, kY } axis = Along::kX;  ///< the axis that `at` is a value of
  double at = 0;
  std::string label = {};
  Meaning meaning = Meaning::kReference;
};

/// A stretch of the x axis, shaded.
struct Region {
  double from = 0;
  double to = 0;
  std::string label = {};
};

/// One state and how long it held, on the x axis of its chart.
struct StateSpan {
  double from = 0;
  double to = 0;
  std::string state =
      {};  ///< "valid", "converging", "starting", "holding", "fault", "not excited"; others are drawn grey
};

/// Spans from one state a sample: `state_at(i)` names the state at time_s[i], and holds until the next sample.
template <class StateAt>
std::vector<StateSpan> state_spans(std::span<const double> time_s, StateAt state_at) {
  std::vector<StateSpan> spans = {};
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (!spans.empty()) spans.back().to = time_s[i];
    if (spans.empty() || spans.back().state != state_at(i)) spans.push_back({time_s[i], time_s[i], state_at(i)});
  }
  return spans;
}

/// Of an interval.
struct Ends {
  double low = 0;
  double high = 0;
};

// ---- words ----

struct KeyNumber {
  std::string label = {};
  std::string value = {};  ///< as it is to be read, for example "0.1103"
  std::string unit = {};
  std::string note = {};   ///< small print beside it, for example "± 0.0012"
  std::string state = {};  ///< shown as a badge; empty for none
  std::optional<Meaning> meaning = {};
};

/// The answer, first: one sentence and the numbers that carry it.
struct Headline {
  std::string verdict = {};
  Tone tone = Tone::kNeutral;
  std::vector<KeyNumber> numbers = {};
};

/// A heading over the parts that follow.
struct Section {
  std::string title = {};
  std::string lead = {};
};

struct Note {
  std::string title = {};
  std::vector<std::string> paragraphs = {};
  Tone tone = Tone::kNeutral;
};

// ---- tables ----

struct Badge {
  std::string state = {};
};
/// Leads to `href`: "#KEY" of a table on this page, or a path relative to it; nothing else is followed.
struct Link {
  std::string text = {};
  std::string href = {};
};
/// A number is shown with its column's digits; a NaN is a dash.
using Cell = std::variant<std::string, double, Badge, Link>;

struct Column {
  std::string label = {};
  std::string unit = {};
  bool numeric = true;  ///< right-aligned
  int digits = 4;       ///< significant digits of its numbers
};

/// Every row has as many cells as there are columns. A first column that is not numeric holds the rows' names.
struct Table {
  std::string title = {};
  std::string caption = {};
  std::vector<Column> columns = {};
  std::vector<std::vector<Cell>> rows = {};
  std::string key = {};  ///< what links lead to, unique on the page; none without one
};

// ---- charts ----

enum class Drawn { kLine, kDashed, kPoints };

/// y over x, of equal length, x rising. With `sd` (same length) a band of y ± 1.96 sd is drawn: 95 % if it is normal.
struct Series {
  std::string name = {};
  Meaning meaning = Meaning::kPlain;
  std::vector<double> x = {};
  std::vector<double> y = {};
  std::vector<double> sd = {};
  Drawn drawn = Drawn::kLine;
};

struct LineChart {
  std::string title = {};
  std::string caption = {};
  Axis x = {};
  Axis y = {};
  std::vector<Series> series = {};
  std::vector<StateSpan> states = {};  ///< a strip below the chart
  std::vector<Mark> marks = {};
  std::vector<Region> regions = {};
  std::string group = {};  ///< charts of one group share their x range and their zoom
  int height_px = 260;
};

struct Cloud {
  std::string name = {};
  Meaning meaning = Meaning::kPlain;
  std::vector<double> x = {};
  std::vector<double> y = {};
  std::vector<std::string> labels = {};  ///< one a point, or none
  std::vector<std::string> hrefs = {};   ///< where a click on the point leads, as a Link's; one a point, or none
};

struct Scatter {
  std::string title = {};
  std::string caption = {};
  Axis x = {};
  Axis y = {};
  std::vector<Cloud> clouds = {};
  bool identity = false;  ///< draw y = x
  std::vector<Mark> marks = {};
};

/// values[row][column].
struct Heatmap {
  std::string title = {};
  std::string caption = {};
  std::string x_label = {};
  std::string y_label = {};
  std::vector<std::string> columns = {};
  std::vector<std::string> rows = {};
  std::vector<std::vector<double>> values = {};
  Axis value = {};
  bool diverging = false;  ///< two colours that meet at zero
  int digits = 3;
};

/// One bar a category; low and high are the ends of its interval, or empty.
struct BarSeries {
  std::string name = {};
  Meaning meaning = Meaning::kPlain;
  std::vector<double> values = {};
  std::vector<double> low = {};
  std::vector<double> high = {};
};

struct Bars {
  std::string title = {};
  std::string caption = {};
  std::vector<std::string> categories = {};
  Axis value = {};
  std::vector<BarSeries> series = {};
  std::vector<Mark> marks = {};  ///< of the value, which bars have along x
};

/// counts[i] values lie between edges[i] and edges[i + 1]; `expected`, if any, is drawn over them as points.
struct Histogram {
  std::string title = {};
  std::string caption = {};
  Axis x = {};
  std::string name = {};
  Meaning meaning = Meaning::kPlain;
  std::vector<double> edges = {};
  std::vector<double> counts = {};
  std::string expected_name = {};
  std::vector<double> expected = {};
  std::vector<Mark> marks = {};
};

using Part = std::variant<Headline, Section, Note, Table, LineChart, Scatter, Heatmap, Bars, Histogram>;

}  // namespace steerid::report
