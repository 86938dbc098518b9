// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/catalogue.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace steerid::blind {
namespace {

std::vector<const Kind*> joined(std::initializer_list<std::span<const Kind>> families) {
  std::vector<const Kind*> all;
  for (const auto family : families) {
    for (const Kind& kind : family) all.push_back(&kind);
  }
  return all;
}

const Kind* find(std::span<const Kind* const> kinds, std::string_view id) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind* kind) { return kind->id == id; });
  return found == kinds.end() ? nullptr : *found;
}

}  // namespace

std::span<const Kind* const> vocabulary() {
  static const auto kAll = joined({friction_kinds(), joint_kinds(), torque_kinds(), record_kinds()});
  return kAll;
}

std::span<const Kind* const> outside() {
  static const auto kAll = joined({outside_plant_kinds(), outside_sensor_kinds()});
  return kAll;
}

const Kind& kind_called(std::string_view id) {
  const Kind* kind = find(vocabulary(), id);
  if (kind == nullptr) kind = find(outside(), id);
  if (kind == nullptr) throw std::invalid_argument("the blind generator knows no effect " + std::string(id));
  return *kind;
}

bool is_known(std::string_view id) { return find(vocabulary(), id) != nullptr; }

}  // namespace steerid::blind
