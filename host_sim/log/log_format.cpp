// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/log_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "log/bad_input.hpp"
#include "log/text.hpp"

namespace steerid {
namespace {

struct ChannelFacts {
  std::string_view name;
  std::string_view column;
  Quantity quantity;
  std::vector<double> Record::*values;
  std::uint8_t valid_bit;
};

constexpr ChannelFacts torque(std::uint8_t valid_bit, std::string_view column, std::vector<double> Record::*values) {
  return {channel_name(valid_bit), column, Quantity::kTorque, values, valid_bit};
}

// In the order of Channel.
constexpr std::array<ChannelFacts, kChannels> kFacts = {{
    {"time", "time_s", Quantity::kTime, &Record::time_s, 0},
    torque(kTorqueDriverValid, "torque_driver_nm", &Record::torque_driver_nm),
    torque(kTorqueMotorValid, "torque_motor_nm", &Record::torque_motor_nm),
    {channel_name(kAngleValid), "angle_rad", Quantity::kAngle, &Record::angle_rad, kAngleValid},
    torque(kTorqueBarValid, "torque_bar_nm", &Record::torque_bar_nm),
    torque(kTorqueRimValid, "torque_rim_nm", &Record::torque_rim_nm),
    torque(kProbeValid, "probe_nm", &Record::probe_nm),
}};

const ChannelFacts& facts(Channel channel) { return kFacts[static_cast<std::size_t>(channel)]; }

bool is_torque(Channel channel) { return quantity_of(channel) == Quantity::kTorque; }

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

/// The parts of a comma list, trimmed; a comma in quotes parts nothing.
std::vector<std::string_view> comma_list(std::string_view text) {
  std::vector<std::string_view> parts;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (text[i] != ',' || quoted) continue;
    parts.push_back(trimmed(text.substr(begin, i - begin)));
    begin = i + 1;
  }
  parts.push_back(trimmed(text.substr(begin)));
  return parts;
}

/// The column's name and what stands behind its colon.
struct NameAndRest {
  std::string name;
  std::optional<std::string_view> rest{};
};

NameAndRest split_choice(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('"')) {
    NameAndRest split;
    std::size_t i = 1;
    for (; i < text.size(); ++i) {
      if (text[i] == '"' && text.substr(i + 1).starts_with('"')) {
        ++i;
      } else if (text[i] == '"') {
        break;
      }
      split.name += text[i];
    }
    const std::string_view behind = i < text.size() ? trimmed(text.substr(i + 1)) : std::string_view();
    if (!behind.empty()) split.rest = trimmed(behind.substr(behind.front() == ':' ? 1 : 0));
    return split;
  }
  const std::size_t colon = text.rfind(':');
  NameAndRest split{.name = std::string(trimmed(text.substr(0, colon)))};
  if (colon != std::string_view::npos) split.rest = trimmed(text.substr(colon + 1));
  return split;
}

/// A number that `text` starts with, taken off it.
std::optional<double> take_number(std::string_view& text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text = trimmed(text.substr(static_cast<std::size_t>(stop - text.data())));
  return value;
}

/// "deg*0.0219-180": false when that cannot be read.
bool take_unit(Channel channel, std::string_view text, ColumnChoice& choice) {
  const std::size_t star = text.find('*');
  const bool letter_behind = star != std::string_view::npos && star + 1 < text.size() &&
                             lower_case(text[star + 1]) >= 'a' && lower_case(text[star + 1]) <= 'z';
  const bool dotted = letter_behind && units_per_si(quantity_of(channel), text).has_value();  // N*m
  const std::size_t plus = dotted ? std::string_view::npos : text.find_first_of("*+-");
  choice.unit = std::string(trimmed(text.substr(0, plus)));
  if (!units_per_si(quantity_of(channel), choice.unit)) return false;
  if (plus == std::string_view::npos) return true;
  std::string_view rest = text.substr(plus);
  if (rest.starts_with('*')) {
    rest.remove_prefix(1);
    const auto scale = take_number(rest);
    if (!scale || *scale == 0) return false;
    choice.scale = *scale;
  }
  if (rest.empty()) return true;
  const auto offset = take_number(rest);
  choice.offset = offset.value_or(0);
  return offset && rest.empty();
}

ColumnChoice parse_choice(Channel channel, std::string_view text) {
  const NameAndRest split = split_choice(text);
  ColumnChoice choice{.name = split.name};
  if (choice.name.empty()) {
    throw BadOption(fmt::format("--columns: expected {}=COLUMN, found no column's name", channel_name(channel)));
  }
  if (split.rest && !take_unit(channel, *split.rest, choice)) {
    throw BadOption(fmt::format(
        "--columns {}={}: expected one of the units {} after the colon, and for counts *SCALE+OFFSET behind it, found "
        "{}",
        channel_name(channel), in_quotes(choice.name), unit_list(quantity_of(channel)), in_quotes(*split.rest)));
  }
  return choice;
}

bool is_of_a_file(const ColumnChoice& choice) { return choice.name.find('/') != std::string::npos; }

}  // namespace

std::string_view channel_name(Channel channel) { return facts(channel).name; }
std::string_view contract_column(Channel channel) { return facts(channel).column; }
Quantity quantity_of(Channel channel) { return facts(channel).quantity; }

std::string_view si_unit(Channel channel) {
  switch (quantity_of(channel)) {
    case Quantity::kTime:
      return "s";
    case Quantity::kTorque:
      return "nm";
    case Quantity::kAngle:
      break;
  }
  return "rad";
}

std::uint8_t valid_bit(Channel channel) { return facts(channel).valid_bit; }
std::vector<double>& values_of(Record& record, Channel channel) { return record.*facts(channel).values; }
const std::vector<double>& values_of(const Record& record, Channel channel) { return record.*facts(channel).values; }

std::string choice_text(Channel channel, const ColumnChoice& choice) {
  std::string text = std::string(channel_name(channel)) + "=";
  if (choice.name.find_first_of(",:=\"") != std::string::npos || choice.name != trimmed(choice.name)) {
    text += '"';
    for (const char c : choice.name) text += c == '"' ? std::string(2, c) : std::string(1, c);
    text += '"';
  } else {
    text += choice.name;
  }
  if (!choice.unit.empty()) text += ":" + choice.unit;
  if (choice.scale != 1.0) text += fmt::format("*{}", choice.scale);
  if (choice.offset != 0.0) text += fmt::format("{:+}", choice.offset);
  return text;
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
    if (slot.name.empty()) {
      slot = std::move(choice);
    } else if (*channel == Channel::kTime && is_of_a_file(slot) && is_of_a_file(choice)) {
      choices.more_times.push_back(std::move(choice));
    } else {
      throw BadOption(fmt::format("--columns: expected each channel once, found {} twice{}", channel_name(*channel),
                                  *channel == Channel::kTime ? "; of several files say time=FILE/COLUMN" : ""));
    }
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
