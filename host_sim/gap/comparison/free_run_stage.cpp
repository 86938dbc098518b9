// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/comparison/free_run_stage.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "gap/comparison/dry_friction_forms.hpp"
#include "gap/comparison/preferred_fit.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

/// Evaluations of a fit by free runs where the measured motion's slopes lead nowhere: where a wheel sticks.
constexpr int kManySimulations = 120;

/// The candidates that free runs may still change the order of: the best of the first stage that are approximations,
/// and all kinds of dry friction when one of them is among these, for they are told apart at rest.
std::vector<std::size_t> worth_simulating(const std::vector<Candidate>& all, const ComparedParts& there,
                                          double impossible) {
  const Whittle::Roles& roles = roles_of("", there);
  double least = std::numeric_limits<double>::infinity();
  double best = least;  // the excess of the one that costs least: a lower one may be a larger slow torque's
  for (const Candidate& one : all) {
    if (one.type == nullptr && !there.parts.empty()) continue;
    if (one.fit.excess(roles) < impossible || one.fit.cost(roles) > least) continue;
    least = one.fit.cost(roles);
    best = one.fit.excess(roles);
  }
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].type != nullptr && !there.exact_with(all[i].type)) chosen.push_back(i);
  }
  std::ranges::sort(chosen,
                    [&](std::size_t a, std::size_t b) { return all[a].fit.cost(roles) < all[b].fit.cost(roles); });
  constexpr std::size_t kMost = 4;
  const auto near_best = [&](const Candidate& one) {
    return one.fit.excess(roles) < 1.15 * best + 15 * std::max(0.0, best - 1) + 0.3;
  };
  constexpr std::size_t kFriction = 3;  // where any kind of it is as good
  bool friction = false;
  for (std::size_t rank = 0; rank < std::min(kMost, chosen.size()); ++rank) {
    const Candidate& one = all[chosen[rank]];
    friction = friction || (dry_friction(one.id) && (rank < kFriction || near_best(one)));
  }
  // Beside what is linear the measured motion shows whether a second effect gains anything; beside friction, which
  // hides behind its own approximation, it does not.
  constexpr double kNothing = 0.97;
  const bool shows = !there.parts.empty() && there.all_exact();
  std::vector<std::size_t> kept;
  for (std::size_t rank = 0; rank < chosen.size(); ++rank) {
    const Candidate& one = all[chosen[rank]];
    if (shows && one.fit.excess(roles) > kNothing * all[1].fit.excess(roles)) continue;
    // Beside what sticks a slow torque is not known on the measured motion.
    const bool slow = !there.parts.empty() && one.id == "unmeasured_torque";
    if ((rank < kMost && near_best(one)) || (friction && dry_friction(one.id)) || slow) kept.push_back(chosen[rank]);
  }
  return kept;
}

constexpr double kFarWorse = 30;  // nats

constexpr double kSame = 1;     // nats: of two that fit alike, the simpler one
constexpr double kShort = 1.1;  // an excess at which a fit may have been cut short
constexpr double kLost = 1.8;   // an excess at which friction by free runs may have missed its optimum

/// Fits of one comparison by free runs.
class FreeRunStage {
 public:
  FreeRunStage(const ComparisonSetting& setting, const ComparedParts& there, std::vector<Candidate>& candidates)
      : setting_(setting),
        there_(there),
        candidates_(candidates),
        chosen_(worth_simulating(candidates, there, impossible_excess(setting.whittle.white()))),
        coulomb_(std::ranges::find(candidates, "coulomb_friction", &Candidate::id)) {}

  /// One candidate from where it is, whatever the others are.
  void fit_from_here(Candidate& one) const {
    if (there_.exact_with(one.type)) {
      const SpectralModel::Parts parts = there_.with(one.type);
      SpectralModel on_motion(setting_.record, parts);
      one.fit = setting_.whittle.fit(on_motion, one.fit.x, fitted_parameters(setting_.sim, setting_.refit, parts),
                                     roles_of(one.id, there_), setting_.slow_beside(one.type), kMotionBudget);
      return;
    }
    one.fit = fitted(one, one.fit.x);
    if (sticks(there_, one) && !one.course) one.fit = fitted(one, one.fit.x, kManySimulations, Slopes::kOwn);
    one.motion = Motion::kFreeRuns;
    prefer_motion(setting_, there_, one);
  }

