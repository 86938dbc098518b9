// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/time_text.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

#include "log/text.hpp"

namespace steerid {
namespace {

/// What is left of a text while it is read from its front.
class Rest {
 public:
  explicit Rest(std::string_view text) : text_(text) {}

  [[nodiscard]] bool empty() const { return text_.empty(); }

  bool take(char c) {
    if (!text_.starts_with(c)) return false;
    text_.remove_prefix(1);
    return true;
  }

  /// A whole number of `least` to `most` digits.
  std::optional<int> digits(std::size_t least, std::size_t most) {
    std::size_t count = 0;
    int value = 0;
    while (count < most && count < text_.size() && text_[count] >= '0' && text_[count] <= '9') {
      value = 10 * value + (text_[count++] - '0');
    }
    if (count < least) return std::nullopt;
    text_.remove_prefix(count);
    return value;
  }

  /// The digits after the point, as a part of one.
  double fraction() {
    double value = 0;
    double place = 1;
    while (!text_.empty() && text_.front() >= '0' && text_.front() <= '9') {
      value = 10 * value + (text_.front() - '0');
      place *= 10;
      text_.remove_prefix(1);
    }
    return value / place;
  }

  std::optional<int> month_name() {
    constexpr std::array<std::string_view, 12> kMonths = {"jan", "feb", "mar", "apr", "may", "jun",
                                                          "jul", "aug", "sep", "oct", "nov", "dec"};
    for (std::size_t i = 0; i < kMonths.size(); ++i) {
      if (!equal_ignoring_case(text_.substr(0, 3), kMonths[i])) continue;
      text_.remove_prefix(3);
      return static_cast<int>(i) + 1;
    }
    return std::nullopt;
  }

 private:
  std::string_view text_;
};

std::optional<double> seconds_of_date(const std::optional<int>& year, const std::optional<int>& month,
                                      const std::optional<int>& day) {
  if (!year || !month || !day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

std::optional<double> year_first(Rest& rest) {
  const auto year = rest.digits(4, 4);
  const bool slash = rest.take('/');
  if (!slash && !rest.take('-')) return std::nullopt;
  const auto month = rest.digits(1, 2);
  if (!rest.take(slash ? '/' : '-')) return std::nullopt;
  return seconds_of_date(year, month, rest.digits(1, 2));
}

std::optional<double> day_first(Rest& rest) {
  const auto day = rest.digits(1, 2);
  const bool dots = rest.take('.');
  if (!dots && !rest.take('-')) return std::nullopt;
  const auto month = dots ? rest.digits(1, 2) : rest.month_name();
  if (!rest.take(dots ? '.' : '-')) return std::nullopt;
  return seconds_of_date(rest.digits(4, 4), month, day);
}

std::optional<double> time_of_day(Rest& rest) {
  const auto hour = rest.digits(1, 2);
  if (!hour || *hour > 24 || !rest.take(':')) return std::nullopt;
  const auto minute = rest.digits(2, 2);
  if (!minute || *minute > 59) return std::nullopt;
  double seconds = 3600.0 * *hour + 60.0 * *minute;
  if (!rest.take(':')) return seconds;
  const auto second = rest.digits(2, 2);
  if (!second || *second > 60) return std::nullopt;
  seconds += *second;
  if (rest.take('.') || rest.take(',')) seconds += rest.fraction();
  return seconds;
}

/// What is to be taken off for the zone behind the time.
std::optional<double> zone(Rest& rest) {
  rest.take(' ');
  if (rest.empty() || rest.take('Z') || rest.take('z')) return 0.0;
  const bool west = rest.take('-');
  if (!west && !rest.take('+')) return std::nullopt;
  const auto hours = rest.digits(2, 2);
  rest.take(':');
  const int minutes = rest.digits(2, 2).value_or(0);
  if (!hours) return std::nullopt;
  return (west ? -1.0 : 1.0) * (3600.0 * *hours + 60.0 * minutes);
}

std::optional<double> clock_time(Rest rest, double days_s) {
  const auto day_s = time_of_day(rest);
  const auto east_s = day_s ? zone(rest) : std::nullopt;
  if (!east_s || !rest.empty()) return std::nullopt;
  return days_s + (*day_s - *east_s);
}

std::optional<double> duration(std::string_view text) {
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  const std::string_view unit = trimmed(text.substr(blank));
  if (unit != "sec" && unit != "s") return std::nullopt;
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + blank, value);
  if (error != std::errc() || stop != text.data() + blank || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> seconds_of(std::string_view text) {
  text = trimmed(text);
  if (text.find(':') == std::string_view::npos) return duration(text);
  if (const auto of_day = clock_time(Rest(text), 0)) return of_day;
  for (const auto read_date : {year_first, day_first}) {
    Rest rest(text);
    const auto date_s = read_date(rest);
    if (!date_s || (!rest.take('T') && !rest.take(' '))) continue;
    while (rest.take(' ')) continue;
    return clock_time(rest, *date_s);
  }
  return std::nullopt;
}

}  // namespace steerid
