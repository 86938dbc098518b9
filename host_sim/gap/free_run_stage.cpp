#include "gap/free_run_stage.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "gap/shrinkage.hpp"
#include "gap/simulated_model.hpp"
#include "gap/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

const Whittle::Roles kFitted = {Block::Role::kFit};
constexpr int kSimulations = 30;  // evaluations of a fit by free runs

/// Torques that do not depend on the motion: the first stage is exact for them.
bool exact_at_once(const Hypothesis& hypothesis) {
  constexpr std::array<std::string_view, 3> kKnown = {"torque_bias", "torque_drift", "periodic_disturbance"};
  return !hypothesis.acts() || std::ranges::find(kKnown, hypothesis.type().id) != kKnown.end();
}

bool exact_at_once(const Candidate& candidate, const ComparedParts& there) {
  const Hypothesis* hypothesis = there.of(candidate.type);
  // A slow torque is no hypothesis of its own: it is exact beside others that are. The plain wheel is, too.
  const bool own = hypothesis == nullptr || exact_at_once(*hypothesis);
  return own && there.all_exact();
}

bool dry(std::string_view id) {
  return id == "coulomb_friction" || id == "stribeck_friction" || id == "asymmetric_friction";
}

/// The candidates that free runs may still change the order of: the best of the first stage that are approximations,
/// and all kinds of dry friction when one of them is among these, for they are told apart at rest.
std::vector<std::size_t> worth_simulating(const std::vector<Candidate>& all, const ComparedParts& there) {
  double best = std::numeric_limits<double>::infinity();
  for (const Candidate& one : all) {
    if (one.type == nullptr && !there.parts.empty()) continue;
    if (one.fit.excess(kFitted) > kImpossibleExcess) best = std::min(best, one.fit.excess(kFitted));
  }
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].type != nullptr && !exact_at_once(all[i], there)) chosen.push_back(i);
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

/// Fits of one comparison by free runs.
class FreeRunStage {
 public:
  FreeRunStage(const ComparisonSetting& setting, const ComparedParts& there, std::vector<Candidate>& candidates)
      : setting_(setting),
        there_(there),
        candidates_(candidates),
        chosen_(worth_simulating(candidates, there)),
        coulomb_(std::ranges::find(candidates, "coulomb_friction", &Candidate::id)) {}

  void run() {
    work_in_parallel(chosen_.size(), setting_.threads, [&](std::size_t i) {
      Candidate& one = candidates_[chosen_[i]];
      // Instants move in small steps: what happens after them follows them closely.
      Whittle::Fit fit = fitted(one, one.fit.x, one.id == "hands_off" ? 3 * kSimulations : kSimulations);
      // A hand that leaves is found by its windows; where they are uncertain the first stage may be the better judge.
      if (one.id == "hands_off" && fit.cost(kFitted) > one.fit.cost(kFitted)) return;
      one.fit = std::move(fit);
      one.simulated = true;
    });
    if (coulomb_ == candidates_.end() || !coulomb_->simulated) return;
    if (setting_.base) return;  // beside an effect that is fitted already, friction begins near enough
    if (coulomb_->fit.excess(kFitted) > kLost) offer_coulomb(scanned_friction());
    agree_on_friction();
  }

 private:
  [[nodiscard]] Whittle::Fit fitted(const Candidate& one, const Eigen::VectorXd& start,
                                    int budget = kSimulations) const {
    const std::vector<const EffectType*> types = types_of(there_.with(one.type));
    SimulatedModel model(setting_.record, types, there_.fixed);
    SpectralModel slopes(setting_.record, there_.with(one.type));
    const SlowTorque slow = one.type == &effect::unmeasured_torque ? SlowTorque::kCause : setting_.slow;
    return setting_.whittle.fit(model, start, fitted_parameters(setting_.sim, setting_.refit, types),
                                roles_of(one.id, there_), slow, budget, &slopes);
  }

