// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/proposed_columns.hpp"

#include <optional>

#include "log/column_guess.hpp"
#include "log/units.hpp"

namespace steerid {
namespace {

constexpr std::size_t index_of(Channel channel) { return static_cast<std::size_t>(channel); }

ColumnChoice choice_of(const std::vector<NamedLog>& logs, std::size_t file, std::size_t column, Channel channel) {
  const LogColumn& found = logs[file].source->columns()[column];
  const Quantity quantity = quantity_of(channel);
  std::string_view unit = split_unit(quantity, found.name).unit;
  if (unit.empty()) unit = plain_unit(quantity, found.unit);
  return {.name = logs.size() > 1 ? logs[file].stem + "/" + found.name : found.name, .unit = std::string(unit)};
}

}  // namespace

ColumnChoices proposed_columns(const std::vector<NamedLog>& logs, const ColumnChoices& said) {
  ColumnChoices choices = said;
  std::array<int, kChannels> best{};
  const bool time_said = !said[index_of(Channel::kTime)].name.empty();
  for (std::size_t file = 0; file < logs.size(); ++file) {
    const auto& columns = logs[file].source->columns();
    const auto likely = likely_columns(columns);
    for (const Channel channel : kAllChannels) {
      const auto& column = likely.at(index_of(channel));
      if (!column || !said[index_of(channel)].name.empty()) continue;
      if (channel == Channel::kTime) {
        if (time_said || !logs[file].source->time_is_a_column()) continue;
        const ColumnChoice time = choice_of(logs, file, *column, channel);
        if (choices[index_of(channel)].name.empty()) {
          choices[index_of(channel)] = time;
        } else {
          choices.more_times.push_back(time);
        }
        continue;
      }
      const int score = likeness(columns[*column], channel);
      if (score <= best.at(index_of(channel))) continue;
      best.at(index_of(channel)) = score;
      choices[index_of(channel)] = choice_of(logs, file, *column, channel);
    }
  }
  return choices;
}

std::string columns_text(const ColumnChoices& choices) {
  std::string text;
  const auto add = [&](Channel channel, const ColumnChoice& choice) {
    if (choice.name.empty()) return;
    if (!text.empty()) text += ',';
    text += choice_text(channel, choice);
  };
  for (const Channel channel : kAllChannels) {
    add(channel, choices[index_of(channel)]);
    if (channel != Channel::kTime) continue;
    for (const ColumnChoice& more : choices.more_times) add(channel, more);
  }
  return text;
}

}  // namespace steerid