  void run() {
    work_in_parallel(chosen_.size(), setting_.threads, [&](std::size_t i) {
      Candidate& one = candidates_[chosen_[i]];
      one.course = setting_.course;
      // Instants move in small steps: what happens after them follows them closely.
      const Eigen::VectorXd start = dry_friction(one.id) ? with_bristles(one) : runnable(one);
      Whittle::Fit by_runs = fitted(one, start, one.id == "hands_off" ? 3 * kRunBudget : kRunBudget);
      // A hand that leaves is found by its windows; where they are uncertain the first stage may be the better judge.
      const Whittle::Roles& roles = roles_of(one.id, there_);
      if (!leaves(there_, one) || by_runs.cost(roles) <= one.fit.cost(roles)) {
        one.motion = Motion::kFreeRuns;
        one.fit = std::move(by_runs);
      }
      prefer_motion(setting_, there_, one);
    });
    settle_friction();
    take_the_best_to_its_end();
    let_coulomb_follow();
    settle_slow_torque();
    if (setting_.base) give_the_best_a_slow_course();
  }

 private:
  enum class Slopes { kCheapFirst, kOwn };

  [[nodiscard]] Whittle::Fit fitted(const Candidate& one, const Eigen::VectorXd& start, int budget = kRunBudget,
                                    Slopes by = Slopes::kCheapFirst) const {
    const SpectralModel::Parts parts = there_.with(one.type);
    SimulatedModel model(setting_.record, parts, there_.fixed, one.course);
    RunSlopes slopes(setting_.record, parts);
    return setting_.whittle.fit(model, start, fitted_parameters(setting_.sim, setting_.refit, parts),
                                roles_of(one.id, there_), setting_.slow_beside(one.type), budget,
                                by == Slopes::kOwn ? nullptr : &slopes);
  }

  /// What free runs from a point cost, on the fitted blocks.
  [[nodiscard]] auto cost_by_runs(const Candidate& one) const {
    const SpectralModel::Parts parts = there_.with(one.type);
    return
        [this, fitted = fitted_parameters(setting_.sim, setting_.refit, parts),
         model = SimulatedModel(setting_.record, parts, there_.fixed, one.course)](const Eigen::VectorXd& x) mutable {
          return setting_.whittle.judge(model, x, fitted, kFitted, setting_.slow).cost(kFitted);
        };
  }

