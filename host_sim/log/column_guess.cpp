// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/column_guess.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "log/text.hpp"
#include "log/units.hpp"

namespace steerid {
namespace {

struct Word {
  std::string_view text;
  Channel channel;
  int score;
  bool whole = false;  ///< the name is nothing else
};

// English and German, as signals are called in databases of vehicles, in PlotJuggler's and ROS's exports.
constexpr std::array kWords = {
    Word{"time", Channel::kTime, 3},
    Word{"zeit", Channel::kTime, 3},
    Word{"stamp", Channel::kTime, 3},
    Word{"clock", Channel::kTime, 2},
    Word{"utc", Channel::kTime, 2, true},
    Word{"date", Channel::kTime, 2, true},
    Word{"datum", Channel::kTime, 2, true},
    Word{"uhrzeit", Channel::kTime, 3},
    Word{"t", Channel::kTime, 3, true},
    Word{"angle", Channel::kAngle, 3},
    Word{"winkel", Channel::kAngle, 3},
    Word{"theta", Channel::kAngle, 3},
    Word{"phi", Channel::kAngle, 2, true},
    Word{"swa", Channel::kAngle, 3, true},
    Word{"encoder", Channel::kAngle, 2},
    Word{"position", Channel::kAngle, 2},
    Word{"pos", Channel::kAngle, 2, true},
    Word{"torque", Channel::kTorqueBar, 1},
    Word{"moment", Channel::kTorqueBar, 1},
    Word{"torsion", Channel::kTorqueBar, 3},
    Word{"tbar", Channel::kTorqueBar, 3},
    Word{"bar", Channel::kTorqueBar, 2, true},
    Word{"torque_bar", Channel::kTorqueBar, 3},
    Word{"handmoment", Channel::kTorqueBar, 3},
    Word{"lenkmoment", Channel::kTorqueBar, 3},
    Word{"steering_torque", Channel::kTorqueBar, 3},
    Word{"steeringtorque", Channel::kTorqueBar, 3},
    Word{"column", Channel::kTorqueBar, 2},
    Word{"rim", Channel::kTorqueRim, 3},
    Word{"grip", Channel::kTorqueRim, 2},
    Word{"motor", Channel::kTorqueMotor, 3},
    Word{"assist", Channel::kTorqueMotor, 3},
    Word{"actuator", Channel::kTorqueMotor, 2},
    Word{"unterst", Channel::kTorqueMotor, 3},
    Word{"driver", Channel::kTorqueDriver, 3},
    Word{"voluntary", Channel::kTorqueDriver, 3},
    Word{"fahrer", Channel::kTorqueDriver, 3},
    Word{"probe", Channel::kProbe, 3},
    Word{"excitation", Channel::kProbe, 3},
    Word{"anregung", Channel::kProbe, 3},
    Word{"dither", Channel::kProbe, 3},
    Word{"injected", Channel::kProbe, 2},
};

constexpr std::array<std::string_view, 6> kOfTorque = {"torque", "moment", "trq", "torq", "force", "kraft"};
// Of these a log has many, and none of them is a channel.
constexpr std::array<std::string_view, 8> kOfNothing = {"speed",       "veloc", "rate", "valid",
                                                        "temperature", "count", "crc",  "current"};

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), lower_case);
  return out;
}

bool letter(char c) { return c >= 'a' && c <= 'z'; }

/// The word stands in the name between what is no letter.
bool has_alone(std::string_view name, std::string_view word) {
  for (std::size_t at = 0; (at = name.find(word, at)) != std::string_view::npos; ++at) {
    const bool before = at > 0 && letter(name[at - 1]);
    const std::size_t end = at + word.size();
    if (!before && (end == name.size() || !letter(name[end]))) return true;
  }
  return false;
}

template <class Words>
bool has_any(std::string_view name, const Words& words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return name.find(word) != std::string_view::npos; });
}

}  // namespace

int likeness(const LogColumn& column, Channel channel) {
  const std::string name = lower(column.name);
  if (has_any(name, kOfNothing)) return 0;
  int score = 0;
  for (const Word& word : kWords) {
    const bool there = word.whole ? has_alone(name, word.text) : name.find(word.text) != std::string::npos;
    if (word.channel == channel && there) score = std::max(score, word.score);
  }
  const Quantity quantity = quantity_of(channel);
  if (quantity == Quantity::kTorque && has_any(name, kOfTorque)) ++score;
  if (score == 0) return 0;
  const NameAndUnit split = split_unit(quantity, column.name);
  if (!split.unit.empty() || !plain_unit(quantity, column.unit).empty()) return score + 2;
  for (const Quantity other : {Quantity::kTime, Quantity::kTorque, Quantity::kAngle}) {
    const bool stated = !split_unit(other, column.name).unit.empty() || !plain_unit(other, column.unit).empty();
    if (other != quantity && stated) return score - 4;
  }
  return score;
}

std::array<std::optional<std::size_t>, kChannels> likely_columns(const std::vector<LogColumn>& columns) {
  struct Pair {
    int score;
    std::size_t column;
    std::size_t channel;
  };
  std::vector<Pair> pairs;
  for (std::size_t column = 0; column < columns.size(); ++column) {
    for (const Channel channel : kAllChannels) {
      const int score = likeness(columns[column], channel);
      if (score >= kWorthNaming) pairs.push_back({score, column, static_cast<std::size_t>(channel)});
    }
  }
  std::ranges::stable_sort(pairs, std::ranges::greater(), &Pair::score);
  std::array<std::optional<std::size_t>, kChannels> likely{};
  std::vector<bool> taken(columns.size());
  for (const Pair& pair : pairs) {
    if (taken[pair.column] || likely.at(pair.channel)) continue;
    likely.at(pair.channel) = pair.column;
    taken[pair.column] = true;
  }
  return likely;
}

}  // namespace steerid
