// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/held_messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <span>
#include <vector>

#include "log/channel_noise.hpp"
#include "log/least_squares_line.hpp"
#include "log/new_values.hpp"
#include "log/quantile.hpp"
#include "log/sampling_instants.hpp"
#include "log/stamp_limits.hpp"

namespace steerid {
namespace {

constexpr std::size_t kFewest = 50;  // messages
constexpr double kBeyond = 0.01;     // share of the changes on either side that may stray

/// Between two changes, those left out between which messages may be missing.
double usual_interval(const std::vector<double>& changed_s) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < changed_s.size(); ++i) intervals_s.push_back(changed_s[i] - changed_s[i - 1]);
  const double longest_s = 1.5 * quantile(intervals_s, 0.9);
  std::erase_if(intervals_s, [&](double one) { return one > longest_s; });
  double sum_s = 0;
  for (const double one : intervals_s) sum_s += one;
  return sum_s / static_cast<double>(intervals_s.size());
}

/// How late messages stand in their rows against an even clock.
struct Late {
  double earliest_s;
  double spread_s;
};

Late late_against(double period_s, const std::vector<double>& changed_s, const std::vector<double>& number) {
  std::vector<double> late_s = changed_s;
  for (std::size_t i = 0; i < late_s.size(); ++i) late_s[i] -= number[i] * period_s;
  const double earliest_s = quantile(late_s, kBeyond);
  return {earliest_s, quantile(std::move(late_s), 1 - kBeyond) - earliest_s};
}

/// The period by which they spread the least: of messages that nothing makes wait but the next row. It rounds their
/// stamps up by more and more, and less at once, where the clocks drift; a line through them takes that for a slope.
double rounded_up_period(const std::vector<double>& changed_s, const std::vector<double>& number, double row_s) {
  constexpr int kSteps = 40;
  const double periods = number.back();
  const double about_s = (changed_s.back() - changed_s.front()) / periods;
  double low_s = about_s - 2 * row_s / periods;
  double high_s = about_s + 2 * row_s / periods;
  const auto spread_s = [&](double period_s) { return late_against(period_s, changed_s, number).spread_s; };
  for (int i = 0; i < kSteps; ++i) {  // it falls, and rises again
    const double third_s = (high_s - low_s) / 3;
    if (spread_s(low_s + third_s) < spread_s(high_s - third_s)) {
      high_s -= third_s;
    } else {
      low_s += third_s;
    }
  }
  return (low_s + high_s) / 2;
}

/// Of the messages that changed a channel, from zero on, where the sensor is slower than every second row.
std::vector<double> numbers_on_a_grid(const std::vector<double>& changed_s, const std::vector<double>& message,
                                      double usual_s) {
  const double period_s = clock_period_s(changed_s, usual_s, true);
  const std::vector<double> grid_s = even_stamps(changed_s, period_s, std::span(&message, 1));
  std::vector<double> number(changed_s.size());
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = std::round((grid_s[i] - grid_s.front()) / period_s);
  return number;
}

/// Of every period the changes stand in a part that is a row long: where that begins, behind the longest part that they
/// leave empty, and how long that is.
struct EmptyPart {
  double end_s;
  double length_s;
};

EmptyPart empty_part(const std::vector<double>& changed_s, double period_s) {
  std::vector<double> place_s;
  for (const double stamp_s : changed_s) place_s.push_back(std::fmod(stamp_s - changed_s.front(), period_s));
  std::ranges::sort(place_s);
  EmptyPart longest{place_s.front(), place_s.front() + period_s - place_s.back()};
  for (std::size_t i = 1; i < place_s.size(); ++i) {
    const double length_s = place_s[i] - place_s[i - 1];
    if (length_s > longest.length_s) longest = {place_s[i], length_s};
  }
  return longest;
}

