// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/chosen_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "log/bad_input.hpp"
#include "log/column_guess.hpp"
#include "log/text.hpp"

namespace steerid {
namespace {

constexpr std::size_t index_of(Channel channel) { return static_cast<std::size_t>(channel); }

constexpr const char* kAnyTorque = "torque_bar_nm, torque_rim_nm, torque_driver_nm or torque_motor_nm";
constexpr std::array kTorques = {Channel::kTorqueBar, Channel::kTorqueRim, Channel::kTorqueDriver,
                                 Channel::kTorqueMotor};

/// A file's column.
struct Place {
  std::size_t file;
  std::size_t column;

  bool operator==(const Place&) const = default;
};

/// The contract's name without its unit: "angle".
std::string_view bare_name(Channel channel) { return split_unit(quantity_of(channel), contract_column(channel)).name; }

/// Finds the channels' columns among all files.
class Search {
 public:
  Search(const std::vector<NamedLog>& logs, const LogFormat& format) : logs_(logs), format_(format) {
    choice_.files.resize(logs.size());
  }

  Choice all() {
    for (std::size_t file = 0; file < logs_.size(); ++file) take_time(file);
    for (const bool named : {true, false}) {
      for (const Channel channel : kAllChannels) {
        if (channel != Channel::kTime && named != format_.columns[index_of(channel)].name.empty()) take(channel);
      }
    }
    require();
    return std::move(choice_);
  }

 private:
  using Match = bool (*)(Channel, const LogColumn&, std::string_view);

  static bool same(Channel, const LogColumn& column, std::string_view wanted) { return column.name == wanted; }
  static bool same_but_case(Channel, const LogColumn& column, std::string_view wanted) {
    return equal_ignoring_case(column.name, wanted);
  }
  static bool same_but_unit(Channel channel, const LogColumn& column, std::string_view wanted) {
    const NameAndUnit split = split_unit(quantity_of(channel), column.name);
    return !split.unit.empty() && equal_ignoring_case(split.name, wanted);
  }

  /// Of "/steering/state/angle_rad", as PlotJuggler and MCAP call a field, what is behind the topic.
  static bool same_field(Channel channel, const LogColumn& column, std::string_view wanted) {
    const std::size_t slash = column.name.rfind('/');
    if (slash == std::string::npos) return false;
    const LogColumn field{.name = column.name.substr(slash + 1)};
    return same_but_case(channel, field, wanted) || same_but_unit(channel, field, wanted);
  }

  /// The places of a name, by the strictest of the ways that finds one.
  [[nodiscard]] std::vector<Place> places_of(Channel channel, const std::string& wanted) const {
    for (const Match match : {&same, &same_but_case, &same_but_unit, &same_field}) {
      std::vector<Place> places;
      for (std::size_t file = 0; file < logs_.size(); ++file) {
        const auto& columns = logs_[file].source->columns();
        const std::string prefix = logs_[file].stem + "/";
        for (std::size_t i = 0; i < columns.size(); ++i) {
          const bool plain = match(channel, columns[i], wanted);
          const bool of_this_file = logs_.size() > 1 && wanted.starts_with(prefix) &&
                                    match(channel, columns[i], std::string_view(wanted).substr(prefix.size()));
          if (plain || of_this_file) places.push_back({file, i});
        }
      }
      if (!places.empty()) return places;
    }
    return {};
  }

  /// The place of a channel's column where there is one; throws when it is not the only one.
  [[nodiscard]] std::optional<Place> place_of(Channel channel, const ColumnChoice& choice) const {
    std::vector<Place> places;
    if (choice.name.empty()) {
      places = places_of(channel, std::string(contract_column(channel)));
      if (places.empty()) places = places_of(channel, std::string(bare_name(channel)));
    } else {
      places = places_of(channel, choice.name);
      if (places.empty()) complain_missing(channel, choice.name);
    }
    if (places.empty()) return std::nullopt;
    if (places.size() > 1) complain_twice(channel, places);
    return places.front();
  }

  void take(Channel channel) {
    const ColumnChoice& choice = format_.columns[index_of(channel)];
    const auto place = place_of(channel, choice);
    if (!place) return;
    ChosenColumns& chosen = choice_.files[place->file];
    const auto& time = chosen.wanted.time;
    if (time && time->column == place->column) complain_two_channels(*place, Channel::kTime, channel);
    for (std::size_t i = 0; i < chosen.channels.size(); ++i) {
      if (chosen.wanted.columns[i].column != place->column) continue;
      if (choice.name.empty()) return;  // it was given to another channel by name
      complain_two_channels(*place, chosen.channels[i], channel);
    }
    chosen.channels.push_back(channel);
    chosen.wanted.columns.push_back({.column = place->column, .to_si = conversion(channel, *place, choice)});
    choice_.present[index_of(channel)] = true;
    const std::string& name = logs_[place->file].source->columns()[place->column].name;
    choice_.columns[index_of(channel)] = logs_.size() > 1 ? logs_[place->file].stem + "/" + name : name;
  }

