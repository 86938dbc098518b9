// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a comparison works with: the effects already there, as hypotheses.
#pragma once

#include <string_view>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/likelihood/whittle.hpp"
#include "gap/model/spectral_model.hpp"

namespace steerid::gap {

struct ComparedParts {
  SpectralModel::Parts parts{};
  std::vector<Effect> present{};  ///< one a part
  std::vector<Effect> fixed{};    ///< effects of the simulation that no hypothesis describes
};

/// The effects as hypotheses, where there is one.
[[nodiscard]] ComparedParts compared_parts(const std::vector<Effect>& present);

/// J, B, C and the effects' values, one after the other.
[[nodiscard]] Eigen::VectorXd joined(const WheelArm& wheel, const std::vector<Effect>& effects);

}  // namespace steerid::gap