/// Where it is faster: rows that repeat come every R, so that P = R row / (R - row), as nearly as R is known; the
/// period is the one that leaves most of itself empty.
std::vector<double> numbers_between_repeats(const std::vector<double>& time_s, const std::vector<double>& changed_s,
                                            double row_s) {
  constexpr double kFewestRows = 1.5;    // from one repeat to the next
  constexpr std::size_t kLooked = 2000;  // changes
  constexpr int kSteps = 150;            // to either side
  constexpr double kReach = 1.5;         // rows over the whole
  constexpr double kRounding = 1e-6;     // of a row
  std::vector<double> repeated_s;
  std::ranges::set_difference(time_s, changed_s, std::back_inserter(repeated_s));
  if (repeated_s.size() < kFewest) return counted(changed_s.size());
  const double every_s = clock_period_s(repeated_s, usual_interval(repeated_s), true);
  if (!(every_s > kFewestRows * row_s)) return counted(changed_s.size());
  const double about_s = every_s * row_s / (every_s - row_s);
  std::vector<double> some_s;
  const std::size_t step = std::max<std::size_t>(changed_s.size() / kLooked, 1);
  for (std::size_t i = 0; i < changed_s.size(); i += step) some_s.push_back(changed_s[i]);
  const double finest_s = kReach * row_s * about_s / (changed_s.back() - changed_s.front()) / kSteps;
  double period_s = about_s;
  double empty_s = empty_part(some_s, about_s).length_s;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double tried_s = about_s + i * finest_s;
    const double length_s = empty_part(some_s, tried_s).length_s;
    if (!(length_s > empty_s)) continue;
    empty_s = length_s;
    period_s = tried_s;
  }
  const EmptyPart empty = empty_part(changed_s, period_s);
  std::vector<double> number;
  for (const double stamp_s : changed_s) {
    number.push_back(std::floor((stamp_s - changed_s.front() - empty.end_s + kRounding * row_s) / period_s));
  }
  const double first = number.front();
  for (double& one : number) one -= first;
  return number;
}

/// Whether no message changes the channel twice: rows of which some are lost and some repeat the one before by chance
/// have as many changes as messages of a period a little longer than a row would make.
bool once_each(const std::vector<double>& number) {
  std::size_t again = 0;
  for (std::size_t i = 1; i < number.size(); ++i) again += number[i] > number[i - 1] ? 0 : 1;
  return static_cast<double>(again) <= kBeyond * static_cast<double>(number.size());
}

std::optional<MessageClock> message_clock(const std::vector<double>& time_s, const std::vector<double>& values) {
  constexpr double kLonger = 1.02;     // rows
  constexpr double kNearlyTwo = 1.99;  // rows
  constexpr double kMostLate = 0.5;    // periods
  constexpr double kRows = 0.999;      // that a change is late by at most, where nothing makes it wait
  const NewValues found = new_values(values);
  if (found.row.size() <= kFewest ||
      kLonger * static_cast<double>(found.row.size() - 1) > static_cast<double>(values.size()))
    return std::nullopt;
  const std::vector<double> message(found.value.begin() + 1, found.value.end());  // when the first came is not known
  std::vector<double> changed_s;
  for (std::size_t i = 1; i < found.row.size(); ++i) changed_s.push_back(time_s[found.row[i]]);
  const double row_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const double usual_s = usual_interval(changed_s);
  const std::vector<double> number = usual_s < kNearlyTwo * row_s ? numbers_between_repeats(time_s, changed_s, row_s)
                                                                  : numbers_on_a_grid(changed_s, message, usual_s);
  if (!once_each(number)) return std::nullopt;
  double period_s = rounded_up_period(changed_s, number, row_s);
  Late late = late_against(period_s, changed_s, number);
  if (late.spread_s > kRows * row_s) {
    period_s = least_squares_line(number, changed_s).slope;  // a bus makes each wait, by itself
    late = late_against(period_s, changed_s, number);
    if (late.spread_s > kMostLate * period_s) return std::nullopt;
  }
  if (!(period_s > kLonger * row_s)) return std::nullopt;
  return MessageClock{late.earliest_s, period_s, (late.spread_s + period_s) / 2};
}

