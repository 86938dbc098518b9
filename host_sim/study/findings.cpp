// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "log/output_folder.hpp"
#include "report/page.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<report::Cell>;

std::string words(const report::Cell& cell) {
  const auto* text = std::get_if<std::string>(&cell);
  return text != nullptr ? *text : std::string();
}

/// The leading cells that are words.
std::string row_name(const Row& row) {
  std::string name;
  for (const report::Cell& cell : row) {
    if (std::holds_alternative<double>(cell)) break;
    name += (name.empty() ? "" : ", ") + words(cell);
  }
  return name;
}

const char* word(AskedFigure::Limit limit) { return limit == AskedFigure::Limit::kAtMost ? "at most" : "at least"; }

/// A dash for what was not reached in these drives, or not seen.
std::string with_unit(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string shown(const report::Cell& cell, int digits) {
  const auto* number = std::get_if<double>(&cell);
  if (number == nullptr) return words(cell);
  return std::isfinite(*number) ? fmt::format("{:.{}g}", *number, digits) : "-";
}

std::string heading(const report::Column& column) {
  return column.unit.empty() ? column.label : fmt::format("{} [{}]", column.label, column.unit);
}

std::string table_text(const FoundTable& table) {
  std::vector<std::size_t> width;
  for (const FoundColumn& column : table.columns) width.push_back(heading(column.shown).size());
  for (const Row& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      width[i] = std::max(width[i], shown(row[i], table.columns[i].shown.digits).size());
    }
  }
  std::string text = table.title + "\n";
  const auto add = [&](std::size_t i, const std::string& cell) {
    text += table.columns[i].shown.numeric ? fmt::format("  {:>{}}", cell, width[i])
                                           : fmt::format("  {:<{}}", cell, width[i]);
  };
  for (std::size_t i = 0; i < table.columns.size(); ++i) add(i, heading(table.columns[i].shown));
  text += "\n";
  for (const Row& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) add(i, shown(row[i], table.columns[i].shown.digits));
    text += "\n";
  }
  return text;
}

using Standing = AskedFigure::Standing;

const char* word(Standing standing) {
  return standing == Standing::kMet ? "met" : standing == Standing::kMissed ? "missed" : "open";
}

std::size_t standing_so(const Findings& findings, Standing standing) {
  return static_cast<std::size_t>(std::ranges::count(findings.asked, standing, &AskedFigure::standing));
}

std::string verdict(const Findings& findings) {
  const std::size_t open = standing_so(findings, Standing::kOpen);
  std::string text =
      fmt::format("{} of {} figures that were asked for are met, {} are missed", standing_so(findings, Standing::kMet),
                  findings.asked.size(), standing_so(findings, Standing::kMissed));
  if (open > 0) text += fmt::format("; {} stay open: so few drives decide nothing", open);
  return text + ".";
}

report::Table asked_table(const Findings& findings) {
  report::Table table;
  table.title = "Asked and measured";
  const auto unknown = [](const AskedFigure& one) { return !std::isfinite(one.measured); };
  if (std::ranges::any_of(findings.asked, unknown)) table.caption = "A dash: not reached in these drives, or not seen.";
  table.columns = {{.label = "figure", .numeric = false},
                   {.label = "measured", .numeric = false},
                   {.label = "asked", .numeric = false},
                   {.label = "", .numeric = false}};
  for (const AskedFigure& one : findings.asked) {
    table.rows.push_back({one.what, with_unit(one.measured, one.unit),
                          fmt::format("{} {}", word(one.limit), with_unit(one.asked, one.unit)),
                          report::Badge{word(one.standing())}});
  }
  return table;
}

