// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel with effects at values of theirs: what a search begins from, and what a fit found. A fit moves numbers, of
// which it knows limits, steps and priors and nothing else; what they are numbers of is told here.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "plant/effects/effect.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

/// Hypotheses that hold together, in the order of their numbers.
using Parts = std::vector<const Hypothesis*>;

/// Each effect is one that a hypothesis describes.
struct Point {
  WheelArm wheel;
  std::vector<Effect> effects{};  ///< of a type one at most

  /// At the numbers of a fit of these hypotheses.
  [[nodiscard]] static Point of(const Eigen::VectorXd& numbers, std::span<const Hypothesis* const> parts);

  /// J, B, C and the effects' values, one after the other.
  [[nodiscard]] Eigen::VectorXd numbers() const;
  /// Null where it is not there.
  [[nodiscard]] const Effect* find(const EffectType& type) const;
};

/// Where free runs begin there: friction with bristles (Hypothesis::to_run).
[[nodiscard]] Point to_run(Point at);

/// Of the effects that have one.
[[nodiscard]] Parts hypotheses_of(const std::vector<Effect>& effects);

}  // namespace steerid::gap