  /// The cheapest of the points, `otherwise` if none costs a finite amount.
  [[nodiscard]] static Eigen::VectorXd least_of(const std::vector<Eigen::VectorXd>& points, auto& cost,
                                                Eigen::VectorXd otherwise) {
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& point : points) {
      if (const double at = cost(point); at < least) {
        least = at;
        otherwise = point;
      }
    }
    return otherwise;
  }

  /// Where the first stage ended, or the best of where it began if no run leads from its end: a compliance may have
  /// lost the inertia of one of its sides. A softening spring that is a little too soft lets the wheel go: smaller ones
  /// that do not.
  [[nodiscard]] Eigen::VectorXd runnable(const Candidate& one) const {
    const Hypothesis* hypothesis = there_.of(one.type);
    const int scale = hypothesis == nullptr ? -1 : hypothesis->linear().scale;
    if (hypothesis == nullptr || (hypothesis->acts() && scale < 0)) return one.fit.x;
    auto cost = cost_by_runs(one);
    constexpr double kNoRun = 1e9;  // nats
    if (cost(one.fit.x) < kNoRun) return one.fit.x;
    std::vector<Eigen::VectorXd> points;
    if (hypothesis->acts()) {
      for (const double part : {0.98, 0.95, 0.9, 0.8, 0.6}) {
        points.push_back(one.fit.x);
        points.back()[one.fit.x.size() - std::ssize(one.type->parameters) + scale] *= part;
      }
      return least_of(points, cost, one.fit.x);
    }
    const Eigen::VectorXd from = origin_of(one.fit.x, *one.type);
    const Hypothesis::Starts starts = hypothesis->starts(setting_.sim, setting_.record.record, setting_.record.motion);
    for (const std::vector<double>& values : starts.values) {
      for (const WheelArm& wheel : {wheel_of(from), setting_.sim}) {
        Eigen::VectorXd x = point_at(from, values);
        x.head(3) << wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad;
        points.push_back(std::move(x));
      }
    }
    return least_of(points, cost, one.fit.x);
  }

  void give_the_best_a_slow_course() {
    constexpr std::size_t kBest = 2;
    std::vector<std::size_t> order = chosen_;
    const Whittle::Roles& roles = roles_of("", there_);
    std::ranges::sort(order, {}, [&](std::size_t i) { return candidates_[i].fit.cost(roles); });
    order.resize(std::min(kBest, order.size()));
    work_in_parallel(order.size(), setting_.threads,
                     [&](std::size_t i) { prefer_slow_course(setting_, there_, candidates_[order[i]]); });
  }

  void settle_friction() {
    if (coulomb_ != candidates_.end() && coulomb_->motion == Motion::kFreeRuns) {
      // Beside an effect that is fitted already it begins near enough.
      if (!setting_.base && coulomb_->fit.excess(kFitted) > kLost) offer_coulomb(scanned_friction());
      agree_on_friction();
      return;
    }
    if (setting_.base) return;
    // Without Coulomb's to begin from, each begins from its own simplest form, too.
    work_in_parallel(chosen_.size(), setting_.threads, [&](std::size_t i) {
      Candidate& one = candidates_[chosen_[i]];
      if (!dry_friction(one.id) || one.motion != Motion::kFreeRuns) return;
      Whittle::Fit fit = fitted(one, levelled(one));
      if (fit.cost(kFitted) < one.fit.cost(kFitted) + kSame) one.fit = std::move(fit);
    });
  }

  /// Beside what sticks or is let go an offset or a drift is not known on the measured motion, and what they begin with
  /// may lead nowhere. Where a torque in time explains most, they begin again from the wheel that it was found with.
  void settle_slow_torque() {
    if (!setting_.base) return;
    const auto in_time = [](std::string_view id) { return id == "torque_bias" || id == "torque_drift"; };
    const Candidate& best = *std::ranges::min_element(candidates_, {}, [](const Candidate& one) {
      return one.compared ? one.fit.cost(kSeen) : std::numeric_limits<double>::infinity();
    });
    const bool unmeasured = best.id == "unmeasured_torque";
    if (!unmeasured && !in_time(best.id)) return;
    const EffectType* leading = best.type;
    const Eigen::VectorXd from = unmeasured ? best.fit.x : origin_of(best.fit.x, *best.type);
    work_in_parallel(candidates_.size(), setting_.threads, [&](std::size_t i) {
      Candidate& one = candidates_[i];
      if (!in_time(one.id) || there_.exact_with(one.type)) return;
      const bool leads = one.type == leading;
      const Eigen::VectorXd own = one.fit.x.tail(std::ssize(one.type->parameters));
      one.course = setting_.course;
      Whittle::Fit fit =
          to_the_end(one, leads ? one.fit : fitted(one, point_at(from, {own.begin(), own.end()}), 2 * kRunBudget));
      const bool lower = fit.cost(kSeen) < one.fit.cost(kSeen);
      if ((leads || one.motion == Motion::kFreeRuns) && !lower) return;
      one.fit = std::move(fit);
      one.motion = Motion::kFreeRuns;
      one.compared = true;
    });
  }

  /// A fit goes on as long as anything is gained.
  [[nodiscard]] Whittle::Fit to_the_end(const Candidate& one, Whittle::Fit fit) const {
    constexpr int kMost = 3;
    double gained = kSame;
    for (int again = 0; again < kMost && gained >= kSame; ++again) {
      Whittle::Fit next = fitted(one, fit.x, kRunBudget, Slopes::kOwn);
      gained = fit.cost(kSeen) - next.cost(kSeen);
      if (gained > 0) fit = std::move(next);
    }
    return fit;
  }

  /// The budget of a fit is that of a good start. The best one of all is worth going on with.
  void take_the_best_to_its_end() {
    const int most = setting_.base ? 1 : 5;
    constexpr double kWorth = 5;  // nats
    const auto cost = [&](std::size_t i) { return candidates_[i].fit.cost(kFitted); };
    std::erase_if(chosen_, [&](std::size_t i) {
      return candidates_[i].motion != Motion::kFreeRuns || candidates_[i].id == "hands_off";
    });
    if (chosen_.empty()) return;
    Candidate& best = candidates_[*std::ranges::min_element(chosen_, {}, cost)];
    const bool sticks = dry_friction(best.id) && !setting_.base;
    for (int again = 0; again < most && best.fit.excess(kFitted) > kShort; ++again) {
      Whittle::Fit fit = sticks ? fitted(best, best.fit.x, kManySimulations, Slopes::kOwn) : fitted(best, best.fit.x);
      const double gained = best.fit.cost(kFitted) - fit.cost(kFitted);
      if (gained > 0) best.fit = std::move(fit);
      if (gained < kWorth) break;
    }
  }

  /// A richer kind of friction that went on to its end, and is a little better for that, is Coulomb's by another name
  /// until that has gone on from there, too.
  void let_coulomb_follow() {
    constexpr double kLittle = 2 * kFarWorse;
    constexpr double kWorth = 5;  // nats
    if (setting_.base || coulomb_ == candidates_.end() || coulomb_->motion != Motion::kFreeRuns) return;
    for (const std::size_t i : chosen_) {
      const Candidate& richer = candidates_[i];
      const double better = coulomb_->fit.cost(kFitted) - richer.fit.cost(kFitted);
      const bool other = dry_friction(richer.id) && &richer != &*coulomb_;
      if (other && better > kWorth && better < kLittle) offer_coulomb(coulomb_of(richer));
    }
  }

  bool offer_coulomb(const Eigen::VectorXd& start) {
    Whittle::Fit fit = fitted(*coulomb_, start, 2 * kRunBudget);
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
    const Eigen::VectorXd given = joined(setting_.sim, there_.present);
    Effect effect(*coulomb_->type);
    effect.at("bristle_rad") = fitted_effect(*coulomb_)->at("bristle_rad");
    std::vector<Eigen::VectorXd> points;
    for (double share = kSmallest; share < kLargest; share *= kStep) {
      effect.at("friction_nm") = share * setting_.whittle.applied_rms_nm();
      points.push_back(point_at(given, effect.values));
    }
    auto cost = cost_by_runs(*coulomb_);
    return least_of(points, cost, coulomb_->fit.x);
  }

  /// The kinds of dry friction begin from each other until neither gains.
  void agree_on_friction() {
    const int rounds = setting_.base ? 1 : 3;  // a pair is looked for again and again
    bool again = true;
    for (int round = 0; round < rounds && again; ++round) {
      again = false;
      for (const std::size_t i : chosen_) {
        const Candidate& richer = candidates_[i];
        if (!dry_friction(richer.id) || !(richer.fit.cost(kFitted) < coulomb_->fit.cost(kFitted) - kFarWorse)) continue;
        if (offer_coulomb(coulomb_of(richer))) again = true;
      }
      std::atomic<bool> improved = false;
      work_in_parallel(chosen_.size(), setting_.threads, [&](std::size_t i) {
        Candidate& one = candidates_[chosen_[i]];
        if (!dry_friction(one.id) || !(one.fit.cost(kFitted) > coulomb_->fit.cost(kFitted))) return;
        const double before = one.fit.cost(kFitted);
        one.fit = fitted(one, as_coulomb(*one.type, *coulomb_));
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

}  // namespace

void fit_from_here(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one) {
  std::vector<Candidate> alone = {one};
  FreeRunStage(setting, there, alone).fit_from_here(one);
}

void fit_by_free_runs(const ComparisonSetting& setting, const ComparedParts& there,
                      std::vector<Candidate>& candidates) {
  FreeRunStage(setting, there, candidates).run();
}

}  // namespace steerid
