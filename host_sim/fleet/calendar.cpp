// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/calendar.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>

namespace steerid::fleet {
namespace {

/// Takes `digits` digits and then `end` (0: nothing) off the front of `text`.
std::optional<int> take(std::string_view& text, std::size_t digits, char end) {
  int value = 0;
  if (text.size() < digits) return std::nullopt;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + digits, value);
  if (error != std::errc{} || stop != text.data() + digits || value < 0) return std::nullopt;
  text.remove_prefix(digits);
  if (end == 0) return value;
  if (text.empty() || text.front() != end) return std::nullopt;
  text.remove_prefix(1);
  return value;
}

/// Of "13:45", "13:45:30" or either with a Z.
std::optional<double> part_of_day(std::string_view text) {
  if (text.ends_with('Z')) text.remove_suffix(1);
  const auto hour = take(text, 2, ':');
  const auto minute = hour ? take(text, 2, 0) : std::nullopt;
  if (!minute || *hour > 23 || *minute > 59) return std::nullopt;
  int second = 0;
  if (!text.empty()) {
    if (text.front() != ':') return std::nullopt;
    text.remove_prefix(1);
    const auto given = take(text, 2, 0);
    if (!given || *given > 60 || !text.empty()) return std::nullopt;
    second = *given;
  }
  return (3600.0 * *hour + 60.0 * *minute + second) / 86400.0;
}

}  // namespace

std::optional<double> days_of(std::string_view iso_8601) {
  std::string_view rest = iso_8601;
  const auto year = take(rest, 4, '-');
  const auto month = year ? take(rest, 2, '-') : std::nullopt;
  const auto day = month ? take(rest, 2, 0) : std::nullopt;
  if (!day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year}, std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok()) return std::nullopt;
  const auto days = static_cast<double>(std::chrono::sys_days{date}.time_since_epoch().count());
  if (rest.empty()) return days;
  if (rest.front() != 'T' && rest.front() != ' ') return std::nullopt;
  rest.remove_prefix(1);
  const auto part = part_of_day(rest);
  if (!part) return std::nullopt;
  return days + *part;
}

std::string date_of(double days) {
  const std::chrono::year_month_day date{std::chrono::sys_days{std::chrono::days{static_cast<int>(std::floor(days))}}};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

}  // namespace steerid::fleet
