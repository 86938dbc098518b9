// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/fleet_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "apps/fleet_charts.hpp"
#include "apps/record_links.hpp"
#include "fleet/summary_tables.hpp"
#include "report/uncertainty.hpp"

namespace steerid {
namespace {

std::string percent(double share) { return report::in_digits(100 * share, 3) + " %"; }

struct OnPage {
  const RecordLinks& links;
  report::Cell operator()(std::monostate) const { return std::string(); }
  report::Cell operator()(const std::string& text) const { return text; }
  report::Cell operator()(double number) const { return number; }
  report::Cell operator()(const fleet::RecordName& record) const {
    return report::Link{record.name, links.to(record.name)};
  }
  report::Cell operator()(const fleet::CountOf& count) const {
    const std::string text = fmt::format("{:.0f}", count.number);
    if (count.number == 0) return text;
    return report::Link{text, "#" + count.list};
  }
};

/// Whether the two columns after this one are the ends of its interval.
bool has_ends(const fleet::FleetTable& table, std::size_t column) {
  return column + 2 < table.columns.size() && table.columns[column + 1].label == fleet::kLow &&
         table.columns[column + 2].label == fleet::kHigh;
}

/// "0.300 (0.243 to 0.360)"
report::Cell with_ends(const fleet::FleetCell& value, const fleet::FleetCell& low, const fleet::FleetCell& high) {
  const auto number = [](const fleet::FleetCell& cell) {
    const auto* found = std::get_if<double>(&cell);
    return found != nullptr ? *found : std::nan("");
  };
  return report::with_interval(number(value), {number(low), number(high)});
}

/// A value and its interval share a cell.
report::Table on_page(const fleet::FleetTable& table, const RecordLinks& links) {
  report::Table out{.title = table.title, .caption = table.caption};
  for (std::size_t i = 0; i < table.columns.size(); i += has_ends(table, i) ? 3 : 1) {
    const fleet::FleetColumn& column = table.columns[i];
    out.columns.push_back({column.label, column.unit, column.numeric, 4});
  }
  for (const auto& row : table.rows) {
    std::vector<report::Cell> cells;
    cells.reserve(row.size());
    for (std::size_t i = 0; i < row.size(); i += has_ends(table, i) ? 3 : 1) {
      cells.push_back(has_ends(table, i) ? with_ends(row[i], row[i + 1], row[i + 2])
                                         : std::visit(OnPage{links}, row[i]));
    }
    out.rows.push_back(std::move(cells));
  }
  out.key = table.key;
  return out;
}

/// The records in one sentence, and the change that most of them name. A share is of the records that the change can be
/// asked of, which for an effect to resize or remove are those whose simulation has it, so it is not said of all here.
std::string verdict(const fleet::Summary& summary) {
  std::string text = fmt::format("{} of {} records have an answer", summary.answered(), summary.records());
  if (summary.named_vehicles()) text += fmt::format(", of {} vehicles", summary.vehicles());
  text += ".";
  std::size_t most = 0;
  std::string change;
  for (const auto& name : fleet::by_share(summary)) {
    const std::size_t named = summary.changes().at(name).named();
    if (name.second.empty() || named <= most) continue;
    most = named;
    change = fleet::words(name);
  }
  if (most > 0) text += fmt::format(" The change named most often is to {}, in {} of them.", change, most);
  return text;
}

report::Headline headline(const fleet::Summary& summary) {
  report::Headline out{.verdict = verdict(summary)};
  const std::size_t refused = summary.records() - summary.answered();
  out.tone = summary.faults() > 0 ? report::Tone::kBad : refused > 0 ? report::Tone::kCaution : report::Tone::kNeutral;
  out.numbers.push_back({.label = "Records", .value = std::to_string(summary.records())});
  out.numbers.push_back(
      {.label = "Without an answer",
       .value = std::to_string(refused),
       .note = summary.faults() > 0 ? fmt::format("{} by a fault of this program", summary.faults()) : std::string()});
  for (const char* verdict : {"none", "parameters", "unknown"}) {
    const auto found = summary.changes().find({verdict, ""});
    if (found == summary.changes().end()) continue;
    const fleet::Interval share = found->second.share().interval();
    out.numbers.push_back({.label = fmt::format("Share {}", verdict),
                           .value = percent(share.value),
                           .note = fmt::format("{} to {}", percent(share.low), percent(share.high))});
  }
  if (const fleet::Interval closed = summary.closed().spread().mean(); summary.closed().spread().records() > 0) {
    out.numbers.push_back({.label = "Gap closed, mean", .value = percent(closed.value)});
  }
  return out;
}

report::Note model() {
  return {
      .title = "How shares and intervals come about",
      .paragraphs = {
          "A record knows a change only with a probability. In a vehicle a record has the change with a probability "
          "of the vehicle's own, whose logit is normal over the fleet with unknown mean and spread. The share is "
          "that probability's mean over the fleet. Each record's probability is divided by the odds it had before "
          "the record was seen, so that only what the record says counts; the share has Jeffreys' prior.",
          "Intervals of means, spreads and slopes are from a jackknife that leaves out groups of whole vehicles, so "
          "that records of one vehicle need not be independent.",
          "Medians, percentiles and charts show at most 2,000 values, drawn with equal probability. Lists of records "
          "name at most 25: records.jsonl beside this page has all."}};
}

}  // namespace

report::Page fleet_page(const fleet::Summary& summary, const std::filesystem::path& out) {
  const RecordLinks links(out);
  report::Page page{.title = fmt::format("{} of a fleet", summary.kind().command == "diagnose" ? "Gaps" : "Arms"),
                    .subtitle = fmt::format("`steerid {}` on {} records", summary.kind().command, summary.records())};
  page.parts.emplace_back(headline(summary));
  for (const fleet::FleetTable& table : fleet::summary_tables(summary)) {
    std::vector<report::Part> charts = fleet_charts(table.key, summary, links);
    if (table.rows.empty() && charts.empty()) continue;
    page.parts.emplace_back(report::Section{.title = table.title, .lead = ""});
    for (report::Part& chart : charts) page.parts.push_back(std::move(chart));
    if (!table.rows.empty()) page.parts.emplace_back(on_page(table, links));
  }
  page.parts.emplace_back(model());
  page.parts.emplace_back(report::Section{.title = "The records behind the counts", .lead = ""});
  for (const fleet::FleetTable& table : fleet::record_tables(summary)) page.parts.emplace_back(on_page(table, links));
  return page;
}

namespace {

void write_fleet_report(const fleet::Summary& summary, const std::filesystem::path& out, bool page) {
  const std::filesystem::path folder = out / fleet::kFleetFolder;
  for (const fleet::FleetTable& table : fleet::summary_tables(summary)) fleet::write_table(folder, table);
  if (page) {
    report::write_page(folder / "report.html", fleet_page(summary, out));
  } else {
    std::error_code none;
    std::filesystem::remove(folder / "report.html", none);  // of an earlier run
  }
}

}  // namespace

fleet::Merged merge_with_report(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& out,
                                bool allow_missing,
                                const std::function<void(std::size_t done, std::size_t of)>& at_record) {
  std::optional<fleet::Summary> summary;
  bool page = true;
  fleet::Merged merged = fleet::merge(shards, out,
                                      {.allow_missing = allow_missing,
                                       .at_record =
                                           [&](const fleet::RecordLine& line, std::size_t done, std::size_t of) {
                                             summary->add(line);
                                             at_record(done, of);
                                           },
                                       .at_question =
                                           [&](const fleet::ShardHeader& question) {
                                             summary.emplace(fleet::kind_of(question.command));
                                             page = question.options.value("report", true);
                                           }});
  summary->finish();
  write_fleet_report(*summary, out, page);
  return merged;
}

}  // namespace steerid
