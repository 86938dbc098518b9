// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid inspect LOG...`: what is in a log, and the --columns line that it is read with.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/channel_words.hpp"
#include "apps/commands.hpp"
#include "apps/first_look.hpp"
#include "apps/log_options.hpp"
#include "apps/made_from.hpp"
#include "apps/option_kinds.hpp"
#include "apps/unit_words.hpp"
#include "fit/unit_check.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/log_survey.hpp"
#include "log/proposed_columns.hpp"
#include "log/resample.hpp"
#include "log/whole_file.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

struct InspectCommand {
  std::vector<std::filesystem::path> logs;
  LogOptions log;
  std::optional<std::filesystem::path> json;
};

constexpr std::size_t index_of(Channel channel) { return static_cast<std::size_t>(channel); }

/// The column of a file's own time among the choices.
std::optional<WantedColumn> time_of(const NamedLog& log, const ColumnChoices& choices) {
  std::vector<ColumnChoice> times = choices.more_times;
  times.push_back(choices[index_of(Channel::kTime)]);
  const auto& columns = log.source->columns();
  for (const ColumnChoice& time : times) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].name != time.name && log.stem + "/" + columns[i].name != time.name) continue;
      const double per_si = units_per_si(Quantity::kTime, time.unit).value_or(1.0);
      return WantedColumn{.column = i, .to_si = {.scale = time.scale, .offset = time.offset, .per_si = per_si}};
    }
  }
  return std::nullopt;
}

/// The channel that a file's column is taken for; empty for none.
std::string channel_of(const NamedLog& log, const LogColumn& column, const ColumnChoices& choices) {
  for (const Channel channel : kAllChannels) {
    const std::string& name = choices[index_of(channel)].name;
    if (name == column.name || name == log.stem + "/" + column.name) return std::string(channel_name(channel));
  }
  return "";
}

Json survey_json(NamedLog& log, const ColumnChoices& choices) {
  const auto time = time_of(log, choices);
  Json columns = Json::array();
  if (log.source->time_is_a_column() && !time) {
    for (const LogColumn& column : log.source->columns())
      columns.push_back({{"name", column.name}, {"unit", column.unit}});
    return columns;
  }
  for (const ColumnSurvey& one : survey_columns(*log.source, time)) {
    const LogColumn& column = log.source->columns()[one.column];
    columns.push_back({{"name", column.name},
                       {"unit", column.unit},
                       {"channel", channel_of(log, column, choices)},
                       {"values", one.values},
                       {"rate_hz", one.rate_hz},
                       {"gaps", one.gaps},
                       {"low", one.low},
                       {"high", one.high},
                       {"whole_numbers", one.whole_numbers}});
  }
  return columns;
}

void print_columns(const Json& columns) {
  fmt::print("  {:<32} {:<6} {:>8} {:>9} {:>5} {:>12} {:>12}  {}\n", "column", "unit", "values", "Hz", "gaps", "from",
             "to", "channel");
  for (const Json& column : columns) {
    const std::string name = printable(column["name"].get<std::string>());
    const std::string unit = printable(column["unit"].get<std::string>());
    if (!column.contains("values")) {
      fmt::print("  {:<32} {:<6}\n", name, unit);
      continue;
    }
    if (column["values"] == 0) {
      fmt::print("  {:<32} {:<6} {:>8}\n", name, unit, 0);
      continue;
    }
    fmt::print("  {:<32} {:<6} {:>8} {:>9.4g} {:>5} {:>12.5g} {:>12.5g}  {}\n", name, unit,
               column["values"].get<std::size_t>(), column["rate_hz"].get<double>(), column["gaps"].get<std::size_t>(),
               column["low"].get<double>(), column["high"].get<double>(), column["channel"].get<std::string>());
  }
}

/// The files for a sentence, the first one's name first.
std::string named(const std::vector<std::filesystem::path>& paths) {
  return paths.front().string() + (paths.size() > 1 ? " and the files with it" : "");
}

/// In single quotes for a shell.
std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// The choices without the units that the user has not stated: the reader finds them, and what can only be degrees is
/// told from what is called radians.
ColumnChoices without_found_units(ColumnChoices choices, const ColumnChoices& said) {
  for (const Channel channel : kAllChannels) {
    if (said[index_of(channel)].name.empty()) choices[index_of(channel)].unit.clear();
  }
  return choices;
}

/// What is named for each other by the columns' names is exchanged, unless the user has said it.
void exchange(ColumnChoices& choices, const ColumnChoices& said, const UnitCheck& check, bool slide) {
  if (check.verdict != UnitCheck::Verdict::kExchanged || slide) return;
  for (const Channel channel : {Channel::kAngle, check.exchanged}) {
    if (!said[index_of(channel)].name.empty()) return;
  }
  ColumnChoice& angle = choices[index_of(Channel::kAngle)];
  ColumnChoice& torque = choices[index_of(check.exchanged)];
  std::swap(angle, torque);
  angle.unit.clear();
  torque.unit.clear();
}

