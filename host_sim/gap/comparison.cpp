#include "gap/comparison.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "gap/hypotheses.hpp"
#include "gap/simulated_model.hpp"
#include "gap/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

const Whittle::Roles kFitted = {Block::Role::kFit};
constexpr int kSimulations = 30;  // evaluations of a fit by free runs

Eigen::VectorXd joined(const WheelArm& wheel, const std::vector<Effect>& effects) {
  std::vector<double> x = {wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad};
  for (const Effect& effect : effects) x.insert(x.end(), effect.values.begin(), effect.values.end());
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

const Hypothesis* hypothesis_of(const Hypotheses& all, const EffectType* type) {
  const auto found = std::ranges::find_if(all, [&](const auto& one) { return &one->type() == type; });
  return found == all.end() ? nullptr : found->get();
}

bool among(const std::vector<std::string>& ids, std::string_view id) { return std::ranges::find(ids, id) != ids.end(); }

/// Torques that do not depend on the motion: the first stage is exact for them.
bool exact_at_once(const Hypothesis& hypothesis) {
  constexpr std::array<std::string_view, 3> kKnown = {"torque_bias", "torque_drift", "periodic_disturbance"};
  return !hypothesis.acts() || std::ranges::find(kKnown, hypothesis.type().id) != kKnown.end();
}

bool dry(std::string_view id) {
  return id == "coulomb_friction" || id == "stribeck_friction" || id == "asymmetric_friction";
}

/// The candidates that free runs may still change the order of: the best of the first stage that are approximations,
/// and all kinds of dry friction when one of them is among these, for they are told apart at rest.
std::vector<std::size_t> worth_simulating(const std::vector<Candidate>& all, const Hypotheses& library) {
  double best_exact = std::numeric_limits<double>::infinity();
  double best = std::numeric_limits<double>::infinity();
  for (const Candidate& one : all) {
    const Hypothesis* hypothesis = hypothesis_of(library, one.type);
    const double excess = one.fit.excess(kFitted);
    best = std::min(best, excess);
    if (hypothesis == nullptr || exact_at_once(*hypothesis)) best_exact = std::min(best_exact, excess);
  }
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Hypothesis* hypothesis = hypothesis_of(library, all[i].type);
    if (hypothesis != nullptr && !exact_at_once(*hypothesis)) chosen.push_back(i);
  }
  std::ranges::sort(chosen,
                    [&](std::size_t a, std::size_t b) { return all[a].fit.cost(kFitted) < all[b].fit.cost(kFitted); });
  constexpr std::size_t kMost = 4;
  const bool friction =
      std::ranges::any_of(chosen.begin(), chosen.begin() + std::min<std::ptrdiff_t>(3, std::ssize(chosen)),
                          [&](std::size_t i) { return dry(all[i].id); });
  std::vector<std::size_t> kept;
  for (std::size_t rank = 0; rank < chosen.size(); ++rank) {
    const Candidate& one = all[chosen[rank]];
    const bool near_best = one.fit.excess(kFitted) < 1.15 * best + 15 * (best - 1) + 0.3;
    if ((rank < kMost && near_best) || (friction && dry(one.id))) kept.push_back(chosen[rank]);
  }
  return kept;
}

/// The parameters at which a kind of dry friction is Coulomb's. A richer model that fits worse than what it contains
/// has not found its optimum.
Eigen::VectorXd as_coulomb(const EffectType& type, const Eigen::VectorXd& coulomb) {
  const double friction = coulomb[coulomb.size() - 1];
  Effect effect(type);
  if (type.id == "stribeck_friction") {
    effect.at("breakaway_ratio") = 1;
    effect.at("friction_nm") = friction;
  } else {
    effect.at("friction_forward_nm") = friction;
    effect.at("friction_backward_nm") = friction;
  }
  Eigen::VectorXd x(coulomb.size() - 1 + static_cast<Eigen::Index>(effect.values.size()));
  x << coulomb.head(coulomb.size() - 1),
      Eigen::Map<const Eigen::VectorXd>(effect.values.data(), static_cast<Eigen::Index>(effect.values.size()));
  return x;
}

}  // namespace

const Candidate& Comparison::at(std::string_view id) const {
  for (const Candidate& one : candidates) {
    if (one.id == id) return one;
  }
  throw std::logic_error("no such candidate");
}

