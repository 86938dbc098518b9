// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "log/bad_input.hpp"
#include "log/chosen_columns.hpp"
#include "log/log_source.hpp"
#include "log/one_record.hpp"
#include "log/unavailable_values.hpp"
#include "log/wrapped_angle.hpp"

namespace steerid {
namespace {

constexpr std::size_t index_of(Channel channel) { return static_cast<std::size_t>(channel); }

/// The columns of all files, numbered through.
struct AllColumns {
  std::vector<StampedColumns> groups{};
  std::vector<double> moved_s{};
};

struct Span {
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = -std::numeric_limits<double>::infinity();
};

Span span_of(const std::vector<StampedColumns>& groups) {
  Span span;
  for (const StampedColumns& group : groups) {
    if (group.time_s.empty()) continue;
    span.first_s = std::min(span.first_s, group.time_s.front());
    span.last_s = std::max(span.last_s, group.time_s.back());
  }
  return span;
}

AllColumns read_all(const std::vector<NamedLog>& logs, const Choice& choice, const LogFormat& format) {
  AllColumns all;
  all.moved_s.assign(logs.size(), 0);
  std::copy_n(format.moved_s.begin(), std::min(logs.size(), format.moved_s.size()), all.moved_s.begin());
  std::size_t before = 0;
  Span first;
  for (std::size_t file = 0; file < logs.size(); ++file) {
    const Wanted& wanted = choice.files[file].wanted;
    if (wanted.columns.empty()) continue;
    std::vector<StampedColumns> groups = logs[file].source->read(wanted);
    const Span span = span_of(groups);
    if (before == 0) first = span;
    const bool apart = span.first_s > first.last_s || span.last_s < first.first_s;
    if (format.start_together && apart) all.moved_s[file] += first.first_s - span.first_s;
    for (StampedColumns& group : groups) {
      for (std::size_t& column : group.wanted) column += before;
      for (double& time_s : group.time_s) time_s += all.moved_s[file];
      all.groups.push_back(std::move(group));
    }
    before += wanted.columns.size();
  }
  return all;
}

std::vector<Channel> channels_in_order(const Choice& choice) {
  std::vector<Channel> channels;
  for (const ChosenColumns& file : choice.files) {
    channels.insert(channels.end(), file.channels.begin(), file.channels.end());
  }
  return channels;
}

/// What a column's numbers stand for that are no measurement: in words, what was done about it.
std::vector<std::string> read_as_measured(std::vector<StampedColumns>& groups, const std::vector<Channel>& channels) {
  std::vector<std::string> notes;
  for (StampedColumns& group : groups) {
    for (std::size_t i = 0; i < group.values.size(); ++i) {
      const Channel channel = channels[group.wanted[i]];
      const UnavailableValues missing = leave_out_unavailable(group.values[i], channel);
      if (missing.rows > 0) {
        notes.push_back(
            fmt::format("{} reads {:.6g} in {} rows, far from all that it reads else: taken as no measurement",
                        channel_name(channel), fmt::join(missing.value, " or "), missing.rows));
      }
      if (channel != Channel::kAngle) continue;
      if (const std::size_t anew = count_turns(group.values[i]); anew > 0) {
        notes.push_back(
            fmt::format("the angle begins anew after every turn, {} times: its turns are counted through", anew));
      }
    }
  }
  return notes;
}

Record record_of(OneClock rows, const Choice& choice) {
  Record record;
  record.channels = choice.channels();
  record.time_s = std::move(rows.time_s);
  const std::vector<Channel> channels = channels_in_order(choice);
  for (std::size_t i = 0; i < channels.size(); ++i) values_of(record, channels[i]) = std::move(rows.values[i]);
  for (const Channel channel : {Channel::kTorqueDriver, Channel::kTorqueMotor}) {
    if (!choice.present[index_of(channel)]) values_of(record, channel).assign(record.size(), 0.0);
  }
  return record;
}

/// The name of the first file's column of time, for a sentence.
std::string time_column(const std::vector<NamedLog>& logs, const Choice& choice) {
  for (std::size_t file = 0; file < logs.size(); ++file) {
    const auto& time = choice.files[file].wanted.time;
    if (time) return logs[file].source->columns()[time->column].name;
  }
  return "";
}

/// Refuses what is too short or too slow.
RecordQuality checked_quality(const Record& record, const std::string& name, const std::string& time_column) {
  if (record.size() < kFewestRows) {
    throw bad_input({.file = name,
                     .expected = fmt::format("at least {} rows with values", kFewestRows),
                     .found = fmt::format("{}", record.size()),
                     .advice = "record a longer drive"});
  }
  RecordQuality quality = quality_of(record);
  // Stamps are rounded by whoever wrote them: 1 % keeps a true 50 Hz in.
  if (quality.median_period_s > 1.01 / kLowestRateHz) {
    std::string advice = "record faster";
    if (!time_column.empty()) {  // messages and frames have stamps of their own, in known units
      const std::string unit = likely_time_unit(record.time_s.back(), quality.median_period_s);
      advice += fmt::format(", or state the unit of time with --columns {}",
                            choice_text(Channel::kTime, {.name = time_column, .unit = unit}));
    }
    throw bad_input({.file = name,
                     .column = time_column,
                     .expected = fmt::format("{} rows a second or more", kLowestRateHz),
                     .found = fmt::format("{:.4g} (median)", 1.0 / quality.median_period_s),
                     .advice = advice});
  }
  return quality;
}

Record read(const std::vector<NamedLog>& logs, const LogFormat& format, RecordQuality* noticed) {
  const std::string& name = logs.front().name;
  Choice choice = choose_columns(logs, format);
  AllColumns all = read_all(logs, choice, format);
  const std::vector<Channel> channels = channels_in_order(choice);
  std::vector<std::string> notes = std::move(choice.notes);
  for (std::string& note : read_as_measured(all.groups, channels)) notes.push_back(std::move(note));
  OneClock rows = one_clock(std::move(all.groups), channels.size(), name);
  const std::size_t left_out = rows.left_out;
  const std::size_t first_line = rows.first_incomplete_line;
  notes.insert(notes.end(), rows.notes.begin(), rows.notes.end());
  for (const NamedLog& log : logs) {
    const std::vector<std::string> seen = log.source->notes();
    notes.insert(notes.end(), seen.begin(), seen.end());
  }
  Record record = record_of(std::move(rows), choice);
  RecordQuality quality = checked_quality(record, name, time_column(logs, choice));
  quality.dropped_rows = left_out;
  quality.slide = choice.slide;
  for (const Channel channel : kAllChannels) {
    const std::size_t i = index_of(channel);
    quality.channels[i] = {.column = choice.columns[i], .unit_by_option = !format.columns[i].unit.empty()};
    quality.channels[i].whole_numbers =
        std::ranges::all_of(values_of(record, channel), [](double value) { return value == std::round(value); });
  }
  for (std::size_t file = 0; file < logs.size(); ++file) {
    for (const Channel channel : choice.files[file].channels) quality.channels[index_of(channel)].file = file;
  }
  quality.moved_s = std::move(all.moved_s);
  quality.notes = std::move(notes);
  if (left_out > 0) {
    quality.notes.push_back(
        fmt::format("{} rows with an empty or NaN cell left out{}", left_out,
                    first_line > 0 ? fmt::format(", the first in line {}", first_line) : std::string()));
  }
  if (noticed != nullptr) *noticed = std::move(quality);
  return record;
}

}  // namespace

Record read_log(const std::filesystem::path& path, const LogFormat& format, RecordQuality* noticed) {
  return read_log(std::vector{path}, format, noticed);
}

std::vector<NamedLog> open_logs(const std::vector<std::filesystem::path>& paths, const LogFormat& format) {
  std::vector<NamedLog> logs;
  logs.reserve(paths.size());
  for (const std::filesystem::path& path : paths) {
    logs.push_back({path == "-" ? "standard input" : path.string(), path.stem().string(), open_log(path, format.dbc)});
  }
  return logs;
}

Record read_log(const std::vector<std::filesystem::path>& paths, const LogFormat& format, RecordQuality* noticed) {
  return read(open_logs(paths, format), format, noticed);
}

Record read_log(std::istream& in, const std::string& name, const LogFormat& format, RecordQuality* noticed) {
  std::vector<NamedLog> logs;
  logs.push_back({name, std::filesystem::path(name).stem().string(),
                  open_log({.in = std::make_unique<std::istream>(in.rdbuf()), .name = name, .dbc = format.dbc})});
  return read(logs, format, noticed);
}

}  // namespace steerid
