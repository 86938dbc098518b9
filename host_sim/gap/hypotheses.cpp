#include "gap/hypotheses.hpp"

#include <algorithm>

namespace steerid {

std::vector<std::unique_ptr<Hypothesis>> hypotheses() {
  Hypotheses all;
  add_friction_hypotheses(all);
  add_spring_hypotheses(all);
  add_time_hypotheses(all);
  add_response_hypotheses(all);
  add_hands_off_hypothesis(all);
  return all;
}

const Hypothesis* hypothesis_of(const EffectType& type) {
  static const Hypotheses all = hypotheses();
  const auto found = std::ranges::find_if(all, [&](const auto& one) { return &one->type() == &type; });
  return found == all.end() ? nullptr : found->get();
}

std::vector<const Hypothesis*> parts_of(const std::vector<const EffectType*>& types) {
  std::vector<const Hypothesis*> parts;
  for (const EffectType* type : types) parts.push_back(hypothesis_of(*type));
  return parts;
}

}  // namespace steerid
