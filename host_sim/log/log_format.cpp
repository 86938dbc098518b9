// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/log_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "log/bad_input.hpp"
#include "log/text.hpp"

namespace steerid {
namespace {

struct Unit {
  std::string_view name;
  double per_si;
};

constexpr std::array kTimeUnits = {Unit{"s", 1.0}, Unit{"ms", 1e3}, Unit{"us", 1e6}};
constexpr std::array kTorqueUnits = {Unit{"nm", 1.0}, Unit{"mnm", 1e3}, Unit{"n", 1.0}};
constexpr std::array kAngleUnits = {Unit{"rad", 1.0}, Unit{"deg", 180.0 / std::numbers::pi}, Unit{"mrad", 1e3},
                                    Unit{"urad", 1e6}, Unit{"m", 1.0}};

struct ChannelFacts {
  std::string_view name;
  std::string_view column;
  const Unit* first;
  const Unit* last;
  std::vector<double> Record::*values;
  std::uint8_t valid_bit;
};

constexpr ChannelFacts torque(std::uint8_t valid_bit, std::string_view column, std::vector<double> Record::*values) {
  return {channel_name(valid_bit),
          column,
          kTorqueUnits.data(),
          kTorqueUnits.data() + kTorqueUnits.size(),
          values,
          valid_bit};
}

// In the order of Channel.
constexpr std::array<ChannelFacts, kChannels> kFacts = {{
    {"time", "time_s", kTimeUnits.data(), kTimeUnits.data() + kTimeUnits.size(), &Record::time_s, 0},
    torque(kTorqueDriverValid, "torque_driver_nm", &Record::torque_driver_nm),
    torque(kTorqueMotorValid, "torque_motor_nm", &Record::torque_motor_nm),
    {channel_name(kAngleValid), "angle_rad", kAngleUnits.data(), kAngleUnits.data() + kAngleUnits.size(),
     &Record::angle_rad, kAngleValid},
    torque(kTorqueBarValid, "torque_bar_nm", &Record::torque_bar_nm),
    torque(kTorqueRimValid, "torque_rim_nm", &Record::torque_rim_nm),
    torque(kProbeValid, "probe_nm", &Record::probe_nm),
}};

const ChannelFacts& facts(Channel channel) { return kFacts[static_cast<std::size_t>(channel)]; }

std::string unit_list(Channel channel) {
  std::string list;
  for (const Unit* unit = facts(channel).first; unit != facts(channel).last; ++unit) {
    list += list.empty() ? "" : ", ";
    list += unit->name;
  }
  return list;
}

bool is_torque(Channel channel) { return facts(channel).first == kTorqueUnits.data(); }

/// The channels after the first `skipped`, by name, for a sentence.
std::string channel_list(std::size_t skipped) {
  std::string list;
  for (std::size_t i = skipped; i < kChannels; ++i) {
    list += list.empty() ? "" : ", ";
    list += kFacts[i].name;
  }
  return list;
}

std::optional<Channel> channel_named(std::string_view name) {
  for (const Channel channel : kAllChannels) {
    if (channel_name(channel) == name) return channel;
  }
  return std::nullopt;
}

/// The parts of a comma list, trimmed.
std::vector<std::string_view> comma_list(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.push_back(trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

ColumnChoice parse_choice(Channel channel, std::string_view text) {
  const std::size_t colon = text.rfind(':');
  ColumnChoice choice{.name = std::string(trimmed(text.substr(0, colon)))};
  if (choice.name.empty()) {
    throw BadOption(fmt::format("--columns: expected {}=COLUMN, found no column's name", channel_name(channel)));
  }
  if (colon != std::string_view::npos) {
    choice.unit = std::string(trimmed(text.substr(colon + 1)));
    if (!units_per_si(channel, choice.unit)) {
      throw BadOption(fmt::format("--columns {}={}: expected one of the units {} after the colon, found {}",
                                  channel_name(channel), in_quotes(choice.name), unit_list(channel),
                                  in_quotes(choice.unit)));
    }
  }
  return choice;
}

}  // namespace

std::string_view channel_name(Channel channel) { return facts(channel).name; }
std::string_view contract_column(Channel channel) { return facts(channel).column; }
std::string_view si_unit(Channel channel) { return facts(channel).first->name; }
std::uint8_t valid_bit(Channel channel) { return facts(channel).valid_bit; }
std::vector<double>& values_of(Record& record, Channel channel) { return record.*facts(channel).values; }
const std::vector<double>& values_of(const Record& record, Channel channel) { return record.*facts(channel).values; }

std::optional<double> units_per_si(Channel channel, std::string_view unit) {
  const Unit* found = std::find_if(facts(channel).first, facts(channel).last,
                                   [&](const Unit& known) { return equal_ignoring_case(known.name, unit); });
  if (found == facts(channel).last) return std::nullopt;
  return found->per_si;
}

ColumnChoices parse_columns(std::string_view text) {
  ColumnChoices choices;
  for (const std::string_view part : comma_list(text)) {
    const std::size_t equals = part.find('=');
    const auto channel = channel_named(trimmed(part.substr(0, equals)));
    if (!channel || equals == std::string_view::npos) {
      throw BadOption(fmt::format("--columns: expected CHANNEL=COLUMN with CHANNEL one of {}, found {}",
                                  channel_list(0), in_quotes(part)));
    }
    ColumnChoice choice = parse_choice(*channel, part.substr(equals + 1));
    for (const ColumnChoice& earlier : choices) {
      if (earlier.name == choice.name) {
        throw BadOption(fmt::format("--columns: expected each column once, found {} twice", in_quotes(choice.name)));
      }
    }
    ColumnChoice& slot = choices[static_cast<std::size_t>(*channel)];
    if (!slot.name.empty()) {
      throw BadOption(fmt::format("--columns: expected each channel once, found {} twice", channel_name(*channel)));
    }
    slot = std::move(choice);
  }
  return choices;
}

Reversed parse_sign(std::string_view text) {
  Reversed reversed{};
  if (trimmed(text) == "-1") {
    for (const Channel channel : kAllChannels) reversed[static_cast<std::size_t>(channel)] = is_torque(channel);
    return reversed;
  }
  for (const std::string_view part : comma_list(text)) {
    const bool minus = part.starts_with('-');
    const std::size_t equals = part.find('=');
    const std::string_view name = trimmed(part.substr(minus ? 1 : 0, equals - (minus ? 1 : 0)));
    const std::string_view sign = equals == std::string_view::npos ? "-1" : trimmed(part.substr(equals + 1));
    const auto channel = channel_named(name);
    const bool sign_twice = minus && equals != std::string_view::npos;
    if (!channel || *channel == Channel::kTime || sign_twice || (sign != "-1" && sign != "1")) {
      throw BadOption(
          fmt::format("--sign: expected -1, or a list of {}, each alone, as -CHANNEL or CHANNEL=-1, found {}",
                      channel_list(1), in_quotes(part)));
    }
    reversed[static_cast<std::size_t>(*channel)] = sign == "-1";
  }
  return reversed;
}

}  // namespace steerid