/// Whether most changes are by its smallest step: an angle that is rounded coarsely, at a rate that hardly changes.
bool counts(const std::vector<double>& messages) {
  constexpr double kBarelyMore = 1.5;  // steps
  std::vector<double> change;
  for (std::size_t i = 1; i < messages.size(); ++i) change.push_back(std::abs(messages[i] - messages[i - 1]));
  return quantile(std::move(change), 0.5) < kBarelyMore * smallest_step(messages);
}

/// Whether noise shows, and is not what it is made of: levels that are drawn are commanded.
bool has_a_sensors_noise(const std::vector<double>& messages) {
  constexpr double kMost = 0.3;  // of the rms
  const double noise = white_noise_deviation(messages);
  const double mean = std::reduce(messages.begin(), messages.end()) / static_cast<double>(messages.size());
  double squares = 0;
  for (const double one : messages) squares += (one - mean) * (one - mean);
  return noise > smallest_step(messages) && noise < kMost * std::sqrt(squares / static_cast<double>(messages.size()));
}

}  // namespace

MessageClocks message_clocks(const Stretch& stretch) {
  constexpr std::size_t kAngle = static_cast<std::size_t>(Channel::kAngle) - 1;
  MessageClocks clocks;
  const auto messages = [&](std::size_t c) { return messages_of(stretch, *clocks[c]).values[c]; };
  clocks[kAngle] = message_clock(stretch.time_s, stretch.values[kAngle]);
  if (clocks[kAngle] && counts(messages(kAngle))) clocks[kAngle].reset();
  const bool of_sensors = clocks[kAngle].has_value();
  for (std::size_t c = 0; c < clocks.size(); ++c) {
    if (c == kAngle) continue;
    clocks[c] = message_clock(stretch.time_s, stretch.values[c]);
    if (!clocks[c] || (of_sensors && !is_slow(*clocks[c]))) continue;
    if (!has_a_sensors_noise(messages(c))) clocks[c].reset();
  }
  return clocks;
}

bool is_slow(const MessageClock& clock) { return clock.period_s > 1.01 / kLowestRateHz; }

Stretch messages_of(const Stretch& stretch, const MessageClock& clock) {
  Stretch out;
  std::size_t row = 0;
  for (double m = 0;; ++m) {
    const double come_s = clock.first_s + m * clock.period_s;
    if (come_s + clock.wait_s > stretch.time_s.back() + kSameStampS) return out;
    while (row + 1 < stretch.time_s.size() && stretch.time_s[row + 1] <= come_s + clock.wait_s) ++row;
    out.time_s.push_back(come_s);
    for (std::size_t c = 0; c < out.values.size(); ++c) {
      if (!stretch.values[c].empty()) out.values[c].push_back(stretch.values[c][row]);
    }
  }
}

std::optional<MessageClock> clock_of_all(const Stretch& stretch, const MessageClocks& clocks) {
  constexpr double kSame = 0.01;  // periods
  std::optional<MessageClock> all;
  for (std::size_t c = 0; c < clocks.size(); ++c) {
    const std::vector<double>& values = stretch.values[c];
    if (std::ranges::adjacent_find(values, std::ranges::not_equal_to()) == values.end()) continue;
    if (!clocks[c]) return std::nullopt;
    if (!all) all = clocks[c];
    const double apart = (clocks[c]->first_s - all->first_s) / all->period_s;
    const double messages = (stretch.time_s.back() - all->first_s) / all->period_s;
    if (std::abs(apart - std::round(apart)) > kSame ||
        std::abs(clocks[c]->period_s / all->period_s - 1) * messages > kSame)
      return std::nullopt;
    if (clocks[c]->first_s > all->first_s) all = clocks[c];
  }
  return all;
}

}  // namespace steerid
