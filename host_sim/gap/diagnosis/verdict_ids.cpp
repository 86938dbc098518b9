// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/verdict_ids.hpp"

#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {

const std::vector<std::string>& verdict_ids() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> all = {"none", "parameters"};
    for (const EffectType* type : effects()) all.emplace_back(type->id);
    all.emplace_back("unknown");
    return all;
  }();
  return ids;
}

bool names_effect(std::string_view id) { return id != "none" && id != "parameters" && id != "unknown"; }

}  // namespace steerid::gap
