#include "gap/comparison.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "gap/hypotheses.hpp"
#include "gap/shrinkage.hpp"
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

/// The blocks that a hypothesis is fitted on. An instant can only be known from the time around it: an effect that
/// begins or ends at instants is fitted on the blocks that choose, too, and pays for it by its parameters alone.
const Whittle::Roles& roles_of(std::string_view id) {
  return id == "hands_off" || id == "time_varying_stiffness" ? kSeen : kFitted;
}

bool dry(std::string_view id) {
  return id == "coulomb_friction" || id == "stribeck_friction" || id == "asymmetric_friction";
}

/// The candidates that free runs may still change the order of: the best of the first stage that are approximations,
/// and all kinds of dry friction when one of them is among these, for they are told apart at rest.
std::vector<std::size_t> worth_simulating(const std::vector<Candidate>& all, const Hypotheses& library) {
  double best = std::numeric_limits<double>::infinity();
  for (const Candidate& one : all) {
    if (one.fit.excess(kFitted) > kImpossibleExcess) best = std::min(best, one.fit.excess(kFitted));
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
    const bool near_best = one.fit.excess(kFitted) < 1.15 * best + 15 * std::max(0.0, best - 1) + 0.3;
    if ((rank < kMost && near_best) || (friction && dry(one.id))) kept.push_back(chosen[rank]);
  }
  return kept;
}

constexpr double kFarWorse = 30;  // nats

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

/// The Coulomb friction in the middle of a richer kind. A simpler model that fits far worse than a richer one whose
/// additional numbers hardly matter has not found its optimum either.
Eigen::VectorXd coulomb_of(const EffectType& type, const Eigen::VectorXd& richer) {
  const auto own = static_cast<Eigen::Index>(type.parameters.size());
  Eigen::VectorXd x = richer.head(richer.size() - own + 1);
  if (type.id == "asymmetric_friction") x[x.size() - 1] = (richer[richer.size() - 2] + richer[richer.size() - 1]) / 2;
  return x;
}

constexpr double kLost = 1.8;  // an excess at which friction by free runs may have missed its optimum

/// Where sticking decides the motion, neighbouring optima are many. The simulation's own wheel with the friction that
/// fits best out of a wide range is near the right one.
Eigen::VectorXd scanned_friction(const ComparisonSetting& setting, ResidualModel& model, const Eigen::VectorXd& given,
                                 const std::vector<Fitted>& fitted) {
  constexpr double kSmallest = 0.02;  // shares of the applied torque
  constexpr double kLargest = 1.5;
  constexpr double kStep = 1.25;
  Eigen::VectorXd x(given.size() + 1);
  Eigen::VectorXd best = x;
  double least = std::numeric_limits<double>::infinity();
  for (double share = kSmallest; share < kLargest; share *= kStep) {
    x << given, share * setting.whittle.applied_rms_nm();
    const double cost = setting.whittle.judge(model, x, fitted, kFitted, SlowTorque::kFloor).cost(kFitted);
    if (!(cost < least)) continue;
    least = cost;
    best = x;
  }
  return best;
}

constexpr double kNothingLeft = 1e-3;

/// A torque that nobody measured has no course to run with, and an absence that was seen says little of the others.
bool runs_freely(std::string_view id) { return id != "unmeasured_torque" && id != "hands_off"; }

/// What the wheel alone and the few best leave to shapes without a name, and how the free runs of these err.
void note_what_is_left(const ComparisonSetting& setting, const Hypotheses& library, const SpectralModel::Parts& parts,
                       const std::vector<Effect>& fixed, Comparison& out) {
  const Eigen::VectorXd refit = out.at("parameters").fit.x;
  SimulatedModel alone(setting.record, types_of(parts), fixed);
  double reference = alone.rms_rad(refit, Block::Role::kChoose);
  if (parts.empty()) {
    reference = std::min(reference, alone.rms_rad(joined(setting.closest, {}), Block::Role::kChoose));
  }
  constexpr std::size_t kMost = 4;
  std::vector<std::size_t> order(out.candidates.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return out.candidates[a].fit.cost(kFitted) < out.candidates[b].fit.cost(kFitted);
  });
  order.resize(std::min(kMost, order.size()));
  if (std::ranges::find(order, 1U) == order.end()) order.push_back(1);
  work_in_parallel(order.size(), setting.threads, [&](std::size_t i) {
    Candidate& one = out.candidates[order[i]];
    if (one.id == "none") return;
    SpectralModel::Parts all = parts;
    if (const Hypothesis* hypothesis = hypothesis_of(library, one.type); hypothesis != nullptr) {
      all.push_back(hypothesis);
    }
    const std::vector<const EffectType*> types = types_of(all);
    const auto fitted = fitted_parameters(setting.sim, setting.refit, types);
    SpectralModel slopes(setting.record, all);
    SimulatedModel model(setting.record, types, fixed);
    // A closest wheel that hardly leaves more than noise leaves no gap to hold a run against.
    constexpr double kTold = 1.2;
    const double noise = std::pow(floor_rms_rad(one.fit.floor, wheel_of(one.fit.x), 0), 2);
    if (one.type != nullptr && runs_freely(one.id) && reference * reference > kTold * noise) {
      const double left = std::pow(model.rms_rad(one.fit.x, Block::Role::kChoose), 2) - noise;
      one.run_error = std::max(left / (reference * reference - noise), kNothingLeft);
    }
    if (one.simulated) {
      one.rivals = rivals_beyond(setting.record, setting.whittle, model, slopes, one.fit, fitted);
    } else {
      one.rivals = rivals_beyond(setting.record, setting.whittle, slopes, slopes, one.fit, fitted);
    }
  });
}

}  // namespace

