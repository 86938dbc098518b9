// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "report/uncertainty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace steerid::report {
namespace {

constexpr const char* kDash = "\u2013";
constexpr int kDecimalsMost = 12;

/// The power of ten of the first digit once `value` is rounded to so many significant digits: 0.0996 to one is 0.1.
int exponent(double value, int significant) {
  const int raw = static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double scale = std::pow(10.0, significant - 1 - raw);
  return std::round(std::abs(value) * scale) >= std::pow(10.0, significant) ? raw + 1 : raw;
}

/// `value` rounded at 10^-decimals; negative decimals round before the point.
std::string at_decimals(double value, int decimals) {
  if (decimals < 0) {
    const double step = std::pow(10.0, -decimals);
    return fmt::format("{:.0f}", std::round(value / step) * step);
  }
  return fmt::format("{:.{}f}", value, std::min(decimals, kDecimalsMost));
}

/// A hyphen before a number is a minus sign.
std::string signed_text(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "\u2212");
  return text;
}

}  // namespace

std::string in_digits(double value, int significant) {
  if (!std::isfinite(value)) return kDash;
  if (value == 0) return "0";
  return signed_text(at_decimals(value, significant - 1 - exponent(value, significant)));
}

std::string in_interval(double low, double high, int significant) {
  if (low == high) return in_digits(low, significant);
  constexpr int kMost = 12;
  while (significant < kMost && in_digits(low, significant) == in_digits(high, significant)) {
    ++significant;
  }
  return fmt::format("{} to {}", in_digits(low, significant), in_digits(high, significant));
}

int decimals_apart(std::span<const double> edges) {
  std::vector<double> sorted(edges.begin(), edges.end());
  std::ranges::sort(sorted);
  double narrowest = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double width = sorted[i] - sorted[i - 1];
    if (width > 0 && (narrowest == 0 || width < narrowest)) narrowest = width;
  }
  constexpr double kShare = 0.2;
  int decimals = 0;
  const auto moved = [&](double edge) {
    const double scale = std::pow(10.0, decimals);
    return std::abs(std::round(edge * scale) / scale - edge) > kShare * narrowest;
  };
  while (narrowest > 0 && decimals < kDecimalsMost && std::ranges::any_of(sorted, moved)) ++decimals;
  return decimals;
}

std::string in_decimals(double value, int decimals) {
  if (!std::isfinite(value)) return kDash;
  std::string text = at_decimals(value, decimals);
  if (text.find_first_of("123456789") == std::string::npos && text.starts_with('-')) text.erase(0, 1);
  return signed_text(std::move(text));
}

std::string with_interval(double value, const Ends& ends) {
  const bool known = std::isfinite(value) && std::isfinite(ends.low) && std::isfinite(ends.high);
  if (!known || !(ends.high > ends.low)) return in_digits(value, 3);
  const int decimals = 1 - exponent(ends.high - ends.low, 2);
  const auto in = [&](double one) { return signed_text(at_decimals(one, decimals)); };
  return fmt::format("{} ({} to {})", in(value), in(ends.low), in(ends.high));
}

Written written(double value, double sd) {
  if (!std::isfinite(value)) return {kDash, ""};
  if (!std::isfinite(sd) || sd <= 0) return {in_digits(value), ""};
  const int decimals = 1 - exponent(sd, 2);
  return {signed_text(at_decimals(value, decimals)), at_decimals(sd, decimals)};
}

std::string with_sd(double value, double sd) {
  const Written text = written(value, sd);
  return text.sd.empty() ? text.value : text.value + " \u00b1 " + text.sd;
}

}  // namespace steerid::report
