// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "report/document.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "report/page.hpp"
#include "report/thin.hpp"

namespace steerid::report {
namespace {

using nlohmann::json;

// Digits that a chart can show; more would only make the page longer. An x axis gets more, because a time stamp may
// be large (seconds since 1970) and its steps small.
constexpr int kDigitsX = 12;
constexpr int kDigitsY = 7;

/// The double nearest to `value` written with so many significant digits: its shortest text is no longer than that.
double rounded(double value, int digits) {
  if (!std::isfinite(value)) return value;
  std::array<char, 40> text{};
  const auto written =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, digits - 1);
  double result = value;
  std::from_chars(text.data(), written.ptr, result);
  return result;
}

json numbers(const std::vector<double>& values, int digits = kDigitsY) {
  json out = json::array();
  for (const double value : values) out.push_back(rounded(value, digits));
  return out;
}

void require(bool holds, const std::string& title, const char* what) {
  if (!holds) throw std::invalid_argument("report part '" + title + "': " + what);
}

const char* name(Meaning meaning) {
  switch (meaning) {
    case Meaning::kMeasured:
      return "measured";
    case Meaning::kModel:
      return "model";
    case Meaning::kResidual:
      return "residual";
    case Meaning::kInertia:
      return "inertia";
    case Meaning::kDamping:
      return "damping";
    case Meaning::kStiffness:
      return "stiffness";
    case Meaning::kTorqueDriver:
      return "torque_driver";
    case Meaning::kTorqueMotor:
      return "torque_motor";
    case Meaning::kTorqueRim:
      return "torque_rim";
    case Meaning::kReference:
      return "reference";
    case Meaning::kPlain:
      return "plain";
  }
  return "plain";
}

const char* name(Tone tone) {
  switch (tone) {
    case Tone::kNeutral:
      return "neutral";
    case Tone::kGood:
      return "good";
    case Tone::kCaution:
      return "caution";
    case Tone::kBad:
      return "bad";
  }
  return "neutral";
}

const char* name(Drawn drawn) {
  switch (drawn) {
    case Drawn::kLine:
      return "line";
    case Drawn::kDashed:
      return "dashed";
    case Drawn::kPoints:
      return "points";
  }
  return "line";
}

void add(json& to, const char* key, const std::string& text) {
  if (!text.empty()) to[key] = text;
}

json to_json(const Axis& axis) {
  json out = {{"label", axis.label}};
  add(out, "unit", axis.unit);
  if (axis.log) out["log"] = true;
  if (axis.range) out["range"] = *axis.range;
  return out;
}

json to_json(const Mark& mark) {
  return {{"axis", mark.axis == Mark::Along::kX ? "x" : "y"},
          {"at", mark.at},
          {"label", mark.label},
          {"meaning", name(mark.meaning)}};
}

json to_json(const Region& region) { return {{"from", region.from}, {"to", region.to}, {"label", region.label}}; }

json to_json(const StateSpan& span) { return {{"from", span.from}, {"to", span.to}, {"state", span.state}}; }

json to_json(const KeyNumber& number) {
  json out = {{"label", number.label}, {"value", number.value}};
  add(out, "unit", number.unit);
  add(out, "note", number.note);
  add(out, "state", number.state);
  if (number.meaning) out["meaning"] = name(*number.meaning);
  return out;
}

json to_json(const Column& column) {
  json out = {{"label", column.label}, {"numeric", column.numeric}, {"digits", column.digits}};
  add(out, "unit", column.unit);
  return out;
}

json to_json(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* badge = std::get_if<Badge>(&cell)) return {{"state", badge->state}};
  if (const auto* link = std::get_if<Link>(&cell)) return {{"text", link->text}, {"href", link->href}};
  return std::get<double>(cell);
}

std::vector<double> picked(const std::vector<double>& values, const std::vector<std::size_t>& indices) {
  std::vector<double> out;
  out.reserve(indices.size());
  for (const std::size_t i : indices) out.push_back(values[i]);
  return out;
}

json to_json(const Series& series) {
  require(series.x.size() == series.y.size(), series.name, "x and y differ in length");
  require(series.sd.empty() || series.sd.size() == series.y.size(), series.name, "sd and y differ in length");
  const auto kept = thinned(series.x, series.y, kSamplesKept);
  json out = {{"name", series.name},
              {"meaning", name(series.meaning)},
              {"drawn", name(series.drawn)},
              {"samples", series.x.size()},
              {"x", numbers(picked(series.x, kept), kDigitsX)},
              {"y", numbers(picked(series.y, kept))}};
  if (!series.sd.empty()) out["sd"] = numbers(picked(series.sd, kept));
  return out;
}