  bool offer_coulomb(const Eigen::VectorXd& start) {
    Whittle::Fit fit = fitted(*coulomb_, start, 2 * kSimulations);
    const bool better = fit.cost(kFitted) < coulomb_->fit.cost(kFitted);
    if (better) coulomb_->fit = std::move(fit);
    return better;
  }

  /// Where sticking decides the motion, neighbouring optima are many. The simulation's own wheel with the friction that
  /// fits best out of a wide range is near the right one.
  [[nodiscard]] Eigen::VectorXd scanned_friction() const {
    constexpr double kSmallest = 0.02;  // shares of the applied torque
    constexpr double kLargest = 1.5;
    constexpr double kStep = 1.25;
    const std::vector<const EffectType*> types = types_of(there_.with(coulomb_->type));
    SimulatedModel model(setting_.record, types, there_.fixed);
    const std::vector<Fitted> fitted = fitted_parameters(setting_.sim, setting_.refit, types);
    const Eigen::VectorXd given = joined(setting_.sim, there_.present);
    Eigen::VectorXd x(given.size() + 1);
    Eigen::VectorXd best = x;
    double least = std::numeric_limits<double>::infinity();
    for (double share = kSmallest; share < kLargest; share *= kStep) {
      x << given, share * setting_.whittle.applied_rms_nm();
      const double cost = setting_.whittle.judge(model, x, fitted, kFitted, setting_.slow).cost(kFitted);
      if (!(cost < least)) continue;
      least = cost;
      best = x;
    }
    return best;
  }

  /// The kinds of dry friction begin from each other until neither gains.
  void agree_on_friction() {
    constexpr int kRounds = 3;
    bool again = true;
    for (int round = 0; round < kRounds && again; ++round) {
      again = false;
      for (const std::size_t i : chosen_) {
        const Candidate& richer = candidates_[i];
        if (!dry(richer.id) || !(richer.fit.cost(kFitted) < coulomb_->fit.cost(kFitted) - kFarWorse)) continue;
        if (offer_coulomb(coulomb_of(*richer.type, richer.fit.x))) again = true;
      }
      std::atomic<bool> improved = false;
      work_in_parallel(chosen_.size(), setting_.threads, [&](std::size_t i) {
        Candidate& one = candidates_[chosen_[i]];
        if (!dry(one.id) || !(one.fit.cost(kFitted) > coulomb_->fit.cost(kFitted))) return;
        const double before = one.fit.cost(kFitted);
        one.fit = fitted(one, as_coulomb(*one.type, coulomb_->fit.x));
        if (one.fit.cost(kFitted) < std::min(before, coulomb_->fit.cost(kFitted) - kFarWorse)) improved = true;
      });
      again = again || improved;
    }
  }

  const ComparisonSetting& setting_;
  const ComparedParts& there_;
  std::vector<Candidate>& candidates_;
  std::vector<std::size_t> chosen_;
  std::vector<Candidate>::iterator coulomb_;
};

constexpr double kNothingLeft = 1e-3;
constexpr double kUsualSlow = 0.02;  // share of the applied torque

/// A torque that nobody measured has no course to run with, and an absence that was seen says little of the others.
bool runs_freely(std::string_view id) { return id != "unmeasured_torque" && id != "hands_off"; }

}  // namespace

const Hypothesis* ComparedParts::of(const EffectType* type) const {
  const auto found = std::ranges::find_if(library, [&](const auto& one) { return &one->type() == type; });
  return found == library.end() ? nullptr : found->get();
}

SpectralModel::Parts ComparedParts::with(const EffectType* type) const {
  SpectralModel::Parts all = parts;
  if (const Hypothesis* hypothesis = of(type); hypothesis != nullptr) all.push_back(hypothesis);
  return all;
}

bool ComparedParts::all_exact() const {
  return std::ranges::all_of(parts, [](const Hypothesis* part) { return exact_at_once(*part); });
}

