// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a fit of two effects at once may begin, when both are strong: the balance of torques on the measured motion.
//
//   T(t - delay) + a e1(t) + b e2(t) = J th'' + B th' + C th
//
// is linear in J, B, C and the sizes a, b of two effects whose shapes are given, and needs no simulation: each sample
// says what it says whatever went before. One matrix of products answers for every pair of shapes. J, B and C have the
// simulation's values as a weak prior. Where one of the two is dry friction only samples at which the wheel slides are
// taken, since at rest it is as large as anything else makes it. A delay or a lag of the angle's channel is tried as
// the same of the torque. The noise of a differentiated angle makes this no estimate, but a fit by free runs finds its
// optimum from within a third of the friction and half of what goes with it
// (docs/adr/0015).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "gap/hypotheses/hypotheses.hpp"
#include "gap/model/spectral_model.hpp"

namespace steerid {

struct PairStart {
  const Hypothesis* first = nullptr;
  const Hypothesis* second = nullptr;
  Eigen::VectorXd x;  ///< J, B, C, the first one's values and the second one's
  double left = 0;    ///< of the balance, over what J, B and C alone leave of the same samples
};

/// The `most` best pairs, no two of the same effects, the best first; then the best one of
/// `leading` with a grip, which this balance of a rigid wheel does not see. `may_stand` says which effects there are,
/// and `together` which go with each other.
[[nodiscard]] std::vector<PairStart> pair_starts(
    const SpectralRecord& record, const WheelArm& sim, std::size_t most, const EffectType& leading,
    const std::function<bool(const EffectType&)>& may_stand,
    const std::function<bool(const EffectType&, const EffectType&)>& together);

}  // namespace steerid
