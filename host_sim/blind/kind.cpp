// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/kind.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace steerid::blind {

double& Numbers::at(std::string_view name) {
  for (auto& [key, value] : all_) {
    if (key == name) return value;
  }
  throw std::logic_error("there is no number " + std::string(name));
}

double Numbers::operator[](std::string_view name) const { return const_cast<Numbers*>(this)->at(name); }

namespace {

/// The factor nearest to the wanted one that leaves this number within what is physical.
double physical(const Size& size, double value, double factor) {
  // Both signs of a distance from the origin are physical; the limits are of its magnitude.
  const double now = std::abs(value - size.origin);
  const double magnitude = std::clamp(size.weaker_when_larger ? now / factor : now * factor, size.low, size.high);
  return size.weaker_when_larger ? now / magnitude : magnitude / now;
}

}  // namespace

Numbers scaled(const Kind& kind, const Numbers& numbers, double factor) {
  // One factor for all sizes: friction that differs between the directions would become the same both ways at its cap.
  std::optional<double> together;
  for (const Size& size : kind.sizes) {
    const double own = physical(size, numbers[size.name], factor);
    together = !together ? own : factor > 1 ? std::min(*together, own) : std::max(*together, own);
  }
  Numbers out = numbers;
  for (const Size& size : kind.sizes) {
    double& value = out.at(size.name);
    const double distance = value - size.origin;
    value = size.origin + (size.weaker_when_larger ? distance / *together : distance * *together);
  }
  return out;
}

}  // namespace steerid::blind
