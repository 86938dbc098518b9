// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/unavailable_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "log/quantile.hpp"

namespace steerid {
namespace {

constexpr std::size_t kMostOf = 3;
constexpr std::size_t kFewestOthers = 100;

/// Whether anything is farther from what most of a channel reads than any torque or angle is looked at for.
bool any_far(const std::vector<double>& values) {
  constexpr std::size_t kLooked = 1000;
  constexpr double kAny = 1.5;
  std::vector<double> some;
  const std::size_t every = std::max<std::size_t>(values.size() / kLooked, 1);
  for (std::size_t i = 0; i < values.size(); i += every) {
    if (!std::isnan(values[i])) some.push_back(values[i]);
  }
  if (some.size() < kFewestOthers) return true;
  const double low = quantile(some, 0.3);  // that many rows may be unavailable
  const double high = quantile(some, 0.7);
  const double reach = kAny * (high - low);
  return std::ranges::any_of(values, [&](double x) { return x > high + reach || x < low - reach; });
}

/// Different values in ascending order, each with how often it is read.
struct Readings {
  std::vector<double> value{};
  std::vector<std::size_t> rows{};

  explicit Readings(std::vector<double> all) {
    std::erase_if(all, [](double x) { return std::isnan(x); });
    std::ranges::sort(all);
    for (const double x : all) {
      if (value.empty() || x != value.back()) {
        value.push_back(x);
        rows.push_back(0);
      }
      ++rows.back();
    }
  }
};

/// How many of the largest values of [begin, end), or of the smallest, are far from the others.
std::size_t far_ones(const Readings& all, std::size_t begin, std::size_t end, bool upper, bool angle) {
  const double far = angle ? 2 : 10;
  const double least = angle ? std::numbers::pi : 0;
  for (std::size_t count = 1; count <= kMostOf && end - begin >= count + kFewestOthers; ++count) {
    const std::size_t outer = upper ? end - count : begin + count - 1;  // the nearest of them to the others
    const std::size_t inner = upper ? outer - 1 : outer + 1;
    if (all.rows[outer] < 2) return 0;
    const double others = upper ? all.value[inner] - all.value[begin] : all.value[end - 1] - all.value[inner];
    if (std::abs(all.value[outer] - all.value[inner]) > std::max(far * others, least)) return count;
  }
  return 0;
}

}  // namespace

UnavailableValues leave_out_unavailable(std::vector<double>& values, Channel channel) {
  UnavailableValues out;
  if (!any_far(values)) return out;
  const Readings all(values);
  std::size_t begin = 0;
  std::size_t end = all.value.size();
  const bool angle = channel == Channel::kAngle;
  for (bool found = true; found;) {  // what is at one end hides what is at the other
    found = false;
    for (const bool upper : {true, false}) {
      const std::size_t count = far_ones(all, begin, end, upper, angle);
      found = found || count > 0;
      (upper ? end : begin) = upper ? end - count : begin + count;
    }
  }
  for (std::size_t i = 0; i < all.value.size(); ++i) {
    if (i >= begin && i < end) continue;
    out.value.push_back(all.value[i]);
    out.rows += all.rows[i];
  }
  if (out.rows == 0) return out;
  for (double& x : values) {
    if (std::ranges::find(out.value, x) != out.value.end()) x = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

}  // namespace steerid