  /// A file's own time: the column that --columns names for it, else the contract's.
  void take_time(std::size_t file) {
    if (!logs_[file].source->time_is_a_column()) {
      choice_.present[index_of(Channel::kTime)] = true;
      return;
    }
    std::vector<ColumnChoice> named = format_.columns.more_times;
    const ColumnChoice& first = format_.columns[index_of(Channel::kTime)];
    if (!first.name.empty()) named.insert(named.begin(), first);
    for (const ColumnChoice& choice : named) {
      for (const Place& place : places_of(Channel::kTime, choice.name)) {
        if (place.file == file) return set_time(place, choice);
      }
    }
    if (logs_.size() == 1 && !named.empty()) complain_missing(Channel::kTime, named.front().name);
    for (const std::string_view name : {contract_column(Channel::kTime), bare_name(Channel::kTime)}) {
      for (const Place& place : places_of(Channel::kTime, std::string(name))) {
        if (place.file == file) return set_time(place, {});
      }
    }
    without_time_.push_back(file);
  }

  void set_time(const Place& place, const ColumnChoice& choice) {
    ChosenColumns& chosen = choice_.files[place.file];
    if (chosen.wanted.time) complain_twice(Channel::kTime, {{place.file, chosen.wanted.time->column}, place});
    const auto& columns = logs_[place.file].source->columns();
    const auto twice = std::ranges::count(columns, columns[place.column].name, &LogColumn::name);
    if (twice > 1) complain_twice(Channel::kTime, {place, place});
    chosen.wanted.time = WantedColumn{.column = place.column, .to_si = conversion(Channel::kTime, place, choice)};
    choice_.present[index_of(Channel::kTime)] = true;
  }

  /// By the unit as --columns states it, else the name, else the file beside the name; else SI is taken, and said so.
  ToSi conversion(Channel channel, const Place& place, const ColumnChoice& choice) {
    const Quantity quantity = quantity_of(channel);
    const LogColumn& column = logs_[place.file].source->columns()[place.column];
    std::string_view unit = choice.unit;
    if (unit.empty()) unit = split_unit(quantity, column.name).unit;
    if (unit.empty() && states_a_unit(column.unit)) unit = column.unit;
    const std::optional<double> per_si = unit.empty() ? std::nullopt : units_per_si(quantity, unit);
    if (!unit.empty() && !per_si) complain_unit(channel, place, unit);
    const std::string_view plain = plain_unit(quantity, unit);
    choice_.slide = choice_.slide || plain == "m" || plain == "n";
    if (!per_si) {
      choice_.notes.push_back(fmt::format("column {} states no unit of {}: taken as {}", in_quotes(column.name),
                                          channel_name(channel), si_unit(channel)));
    }
    const double sign = format_.reversed[index_of(channel)] ? -1.0 : 1.0;
    return {.scale = choice.scale, .offset = choice.offset, .per_si = sign * per_si.value_or(1.0)};
  }

  /// Not "-", "1" or "[]".
  static bool states_a_unit(std::string_view unit) {
    return std::ranges::any_of(
        unit, [](char c) { return c == '%' || lower_case(c) != c || (c >= 'a' && c <= 'z') || (c & 0x80) != 0; });
  }

  /// All columns of a file, up to eight, for a sentence.
  [[nodiscard]] std::string names_in(std::size_t file) const {
    constexpr std::size_t kMostNames = 8;
    const auto& columns = logs_[file].source->columns();
    std::string list;
    for (std::size_t i = 0; i < std::min(columns.size(), kMostNames); ++i) {
      list += (i == 0 ? "" : ", ") + in_quotes(columns[i].name);
    }
    if (columns.size() > kMostNames) list += fmt::format(" and {} more", columns.size() - kMostNames);
    return list.empty() ? "none" : list;
  }

  [[nodiscard]] std::string names_everywhere() const {
    std::string list = names_in(0);
    for (std::size_t file = 1; file < logs_.size(); ++file) list += ", in " + logs_[file].name + " " + names_in(file);
    return list;
  }

  /// "angle=theta", or "angle=COLUMN" where nothing looks like it.
  [[nodiscard]] std::string proposal(Channel channel, std::size_t first_file, std::size_t last_file) const {
    for (std::size_t file = first_file; file <= last_file; ++file) {
      const auto likely = likely_columns(logs_[file].source->columns())[index_of(channel)];
      if (!likely) continue;
      const std::string name = logs_[file].source->columns()[*likely].name;
      return choice_text(channel, {.name = logs_.size() > 1 ? logs_[file].stem + "/" + name : name});
    }
    return fmt::format("{}=COLUMN", channel_name(channel));
  }

  [[nodiscard]] std::string proposal(Channel channel) const { return proposal(channel, 0, logs_.size() - 1); }

  [[noreturn]] void complain_missing(Channel channel, const std::string& wanted) const {
    throw bad_input({.file = logs_.front().name,
                     .line = logs_.front().source->header_line(),
                     .expected = fmt::format("a column {} for {}", in_quotes(wanted), channel_name(channel)),
                     .found = names_everywhere(),
                     .advice = fmt::format("name the column with --columns {}", proposal(channel))});
  }