Eigen::VectorXd joined(const WheelArm& wheel, const std::vector<Effect>& effects) {
  std::vector<double> x = {wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad};
  for (const Effect& effect : effects) x.insert(x.end(), effect.values.begin(), effect.values.end());
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

const Whittle::Roles& roles_of(std::string_view id, const ComparedParts& there) {
  const auto timed = [](std::string_view one) { return one == "hands_off" || one == "time_varying_stiffness"; };
  const bool any =
      timed(id) || std::ranges::any_of(there.parts, [&](const Hypothesis* part) { return timed(part->type().id); });
  return any ? kSeen : kFitted;
}

void fit_by_free_runs(const ComparisonSetting& setting, const ComparedParts& there,
                      std::vector<Candidate>& candidates) {
  FreeRunStage(setting, there, candidates).run();
}

void note_what_is_left(const ComparisonSetting& setting, const ComparedParts& there,
                       std::vector<Candidate>& candidates) {
  SimulatedModel alone(setting.record, {}, there.fixed);
  double reference = alone.rms_rad(joined(setting.closest, {}), Block::Role::kChoose);
  if (there.parts.empty()) {
    reference = std::min(reference, alone.rms_rad(candidates[1].fit.x, Block::Role::kChoose));
  }
  constexpr std::size_t kMost = 4;
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return candidates[a].fit.cost(kFitted) < candidates[b].fit.cost(kFitted);
  });
  order.resize(std::min(kMost, order.size()));
  if (std::ranges::find(order, 1U) == order.end()) order.push_back(1);
  work_in_parallel(order.size(), setting.threads, [&](std::size_t i) {
    Candidate& one = candidates[order[i]];
    if (one.id == "none") return;
    const SpectralModel::Parts all = there.with(one.type);
    const std::vector<const EffectType*> types = types_of(all);
    const auto fitted = fitted_parameters(setting.sim, setting.refit, types);
    SpectralModel slopes(setting.record, all);
    SimulatedModel model(setting.record, types, there.fixed);
    // A closest wheel that hardly leaves more than noise leaves no gap to hold a run against: the floor is not known
    // better than what that wheel leaves. A run that strays much further contradicts.
    constexpr double kTold = 1.2;
    constexpr double kMuchFurther = 2;
    const double noise = std::pow(floor_rms_rad(one.fit.floor, held_gain(wheel_of(one.fit.x)), 0), 2);
    const bool runs = setting.slow == SlowTorque::kFloor && runs_freely(one.id) &&
                      std::ranges::all_of(there.parts, [](const Hypothesis* p) { return runs_freely(p->type().id); });
    if (one.type != nullptr && runs) {
      const double closest = reference * reference;
      const double left = std::pow(model.rms_rad(one.fit.x, Block::Role::kChoose), 2);
      if (closest > kTold * noise) {
        one.run_error = std::max((left - noise) / (closest - noise), kNothingLeft);
      } else if (left > kMuchFurther * closest) {
        one.run_error = left / closest;
      }
    }
    ResidualModel& judged = one.simulated ? static_cast<ResidualModel&>(model) : slopes;
    one.rivals = rivals_beyond(setting.record, setting.whittle, judged, slopes, one.fit.x, one.fit.floor, fitted);
    // A torque that nobody measured follows nothing: above the floor that every record has, no shape may explain most
    // of it.
    NoiseFloor usual = one.fit.floor;
    usual.slow_variance = std::pow(kUsualSlow * setting.whittle.applied_rms_nm(), 2);
    if (one.fit.floor.slow_variance > usual.slow_variance &&
        (one.id == "unmeasured_torque" || setting.slow == SlowTorque::kCause)) {
      std::ranges::copy(rivals_beyond(setting.record, setting.whittle, judged, slopes, one.fit.x, usual, fitted),
                        std::back_inserter(one.rivals));
    }
  });
}

}  // namespace steerid