json to_json(const Cloud& cloud) {
  require(cloud.x.size() == cloud.y.size(), cloud.name, "x and y differ in length");
  require(cloud.labels.empty() || cloud.labels.size() == cloud.x.size(), cloud.name, "a label for each point, or none");
  require(cloud.hrefs.empty() || cloud.hrefs.size() == cloud.x.size(), cloud.name, "a link for each point, or none");
  json out = {{"name", cloud.name},
              {"meaning", name(cloud.meaning)},
              {"x", numbers(cloud.x)},
              {"y", numbers(cloud.y)},
              {"labels", cloud.labels}};
  if (!cloud.hrefs.empty()) out["hrefs"] = cloud.hrefs;
  return out;
}

json to_json(const BarSeries& series) {
  require(series.low.size() == series.high.size(), series.name, "low and high differ in length");
  require(series.low.empty() || series.low.size() == series.values.size(), series.name, "an interval a bar, or none");
  return {{"name", series.name},
          {"meaning", name(series.meaning)},
          {"values", numbers(series.values)},
          {"low", numbers(series.low)},
          {"high", numbers(series.high)}};
}

template <class T>
json each(const std::vector<T>& items) {
  json out = json::array();
  for (const T& item : items) out.push_back(to_json(item));
  return out;
}

/// One overload a part; `kind` tells the page which it is.
struct ToDocument {
  json operator()(const Headline& part) const {
    return {
        {"kind", "headline"}, {"verdict", part.verdict}, {"tone", name(part.tone)}, {"numbers", each(part.numbers)}};
  }

  json operator()(const Section& part) const {
    json out = {{"kind", "section"}, {"title", part.title}};
    add(out, "lead", part.lead);
    return out;
  }

  json operator()(const Note& part) const {
    json out = {{"kind", "note"}, {"paragraphs", part.paragraphs}, {"tone", name(part.tone)}};
    add(out, "title", part.title);
    return out;
  }

  json operator()(const Table& part) const {
    json rows = json::array();
    for (const auto& row : part.rows) {
      require(row.size() == part.columns.size(), part.title, "a row needs one cell a column");
      rows.push_back(each(row));
    }
    json out = titled("table", part);
    out["columns"] = each(part.columns);
    out["rows"] = std::move(rows);
    add(out, "key", part.key);
    return out;
  }

  json operator()(const LineChart& part) const {
    json out = titled("line_chart", part);
    out["x"] = to_json(part.x);
    out["y"] = to_json(part.y);
    out["series"] = each(part.series);
    out["states"] = each(part.states);
    out["marks"] = each(part.marks);
    out["regions"] = each(part.regions);
    out["height"] = part.height_px;
    add(out, "group", part.group);
    return out;
  }

  json operator()(const Scatter& part) const {
    json out = titled("scatter", part);
    out["x"] = to_json(part.x);
    out["y"] = to_json(part.y);
    out["clouds"] = each(part.clouds);
    out["identity"] = part.identity;
    out["marks"] = each(part.marks);
    return out;
  }

  json operator()(const Heatmap& part) const {
    require(part.values.size() == part.rows.size(), part.title, "one line of values a row");
    json values = json::array();
    for (const auto& row : part.values) {
      require(row.size() == part.columns.size(), part.title, "one value a column");
      values.push_back(numbers(row));
    }
    json out = titled("heatmap", part);
    out["x_label"] = part.x_label;
    out["y_label"] = part.y_label;
    out["columns"] = part.columns;
    out["rows"] = part.rows;
    out["values"] = std::move(values);
    out["value"] = to_json(part.value);
    out["diverging"] = part.diverging;
    out["digits"] = part.digits;
    return out;
  }

  json operator()(const Bars& part) const {
    for (const BarSeries& series : part.series) {
      require(series.values.size() == part.categories.size(), part.title, "one bar a category");
    }
    for (const Mark& mark : part.marks)
      require(mark.axis == Mark::Along::kX, part.title, "marks of the value, along x");
    json out = titled("bars", part);
    out["categories"] = part.categories;
    out["value"] = to_json(part.value);
    out["series"] = each(part.series);
    out["marks"] = each(part.marks);
    return out;
  }

  json operator()(const Histogram& part) const {
    require(part.edges.size() == part.counts.size() + 1, part.title, "one edge more than counts");
    require(part.expected.empty() || part.expected.size() == part.counts.size(), part.title, "an expectation a bin");
    json out = titled("histogram", part);
    out["x"] = to_json(part.x);
    out["name"] = part.name;
    out["meaning"] = name(part.meaning);
    out["edges"] = numbers(part.edges, kDigitsX);
    out["counts"] = numbers(part.counts);
    out["marks"] = each(part.marks);
    add(out, "expected_name", part.expected_name);
    if (!part.expected.empty()) out["expected"] = numbers(part.expected);
    return out;
  }

 private:
  template <class T>
  static json titled(const char* kind, const T& part) {
    json out = {{"kind", kind}, {"title", part.title}};
    add(out, "caption", part.caption);
    return out;
  }
};

}  // namespace

json to_document(const Part& part) { return std::visit(ToDocument{}, part); }

}  // namespace steerid::report
