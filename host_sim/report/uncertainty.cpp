// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "report/uncertainty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  constexpr int kMost = 12;
  while (low != high && significant < kMost && in_digits(low, significant) == in_digits(high, significant)) {
    ++significant;
  }
  return fmt::format("{} to {}", in_digits(low, significant), in_digits(high, significant));
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