Comparison compare(const ComparisonSetting& setting) {
  const Hypotheses library = hypotheses();
  SpectralModel::Parts parts;
  std::vector<Effect> present;
  std::vector<Effect> fixed;
  for (const Effect& effect : setting.present) {
    const Hypothesis* hypothesis = hypothesis_of(library, effect.type);
    if (hypothesis != nullptr) {
      parts.push_back(hypothesis);
      present.push_back(effect);
    } else {
      fixed.push_back(effect);
    }
  }
  Comparison out;
  out.fixed = fixed;
  // The wheel as it is, and refitted.
  const auto fitted = fitted_parameters(setting.sim, setting.refit, types_of(parts));
  SpectralModel base(setting.record, parts);
  const Eigen::VectorXd given = joined(setting.sim, present);
  Candidate none{"none", nullptr, setting.whittle.judge(base, given, fitted, kFitted, SlowTorque::kFloor)};
  Candidate parameters{"parameters", nullptr, {}};
  double best = std::numeric_limits<double>::infinity();
  for (const WheelArm& start : {setting.sim, setting.refit}) {
    Whittle::Fit fit = setting.whittle.fit(base, joined(start, present), fitted, kFitted, SlowTorque::kFloor, 200);
    if (fit.cost(kFitted) < best) {
      best = fit.cost(kFitted);
      parameters.fit = std::move(fit);
    }
  }
  const Eigen::VectorXd from = parameters.fit.x;
  out.candidates = {none, parameters};
  if (!among(setting.without, "unmeasured_torque")) {
    Candidate slow{"unmeasured_torque", &effect::unmeasured_torque, {}};
    slow.fit = setting.whittle.fit(base, from, fitted, kFitted, SlowTorque::kCause, 60);
    out.candidates.push_back(slow);
  }
  const std::size_t first = out.candidates.size();
  for (const auto& hypothesis : library) {
    const std::string id(hypothesis->type().id);
    const bool there = std::ranges::any_of(present, [&](const Effect& one) { return one.type == &hypothesis->type(); });
    if (there || among(setting.without, id)) continue;
    try {
      std::vector<Effect> together = present;
      together.emplace_back(hypothesis->type());
      check_compatible(together);
    } catch (const std::exception&) {
      continue;
    }
    out.candidates.push_back({id, &hypothesis->type(), {}});
  }
  const LinearScan scan(setting.record, setting.whittle, parts, parameters.fit, kFitted);
  work_in_parallel(out.candidates.size() - first, setting.threads, [&](std::size_t i) {
    Candidate& one = out.candidates[first + i];
    one.fit = search(*hypothesis_of(library, one.type),
                     {setting.record, setting.whittle, scan, parts, from, setting.sim, kFitted});
  });
  if (!setting.thorough) return out;
  const std::vector<std::size_t> again = worth_simulating(out.candidates, library);
  const auto simulated_fit = [&](const EffectType& type, const Eigen::VectorXd& start) {
    std::vector<const EffectType*> types = types_of(parts);
    types.push_back(&type);
    SimulatedModel model(setting.record, types, fixed);
    SpectralModel::Parts all = parts;
    all.push_back(hypothesis_of(library, &type));
    SpectralModel slopes(setting.record, all);
    return setting.whittle.fit(model, start, fitted_parameters(setting.sim, setting.refit, types), kFitted,
                               SlowTorque::kFloor, kSimulations, &slopes);
  };
  work_in_parallel(again.size(), setting.threads, [&](std::size_t i) {
    Candidate& one = out.candidates[again[i]];
    Whittle::Fit fit = simulated_fit(*one.type, one.fit.x);
    // A hand that leaves is found by its windows; where they are uncertain the first stage may be the better judge.
    if (one.id == "hands_off" && fit.cost(kFitted) > one.fit.cost(kFitted)) return;
    one.fit = std::move(fit);
    one.simulated = true;
  });
  const auto coulomb = std::ranges::find(out.candidates, "coulomb_friction", &Candidate::id);
  if (coulomb == out.candidates.end() || !coulomb->simulated) return out;
  work_in_parallel(again.size(), setting.threads, [&](std::size_t i) {
    Candidate& one = out.candidates[again[i]];
    if (!dry(one.id) || !(one.fit.cost(kFitted) > coulomb->fit.cost(kFitted))) return;
    one.fit = simulated_fit(*one.type, as_coulomb(*one.type, coulomb->fit.x));
  });
  return out;
}

}  // namespace steerid