  [[noreturn]] void complain_twice(Channel channel, const std::vector<Place>& places) const {
    const Place& first = places.front();
    const Place& second = places.back();
    const std::string& name = logs_[first.file].source->columns()[first.column].name;
    const std::string& other = logs_[second.file].source->columns()[second.column].name;
    const bool one_file = first.file == second.file;
    if (one_file && name != other) {
      throw bad_input({.file = logs_[first.file].name,
                       .line = logs_[first.file].source->header_line(),
                       .expected = fmt::format("one column for {}", channel_name(channel)),
                       .found = in_quotes(name) + " and " + in_quotes(other),
                       .advice = fmt::format("say which with --columns {}", choice_text(channel, {.name = name}))});
    }
    throw bad_input({.file = logs_[first.file].name,
                     .line = logs_[first.file].source->header_line(),
                     .column = name,
                     .expected = "each column's name once",
                     .found = one_file ? "it twice" : "it in " + logs_[second.file].name + " too",
                     .advice = one_file ? "rename one of the two"
                                        : fmt::format("say which with --columns {}={}/{}", channel_name(channel),
                                                      logs_[first.file].stem, name)});
  }

  [[noreturn]] void complain_two_channels(const Place& place, Channel one, Channel other) const {
    throw bad_input({.file = logs_[place.file].name,
                     .line = logs_[place.file].source->header_line(),
                     .column = logs_[place.file].source->columns()[place.column].name,
                     .expected = "one channel for the column",
                     .found = fmt::format("{} and {}", channel_name(one), channel_name(other)),
                     .advice = fmt::format("name the column of {} with --columns", channel_name(other))});
  }

  [[noreturn]] void complain_unit(Channel channel, const Place& place, std::string_view unit) const {
    const std::string& name = logs_[place.file].source->columns()[place.column].name;
    throw bad_input(
        {.file = logs_[place.file].name,
         .line = logs_[place.file].source->header_line(),
         .column = name,
         .expected = fmt::format("a unit of {} ({})", channel_name(channel), unit_list(quantity_of(channel))),
         .found = in_quotes(unit),
         .advice = fmt::format("say how much one of it is, as --columns {}*SCALE",
                               choice_text(channel, {.name = name, .unit = std::string(si_unit(channel))}))});
  }

  [[nodiscard]] bool here(Channel channel) const { return choice_.present[index_of(channel)]; }

  void require() {
    std::vector<std::string> missing;
    std::vector<std::string> proposals;
    for (const std::size_t file : without_time_) {
      missing.push_back(logs_.size() > 1 ? "time_s of " + logs_[file].name : "time_s");
      proposals.push_back(proposal(Channel::kTime, file, file));
    }
    if (!here(Channel::kAngle)) {
      missing.emplace_back(contract_column(Channel::kAngle));
      proposals.push_back(proposal(Channel::kAngle));
    }
    if (std::ranges::none_of(kTorques, [&](Channel channel) { return here(channel); })) {
      missing.emplace_back(kAnyTorque);
      proposals.push_back(torque_proposal());
    }
    if (!missing.empty()) complain_missing(missing, proposals);
    if (here(Channel::kTorqueBar) || here(Channel::kTorqueRim)) return;
    for (const Channel channel : {Channel::kTorqueDriver, Channel::kTorqueMotor}) {
      if (here(channel)) continue;
      choice_.notes.push_back(fmt::format("no column for {}: taken as zero", channel_name(channel)));
    }
  }

  [[nodiscard]] std::string torque_proposal() const {
    for (const Channel channel : kTorques) {
      std::string text = proposal(channel);
      if (!text.ends_with("=COLUMN")) return text;
    }
    return "torque_bar=COLUMN";
  }

  [[noreturn]] void complain_missing(const std::vector<std::string>& missing,
                                     const std::vector<std::string>& proposals) const {
    throw bad_input(
        {.file = logs_.front().name,
         .line = logs_.front().source->header_line(),
         .expected = fmt::format("{} {}", missing.size() == 1 ? "a column" : "columns", fmt::join(missing, "; ")),
         .found = names_everywhere(),
         .advice = fmt::format("name {} with --columns {}, or see what `steerid inspect` proposes",
                               missing.size() == 1 ? "it" : "them", fmt::join(proposals, ","))});
  }

  const std::vector<NamedLog>& logs_;
  const LogFormat& format_;
  Choice choice_{};
  std::vector<std::size_t> without_time_{};
};

}  // namespace

std::uint8_t Choice::channels() const {
  unsigned bits = 0;
  for (const Channel channel : kAllChannels) bits |= present[index_of(channel)] ? valid_bit(channel) : 0U;
  if ((bits & (kTorqueBarValid | kTorqueRimValid)) == 0) bits |= kTorqueDriverValid | kTorqueMotorValid;
  return static_cast<std::uint8_t>(bits);
}

Choice choose_columns(const std::vector<NamedLog>& logs, const LogFormat& format) { return Search(logs, format).all(); }

}  // namespace steerid