report::Page page(const Findings& findings) {
  report::Page page;
  page.title = "Study: " + findings.study;
  page.subtitle = findings.title;
  report::Headline head;
  head.verdict = verdict(findings);
  const std::size_t met = standing_so(findings, Standing::kMet);
  head.tone = met == findings.asked.size()                                        ? report::Tone::kGood
              : standing_so(findings, Standing::kMissed) == findings.asked.size() ? report::Tone::kBad
                                                                                  : report::Tone::kCaution;
  page.parts.push_back(head);
  page.parts.push_back(report::Note{.title = "How it is measured", .paragraphs = {findings.how}});
  page.parts.push_back(report::Section{.title = "Asked and measured"});
  page.parts.push_back(asked_table(findings));
  if (findings.charts.size() + findings.lines.size() > 0) page.parts.push_back(report::Section{.title = "In charts"});
  for (const report::Bars& chart : findings.charts) page.parts.push_back(chart);
  for (const report::LineChart& chart : findings.lines) page.parts.push_back(chart);
  page.parts.push_back(report::Section{.title = "In tables"});
  for (const FoundTable& found : findings.tables) {
    report::Table table{found.title, found.caption, {}, found.rows};
    for (const FoundColumn& column : found.columns) table.columns.push_back(column.shown);
    page.parts.push_back(std::move(table));
  }
  page.footer = findings.command;
  return page;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

double Findings::figure(std::string_view table, std::string_view row, std::string_view key) const {
  for (const FoundTable& found : tables) {
    if (found.name != table) continue;
    for (const Row& cells : found.rows) {
      if (row_name(cells) != row) continue;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (found.columns[i].key == key) return std::get<double>(cells[i]);
      }
    }
  }
  throw std::out_of_range(fmt::format("study {} has no {} / {} / {}", study, table, row, key));
}

std::string findings_text(const Findings& findings) {
  std::string text = fmt::format("{}\n{}\n\n{}\n", findings.title, findings.how, verdict(findings));
  for (const AskedFigure& one : findings.asked) {
    const Standing standing = one.standing();
    text += fmt::format("  {:<7} {}: {} ({} {} is asked)\n", standing == Standing::kMissed ? "MISSED" : word(standing),
                        one.what, with_unit(one.measured, one.unit), word(one.limit), with_unit(one.asked, one.unit));
  }
  for (const FoundTable& table : findings.tables) text.append("\n").append(table_text(table));
  return text;
}

std::string findings_csv(const Findings& findings) {
  std::string text = fmt::format("# {}\ntable,case,figure,unit,value\n", findings.command);
  for (const AskedFigure& one : findings.asked) {
    text += fmt::format("asked,\"{}\",measured,{},{}\n", one.what, one.unit, one.measured);
    text += fmt::format("asked,\"{}\",{},{},{}\n", one.what, word(one.limit), one.unit, one.asked);
  }
  for (const FoundTable& table : findings.tables) {
    for (const Row& row : table.rows) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        const auto* value = std::get_if<double>(&row[i]);
        if (value == nullptr) continue;
        text += fmt::format("{},\"{}\",{},{},{}\n", table.name, row_name(row), table.columns[i].key,
                            table.columns[i].shown.unit, std::isfinite(*value) ? fmt::format("{}", *value) : "");
      }
    }
  }
  return text;
}

std::string findings_json(const Findings& findings, const nlohmann::ordered_json& made_by) {
  Json json = {{"schema", "steerid.study/1"}, {"study", findings.study}, {"command", findings.command},
               {"how", findings.how},         {"asked", Json::array()},  {"tables", Json::object()}};
  for (const AskedFigure& one : findings.asked) {
    const bool at_most = one.limit == AskedFigure::Limit::kAtMost;
    json["asked"].push_back({{"figure", one.what},
                             {"unit", one.unit},
                             {"measured", number(one.measured)},
                             {at_most ? "at_most" : "at_least", one.asked},
                             {"met", one.met()},
                             {"standing", word(one.standing())}});
  }
  for (const FoundTable& table : findings.tables) {
    Json rows = Json::array();
    for (const Row& row : table.rows) {
      Json entry = Json::object();
      for (std::size_t i = 0; i < row.size(); ++i) {
        const auto* value = std::get_if<double>(&row[i]);
        entry[table.columns[i].key] = value != nullptr ? number(*value) : Json(words(row[i]));
      }
      rows.push_back(std::move(entry));
    }
    json["tables"][table.name] = std::move(rows);
  }
  json.update(made_by);
  return json.dump(2) + "\n";
}

void write_findings(const std::filesystem::path& folder, const Findings& findings,
                    const nlohmann::ordered_json& made_by) {
  const std::string csv = findings_csv(findings);
  const std::string json = findings_json(findings, made_by);
  const std::string html = report::html(page(findings));
  const std::string& name = findings.study;
  write_together(folder, {{name + ".csv", csv}, {name + ".json", json}, {name + ".html", html}});
}

}  // namespace steerid