/// Units that nobody stated are stated, so that the line means the same everywhere; degrees where only they can be.
void state_units(ColumnChoices& choices, const ColumnChoices& said, const UnitCheck& check, bool slide) {
  for (const Channel channel : kAllChannels) {
    ColumnChoice& choice = choices[index_of(channel)];
    if (choice.name.empty() || !said[index_of(channel)].unit.empty()) continue;
    const bool degrees =
        channel == Channel::kAngle && !slide &&
        (check.verdict == UnitCheck::Verdict::kTooLight || check.verdict == UnitCheck::Verdict::kTurnsTooFar);
    if (degrees) choice.unit = "deg";
    if (choice.unit.empty()) choice.unit = si_unit(channel);
  }
  for (ColumnChoice& time : choices.more_times) {
    if (time.unit.empty()) time.unit = si_unit(Channel::kTime);
  }
}

/// What the record says of itself once it is read.
std::vector<std::string> notes_on(const Resampled& resampled, const RecordQuality& seen) {
  const Record& record = resampled.record;
  std::vector<std::string> notes = seen.notes;
  for (std::string& note : resampled.notes()) notes.push_back(std::move(note));
  if (const std::string units = unit_words(check_units(record), seen); !units.empty()) notes.push_back(units);
  const FirstLook look = first_look(record, std::nullopt);
  if (!look.doubt.empty()) notes.push_back(look.doubt);
  notes.insert(notes.end(), look.notes.begin(), look.notes.end());
  if (!tells_delays(record)) return notes;
  if (const std::string delay = delay_words(torque_delay(record)); !delay.empty()) notes.push_back(delay);
  return notes;
}

void inspect(const InspectCommand& command) {
  for (const auto& path : command.logs) {
    if (path == "-") throw BadOption("inspect reads a log twice: give a file in place of standard input");
  }
  std::vector<std::filesystem::path> paths = command.logs;
  paths.insert(paths.end(), command.log.with.begin(), command.log.with.end());
  LogFormat format = command.log.format();
  std::vector<NamedLog> logs = open_logs(paths, format);
  const ColumnChoices said = format.columns;
  ColumnChoices proposed = proposed_columns(logs, said);
  format.columns = without_found_units(proposed, said);
  Json json = {{"schema", "steerid.inspection/1"}, {"files", Json::array()}};
  for (NamedLog& log : logs) {
    Json columns = survey_json(log, proposed);
    fmt::print("{}\n", printable(log.name));
    print_columns(columns);
    Json file = {{"file", log.name}};
    file.update(fingerprint(paths[json["files"].size()]));
    file["columns"] = std::move(columns);
    json["files"].push_back(std::move(file));
  }
  RecordQuality seen;
  const Record record = command.log.read(paths, format, &seen);
  const Resampled even = resample_100hz(record, named(paths));
  const std::vector<std::string> notes = notes_on(even, seen);
  const UnitCheck check = check_units(even.record);
  exchange(proposed, said, check, seen.slide);
  state_units(proposed, said, check, seen.slide);
  const std::string line = columns_text(proposed);
  const double length_s = record.time_s.back() - record.time_s.front();
  fmt::print("\nrecord      {:.1f} s, {} rows at {:.4g} Hz, jitter {:.2g} ms, gaps {}\n", length_s, seen.rows,
             1.0 / seen.median_period_s, 1000 * seen.jitter_s, seen.gaps.size());
  fmt::print("equation    {}\n", equation_words(record.equation()));
  for (const std::string& note : notes) fmt::print("note        {}\n", note);
  fmt::print("\n--columns {}\n", printable(shell_quoted(line)));
  if (!command.json) return;
  json["record"] = {
      {"length_s", length_s},      {"rows", seen.rows},        {"rate_hz", 1.0 / seen.median_period_s},
      {"jitter_s", seen.jitter_s}, {"gaps", seen.gaps.size()}, {"equation", equation_words(record.equation())}};
  json["notes"] = notes;
  json["columns"] = line;
  json["options"] = {{"columns", command.log.columns}, {"sign", command.log.sign}};
  json["program"] = program_json();
  write_whole_file(*command.json, json.dump(2) + "\n");
}

constexpr const char* kFooter =
    "Lists every column with its unit, rate, gaps and range, the channel that it is taken for by its name and unit, "
    "and\n"
    "the --columns line that identify, diagnose, hil and simulate --replay take. What the line lacks is named. Of the\n"
    "record that it gives: the equation, whether units, signs and channels can be right, and how late its torques "
    "are.\n"
    "\n"
    "Examples:\n"
    "  steerid inspect drive.csv\n"
    "  steerid inspect eps.csv wheel.csv --columns angle=wheel/theta:deg";

}  // namespace

void add_inspect(CLI::App& app) {
  CLI::App* command = app.add_subcommand("inspect", "What is in a log, and the --columns line to read it with");
  auto options = std::make_shared<InspectCommand>();
  reads_file(command->add_option("LOG", options->logs, "The log, or several of one drive"))
      ->required()
      ->type_name("LOG");
  add_log_options(*command, options->log);
  writes_file(command->add_option("--json", options->json, "Write it, machine-readable"))->type_name("OUT.json");
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun&) { inspect(*options); });
}

}  // namespace steerid
