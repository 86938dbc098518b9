// The second stage of a comparison (gap/comparison.hpp): by free runs of the real simulation, which knows sticking,
// impacts and everything else that fits on the measured motion only approximate.
#pragma once

#include <vector>

#include "gap/comparison.hpp"
#include "gap/hypotheses.hpp"

namespace steerid {

/// What a comparison works with: the library, and the effects already there, as hypotheses and as they are.
struct ComparedParts {
  Hypotheses library{};
  SpectralModel::Parts parts{};
  std::vector<Effect> present{};  ///< one a part
  std::vector<Effect> fixed{};    ///< effects of the simulation that no hypothesis describes

  [[nodiscard]] const Hypothesis* of(const EffectType* type) const;       ///< null: there is none
  [[nodiscard]] SpectralModel::Parts with(const EffectType* type) const;  ///< those there, and this one if there is one
  /// Whether the first stage is exact for them: their torques do not depend on the motion.
  [[nodiscard]] bool all_exact() const;
};

/// J, B, C and the effects' values, one after the other.
[[nodiscard]] Eigen::VectorXd joined(const WheelArm& wheel, const std::vector<Effect>& effects);

/// The blocks that a hypothesis is fitted on beside those already there. An instant can only be known from the time
/// around it: an effect that begins or ends at instants is fitted on the blocks that choose, too, and pays for it by
/// its parameters alone.
[[nodiscard]] const Whittle::Roles& roles_of(std::string_view id, const ComparedParts& there);

/// Fits anew, by free runs, the candidates whose order that may still change.
void fit_by_free_runs(const ComparisonSetting& setting, const ComparedParts& there, std::vector<Candidate>& candidates);

/// What the wheel alone and the few best leave to shapes without a name, and how the free runs of these err.
void note_what_is_left(const ComparisonSetting& setting, const ComparedParts& there,
                       std::vector<Candidate>& candidates);

}  // namespace steerid
