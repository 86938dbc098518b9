// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/log_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "log/bad_input.hpp"
#include "log/csv_lines.hpp"

namespace steerid {
namespace {

constexpr std::size_t index_of(Channel channel) { return static_cast<std::size_t>(channel); }

std::vector<std::string> split_names(std::string_view text, char separator, bool& broken) {
  std::vector<std::string> names;
  CsvCells cells(text, separator);
  for (std::string_view cell; cells.next(cell);) names.emplace_back(cell);
  broken = cells.broken();
  return names;
}

/// The names in the header for a sentence: all of them up to eight.
std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNames = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
    list += (i == 0 ? "" : ", ") + in_quotes(names[i]);
  if (names.size() > kMostNames) list += fmt::format(" and {} more", names.size() - kMostNames);
  return list;
}

bool all_numbers(const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [](const std::string& name) {
    double value = 0.0;
    return CsvCells(name, ',').next_number(value);
  });
}

/// Units of the column in one SI unit: as stated, else by the suffix after the last underscore, else nothing.
std::optional<double> stated_unit(Channel channel, const std::string& column, const std::string& stated) {
  if (!stated.empty()) return units_per_si(channel, stated);
  const std::size_t underscore = column.rfind('_');
  if (underscore == std::string::npos) return std::nullopt;
  return units_per_si(channel, std::string_view(column).substr(underscore + 1));
}

/// Finds the channels' columns for one header.
struct Search {
  const LogFormat& format;
  const std::string& file;
  std::size_t line;
  LogHeader& header;

  /// Takes the channel's column where there is one; throws when it was asked for by name and is not there.
  void take(Channel channel) {
    const ColumnChoice& choice = format.columns[index_of(channel)];
    const std::string wanted = choice.name.empty() ? std::string(contract_column(channel)) : choice.name;
    const auto found = std::find(header.names.begin(), header.names.end(), wanted);
    if (found == header.names.end()) {
      if (!choice.name.empty()) complain_missing(channel, wanted);
      return;
    }
    if (std::find(found + 1, header.names.end(), wanted) != header.names.end()) {
      throw bad_input({.file = file,
                       .line = line,
                       .column = wanted,
                       .expected = "each column's name once",
                       .found = "it twice",
                       .advice = "rename one of the two"});
    }
    std::size_t& slot = header.channel_of[static_cast<std::size_t>(found - header.names.begin())];
    if (slot != LogHeader::kUnused) {
      throw bad_input(
          {.file = file,
           .line = line,
           .column = wanted,
           .expected = "one channel for the column",
           .found = fmt::format("{} and {}", channel_name(static_cast<Channel>(slot)), channel_name(channel)),
           .advice = fmt::format("name the column of {} with --columns", channel_name(channel))});
    }
    slot = index_of(channel);
    header.present[index_of(channel)] = true;
    set_unit(channel, wanted, choice.unit);
  }

  void set_unit(Channel channel, const std::string& column, const std::string& stated) {
    const auto per_si = stated_unit(channel, column, stated);
    if (!per_si) {
      header.notes.push_back(fmt::format("column {} states no unit of {}: taken as {}", in_quotes(column),
                                         channel_name(channel), si_unit(channel)));
    }
    const double sign = format.reversed[index_of(channel)] ? -1.0 : 1.0;
    header.per_si[index_of(channel)] = sign * per_si.value_or(1.0);
  }

  [[noreturn]] void complain_missing(Channel channel, const std::string& wanted) const {
    throw bad_input({.file = file,
                     .line = line,
                     .expected = fmt::format("a column {} for {}", in_quotes(wanted), channel_name(channel)),
                     .found = list_of(header.names),
                     .advice = fmt::format("name the column with --columns {}=COLUMN", channel_name(channel))});
  }

  [[nodiscard]] bool here(Channel channel) const { return header.present[index_of(channel)]; }

  void require() {
    for (const Channel channel : {Channel::kTime, Channel::kAngle}) {
      if (!header.present[index_of(channel)]) complain_missing(channel, std::string(contract_column(channel)));
    }
    if (here(Channel::kTorqueBar) || here(Channel::kTorqueRim)) return;
    const bool driver = here(Channel::kTorqueDriver);
    const bool motor = here(Channel::kTorqueMotor);
    if (!driver && !motor) {
      throw bad_input({.file = file,
                       .line = line,
                       .expected = "a column \"torque_bar_nm\", \"torque_rim_nm\", \"torque_driver_nm\" or "
                                   "\"torque_motor_nm\"",
                       .found = list_of(header.names),
                       .advice = "name at least one torque's column with --columns torque_bar=COLUMN"});
    }
    if (!driver) header.notes.emplace_back("no column for torque_driver: taken as zero");
    if (!motor) header.notes.emplace_back("no column for torque_motor: taken as zero");
  }
};

}  // namespace

std::string_view LogHeader::column(Channel channel) const {
  for (std::size_t i = 0; i < channel_of.size(); ++i) {
    if (channel_of[i] == index_of(channel)) return names[i];
  }
  return {};
}

std::uint8_t LogHeader::channels() const {
  unsigned bits = 0;
  for (const Channel channel : kAllChannels) bits |= present[index_of(channel)] ? valid_bit(channel) : 0U;
  if ((bits & (kTorqueBarValid | kTorqueRimValid)) == 0) bits |= kTorqueDriverValid | kTorqueMotorValid;
  return static_cast<std::uint8_t>(bits);
}

LogHeader understand_header(std::string_view text, const LogFormat& format, const std::string& file, std::size_t line) {
  LogHeader header;
  bool broken = false;
  header.separator = detect_separator(text);
  header.names = split_names(text, header.separator, broken);
  if (broken) {
    throw bad_input({.file = file,
                     .line = line,
                     .expected = "names of columns with every quote closed",
                     .found = in_quotes(text),
                     .advice = "close the quote"});
  }
  if (all_numbers(header.names)) {
    throw bad_input({.file = file,
                     .line = line,
                     .expected = "a header with the columns' names",
                     .found = in_quotes(text),
                     .advice = "put a line such as time_s,torque_driver_nm,torque_motor_nm,angle_rad above the rows"});
  }
  header.channel_of.assign(header.names.size(), LogHeader::kUnused);
  Search search{format, file, line, header};
  for (const Channel channel : kAllChannels) search.take(channel);
  search.require();
  return header;
}

}  // namespace steerid