std::optional<Effect> fitted_effect(const Candidate& candidate) {
  if (candidate.type == nullptr || candidate.type == &effect::unmeasured_torque) return std::nullopt;
  Effect effect(*candidate.type);
  std::copy(candidate.fit.x.end() - std::ssize(effect.values), candidate.fit.x.end(), effect.values.begin());
  return effect;
}

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
  const auto origins_on = [&](const Whittle::Roles& roles) {
    std::vector<SearchOrigin> origins;
    for (const Whittle::Fit* fit : {&parameters.fit, &none.fit}) {
      origins.push_back({LinearScan(setting.record, setting.whittle, parts, *fit, roles), fit->x});
    }
    return origins;
  };
  const std::vector<SearchOrigin> origins = origins_on(kFitted);
  const std::vector<SearchOrigin> origins_in_time = origins_on(roles_of("hands_off"));
  work_in_parallel(out.candidates.size() - first, setting.threads, [&](std::size_t i) {
    Candidate& one = out.candidates[first + i];
    const Whittle::Roles& roles = roles_of(one.id);
    one.fit = search(*hypothesis_of(library, one.type),
                     {setting.record, setting.whittle, roles.size() > 1 ? origins_in_time : origins, parts, setting.sim,
                      setting.refit, roles});
  });
  const std::vector<std::size_t> again = worth_simulating(out.candidates, library);
  const auto simulated_fit = [&](const EffectType& type, const Eigen::VectorXd& start, int budget = kSimulations) {
    std::vector<const EffectType*> types = types_of(parts);
    types.push_back(&type);
    SimulatedModel model(setting.record, types, fixed);
    SpectralModel::Parts all = parts;
    all.push_back(hypothesis_of(library, &type));
    SpectralModel slopes(setting.record, all);
    return setting.whittle.fit(model, start, fitted_parameters(setting.sim, setting.refit, types), roles_of(type.id),
                               SlowTorque::kFloor, budget, &slopes);
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
  const bool nested = coulomb != out.candidates.end() && coulomb->simulated;
  const auto offer_coulomb = [&](const Eigen::VectorXd& start) {
    Whittle::Fit fit = simulated_fit(*coulomb->type, start, 2 * kSimulations);
    const bool better = fit.cost(kFitted) < coulomb->fit.cost(kFitted);
    if (better) coulomb->fit = std::move(fit);
    return better;
  };
  if (nested && coulomb->fit.excess(kFitted) > kLost) {
    std::vector<const EffectType*> types = types_of(parts);
    types.push_back(coulomb->type);
    SimulatedModel model(setting.record, types, fixed);
    offer_coulomb(scanned_friction(setting, model, given, fitted_parameters(setting.sim, setting.refit, types)));
  }
  constexpr int kRounds = 3;
  int rounds = 0;
  for (bool again_better = nested; again_better;) {
    again_better = false;
    for (const std::size_t i : again) {
      const Candidate& richer = out.candidates[i];
      if (!dry(richer.id) || !(richer.fit.cost(kFitted) < coulomb->fit.cost(kFitted) - kFarWorse)) continue;
      if (offer_coulomb(coulomb_of(*richer.type, richer.fit.x))) again_better = true;
    }
    std::atomic<bool> improved = false;
    work_in_parallel(again.size(), setting.threads, [&](std::size_t i) {
      Candidate& one = out.candidates[again[i]];
      if (!dry(one.id) || !(one.fit.cost(kFitted) > coulomb->fit.cost(kFitted))) return;
      const double before = one.fit.cost(kFitted);
      one.fit = simulated_fit(*one.type, as_coulomb(*one.type, coulomb->fit.x));
      if (one.fit.cost(kFitted) < std::min(before, coulomb->fit.cost(kFitted) - kFarWorse)) improved = true;
    });
    again_better = again_better || improved;
    if (++rounds == kRounds) break;
  }
  note_what_is_left(setting, library, parts, fixed, out);
  return out;
}

}  // namespace steerid
