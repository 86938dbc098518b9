// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every hypothesis on one record, fitted on one part and judged on another.
//
// Two stages. On the measured motion all of them (gap/comparison/spectral_search.hpp); then those that are not far
// behind, and whose torque depends on the motion, by free runs of the real simulation
// (gap/comparison/free_run_stage.hpp).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gap/comparison/rivals.hpp"
#include "gap/comparison/spectral_search.hpp"
#include "gap/likelihood/whittle.hpp"
#include "gap/model/slow_course.hpp"

namespace steerid {

/// No model comes this far below the floor: one that does has made its own noise, by a resonance of its wheel.
/// Of a floor that is only known from above nothing is impossible.
[[nodiscard]] inline double impossible_excess(const NoiseFloor& floor) { return floor.at_most ? 0 : 0.5; }

/// Where a fit knows the wheel's motion from.
enum class Motion {
  kMeasured,  ///< the measurement, carried by the linear wheel's run (gap/hypotheses/measured_motion.hpp)
  kCarried,   ///< the measurement, carried by the run of the wheel with the effects (gap/model/carried_record.hpp)
  kFreeRuns,  ///< the simulation itself
};

/// One id's best fit, on top of the effects already there.
struct Candidate {
  std::string id;
  const EffectType* type = nullptr;  ///< null for none, parameters
  Whittle::Fit fit;                  ///< fitted on Role::kFit; none: nothing fitted
  Motion motion = Motion::kMeasured;
  bool compared = false;  ///< free runs had a say
  /// The slow torque in its runs; null: none.
  std::shared_ptr<const SlowCourse> course{};
  std::vector<Rival> rivals{};  ///< what it leaves to shapes without a name; of the likeliest only
  /// Squared error of its free run over that of the closest linear wheel's, both less what noise leaves, on the blocks
  /// that choose; of the few best, where an effect's free run means something.
  std::optional<double> run_error{};
  double slow_line_share = 0;  ///< of an unmeasured torque (gap/likelihood/slow_line.hpp)
  /// The slow torque that its free run misses, over the applied one (gap/model/slow_in_run.hpp); of single ones.
  std::optional<double> slow_share_of_run{};
};

/// The effect with the values that were found; none for what has no numbers of its own (a slow torque's are the
/// floor's).
[[nodiscard]] std::optional<Effect> fitted_effect(const Candidate& candidate);

struct Comparison {
  std::vector<Candidate> candidates;     ///< none, parameters, then effects
  std::vector<Effect> fixed;             ///< effects already there, with the values they have in the winner's fit
  bool by_runs = false;                  ///< what is there is known by free runs alone: no other fit can be compared
  bool switches = false;                 ///< something that is there switches()
  SlowTorque slow = SlowTorque::kFloor;  ///< kCause: an unmeasured torque is there
  double swing_rad = 0;                  ///< of the measured motion, from end to end

  [[nodiscard]] const Candidate& at(std::string_view id) const;
};

struct ComparisonSetting {
  const SpectralRecord& record;
  const Whittle& whittle;
  WheelArm sim;
  WheelArm refit;
  WheelArm closest;  ///< the linear wheel whose free run comes closest
  /// Effects already found: hypotheses (for the first stage) and the values to start from.
  std::vector<Effect> present{};
  /// A fit of what is there, where it is known: the search then begins from it alone.
  std::optional<Whittle::Fit> base{};
  bool base_by_runs = false;  ///< that fit is one by free runs
  /// The slow torque in those runs, with which all others begin; null: none.
  std::shared_ptr<const SlowCourse> course{};
  SlowTorque slow = SlowTorque::kFloor;  ///< kCause: an unmeasured torque is already there, too
  std::vector<std::string> without{};
  unsigned threads = 0;

  /// The same on another record.
  [[nodiscard]] ComparisonSetting on(const SpectralRecord& other) const {
    return {other, whittle, sim, refit, closest, present, base, base_by_runs, course, slow, without, threads};
  }
  /// What the slow torque is beside an effect of the type.
  [[nodiscard]] SlowTorque slow_beside(const EffectType* type) const;
};

/// Whether a simulation can hold the effect beside those that are there, and a record show both.
[[nodiscard]] bool goes_with(const EffectType& type, const std::vector<Effect>& present);

/// Every candidate fitted; what the best of them leave is noted apart (gap/attribution/what_is_left.hpp).
[[nodiscard]] Comparison compare(const ComparisonSetting& setting);

/// Play and absence switch in ways that a simulation states more simply than a machine does; all else is exact or
/// nearly so.
[[nodiscard]] bool switches(std::string_view id);

}  // namespace steerid
