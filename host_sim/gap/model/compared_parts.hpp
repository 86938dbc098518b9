// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a comparison works with: the effects already there, as hypotheses.
#pragma once

#include <string_view>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/likelihood/whittle.hpp"
#include "gap/model/spectral_model.hpp"

namespace steerid {

struct ComparedParts {
  SpectralModel::Parts parts{};
  std::vector<Effect> present{};  ///< one a part
  std::vector<Effect> fixed{};    ///< effects of the simulation that no hypothesis describes

  [[nodiscard]] const Hypothesis* of(const EffectType* type) const;       ///< null: there is none
  [[nodiscard]] SpectralModel::Parts with(const EffectType* type) const;  ///< those there, and this one if there is one
  /// Whether the first stage is exact for them: their torques do not depend on the motion.
  [[nodiscard]] bool all_exact() const;
  /// The same with an effect beside them. A slow torque is no hypothesis of its own, and exact; so is the plain wheel.
  [[nodiscard]] bool exact_with(const EffectType* type) const;
};

/// The effects as hypotheses, where there is one.
[[nodiscard]] ComparedParts compared_parts(const std::vector<Effect>& present);

/// J, B, C and the effects' values, one after the other.
[[nodiscard]] Eigen::VectorXd joined(const WheelArm& wheel, const std::vector<Effect>& effects);

/// The same of those of the effects that are hypotheses.
[[nodiscard]] Eigen::VectorXd point_of(const WheelArm& wheel, const std::vector<Effect>& effects);

/// The blocks that a hypothesis is fitted on beside those already there. An instant can only be known from the time
/// around it: an effect that begins or ends at instants is fitted on the blocks that choose, too, and pays for it by
/// its parameters alone.
[[nodiscard]] const Whittle::Roles& roles_of(std::string_view id, const ComparedParts& there);

}  // namespace steerid
