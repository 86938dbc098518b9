// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/hypotheses/hypotheses.hpp"

#include <algorithm>

namespace steerid::gap {

namespace {

Hypotheses made() {
  Hypotheses all;
  add_friction_hypotheses(all);
  add_spring_hypotheses(all);
  add_time_hypotheses(all);
  add_response_hypotheses(all);
  add_hands_off_hypothesis(all);
  return all;
}

}  // namespace

const std::vector<std::unique_ptr<Hypothesis>>& hypotheses() {
  static const Hypotheses all = made();
  return all;
}

const Hypothesis* hypothesis_called(std::string_view id) {
  const auto found = std::ranges::find_if(hypotheses(), [&](const auto& one) { return one->type().id == id; });
  return found == hypotheses().end() ? nullptr : found->get();
}

const Hypothesis* hypothesis_of(const EffectType& type) { return hypothesis_called(type.id); }

}  // namespace steerid::gap
