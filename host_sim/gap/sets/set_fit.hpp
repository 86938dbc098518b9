// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A set of changes fitted to a record, and what the record says for it.
//
// The evidence is Laplace's approximation of the marginal likelihood on everything but the held-out part,
//
//   log Z = (log likelihood at the fit) - 1/2 log det(S I S) - sum over J, B, C of log(1 + (log(found/given)/0.06)^2)
//
// I is the information of the free numbers and S holds their priors' deviations, which are added to it, so that a
// number of which the record says nothing costs nothing. Prior deviations: of a number with a prior of its own (in
// its effect's file) that; of another effect's number a dozen of its noticeable steps, its
// range at most; of J, B and C 6 %, with Cauchy's tails: simulations are off by a few per cent as a rule and by any
// amount now and then. Where even the best set stays above the floor log likelihoods are divided by its excess
// (quasi-likelihood; McCullagh and Nelder, Generalized Linear Models, 1989).
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gap/model/slow_course.hpp"
#include "gap/sets/effect_set.hpp"

namespace steerid::gap {

/// Evaluations of a fit by free runs.
inline constexpr int kRunBudget = 30;
/// Of one on the measured motion.
inline constexpr int kMotionBudget = 150;

/// An excess that nothing needs to better.
inline constexpr double kReached = 1.15;
/// Below it details are not fitted to the end.
inline constexpr double kNearNoise = 1.1;

/// Where a fit knows the wheel's motion from.
enum class Motion {
  kMeasured,  ///< the measurement, carried by the linear wheel's run (gap/hypotheses/measured_motion.hpp)
  kCarried,   ///< the measurement, carried by the run of the wheel with the effects (gap/model/carried_record.hpp)
  kFreeRuns,  ///< the simulation itself
};

struct FittedSet {
  EffectSet set;
  Whittle::Fit fit{};
  Motion motion = Motion::kMeasured;
  std::shared_ptr<const SlowCourse> course{};
  bool settled = false;  ///< going on gains nothing
  bool eligible = true;  ///< nothing that it adds is what every record has
  /// J, B or C, where the simulation has it, is at the limit of its fit: a factor kWheelWithin of the simulation's.
  bool wheel_at_limit = false;
  double occam = 0;  ///< nats that the free numbers cost, whatever the dispersion

  // Where several records of one wheel have sizes in common (gap/sets/shared_sizes.hpp).
  std::shared_ptr<const FittedSet> apart{};  ///< the fit to this record alone; none where this is it
  /// One a number: the deviation that the other records leave; 0: its own. Empty where nobody has asked.
  Eigen::VectorXd told_elsewhere{};

  /// Where the fit ended.
  [[nodiscard]] Point at() const { return Point::of(fit.x, set.hypotheses()); }
  /// Without what J, B and C cost that are not the simulation's, which `occam` holds.
  [[nodiscard]] double nats() const { return fit.cost(kSeen) - fit.shift; }
  [[nodiscard]] double excess() const { return fit.excess(kSeen); }
  [[nodiscard]] double lines() const { return fit.misfit[0].lines + fit.misfit[1].lines; }
  /// Nats that a model at the floor leaves by chance: half of the deviation of their sum over the lines.
  [[nodiscard]] double chance_nats() const { return std::sqrt(lines()) / 2; }
  /// Nats that it leaves above the floor, and by chance.
  [[nodiscard]] double left_nats() const { return std::max(excess() - 1, 0.0) * lines() + chance_nats(); }
  /// Log marginal likelihood, where log likelihoods are divided by `dispersion`.
  [[nodiscard]] double log_evidence(double dispersion) const { return -nats() / dispersion - occam; }
};

/// What the sets of one record share.
struct SetSetting {
  const SpectralRecord& record;
  const Whittle& whittle;
  WheelArm wheel;             ///< the simulation's
  std::vector<Effect> given;  ///< its effects that are hypotheses
  std::vector<std::string> without{};
  unsigned threads = 0;
  /// Asked before every round of the search but the first; true ends it with what was found.
  std::function<bool()> out_of_time = [] { return false; };

  /// Whether the effect was not taken out of the library.
  [[nodiscard]] bool allows(const EffectType& type) const {
    return std::ranges::find(without, type.id) == without.end();
  }
};

class SetFitter {
 public:
  explicit SetFitter(const SetSetting& setting) : setting_(setting) {}

  /// Limits, steps and priors of a set's numbers; those that are held have a step of 0.
  [[nodiscard]] std::vector<Fitted> fitted(const EffectSet& set) const;

  /// The same where a fit ended: what the record's ends cut off is held (Hypothesis::cut_off_by).
  [[nodiscard]] std::vector<Fitted> fitted(const FittedSet& one) const;

  /// Deviations of the priors of the same numbers, 0 of those that are held.
  [[nodiscard]] Eigen::VectorXd prior_sds(const EffectSet& set) const;

  /// Where the model on the measured motion is exact, there; else by free runs, or on the motion that they carry where
  /// that is much better (Motion::kCarried). `course`: the slow torque in its runs, if any is known.
  [[nodiscard]] FittedSet fit(const EffectSet& set, const Point& start,
                              std::shared_ptr<const SlowCourse> course = nullptr) const;

  /// What a fit would have to better at a point, priors included: nats.
  [[nodiscard]] double nats_at(const EffectSet& set, const Point& at,
                               const std::shared_ptr<const SlowCourse>& course) const;

  /// What free J, B and C cost a fit, nats.
  [[nodiscard]] double cost_of_wheel(const FittedSet& one) const;

  /// Goes on from a fit: until nothing is gained, and with the slow torque in its runs where that is much nearer.
  /// `threads` of them run at a time (0: one a core).
  [[nodiscard]] FittedSet settled(FittedSet one, unsigned threads) const;

  [[nodiscard]] const SetSetting& setting() const { return setting_; }

 private:
  /// Its information, and what that makes its numbers cost. Of all sets in the same way: where a wheel sticks or
  /// knocks, differences between runs tell by several nats more or less of the same numbers, as their steps happen to
  /// fall.
  void price(FittedSet& one) const;
  /// Where a fit ended, with every course that may as well go on beyond the record as end in it.
  [[nodiscard]] Eigen::VectorXd gone_on_to_ends(const FittedSet& one) const;
  /// Its numbers as far as the record shows them (Hypothesis::restate).
  void restate(FittedSet& one) const;
  /// With the slow torque in its runs, where they are much better for it (gap/model/slow_course.hpp).
  [[nodiscard]] FittedSet with_slow_course(FittedSet one, unsigned threads) const;
  [[nodiscard]] FittedSet by_runs(FittedSet one, int budget, bool own_slopes, unsigned threads) const;

  SetSetting setting_;
};

[[nodiscard]] Hypothesis::Span span_of(const SpectralRecord& record);

/// 1/2 log det(1 + S I S): what is told of numbers beyond their priors, nats. Those of a deviation of 0 are held.
[[nodiscard]] double information_gained(const Eigen::MatrixXd& information, const Eigen::VectorXd& prior_sds);

/// Numbers of a set by their places, and other values.
using Held = std::vector<std::pair<Eigen::Index, double>>;

/// Where a fit would be, to first order, if these numbers had these values: the others at the means that its
/// information gives them under that condition. J, B and C make up for an effect that is taken away, and an effect for
/// J, B and C that are the simulation's again.
[[nodiscard]] Eigen::VectorXd conditioned(const FittedSet& one, const Held& held);

/// Whether the model on a measured motion is exact for all of the set.
[[nodiscard]] bool exact_at_once(const EffectSet& set);

}  // namespace steerid::gap
