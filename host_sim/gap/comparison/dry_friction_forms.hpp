// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The kinds of dry friction, and one as another: where a fit of it begins. These return J, B, C and the values that a
// fit of the wanted kind takes, from the parameters of a candidate of the given kind.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "gap/comparison/comparison.hpp"

namespace steerid {

/// Coulomb's, Stribeck's or asymmetric friction: of one shape but for details, so that one stands in for another.
[[nodiscard]] bool dry_friction(std::string_view id);

/// With bristles for a fit by free runs to begin from: so stiff that the wheel swings on them above all lines of the
/// fit. From there a fit finds stiffer and softer ones, and from ideal friction neither.
[[nodiscard]] Eigen::VectorXd with_bristles(const Candidate& candidate);
[[nodiscard]] Effect with_bristles(Effect effect, const WheelArm& wheel);

/// The parameters at which a richer kind is Coulomb's. A richer model that fits worse than what it contains has not
/// found its optimum.
[[nodiscard]] Eigen::VectorXd as_coulomb(const EffectType& type, const Candidate& coulomb);

/// The Coulomb friction in the middle of a richer kind. A simpler model that fits far worse than a richer one whose
/// additional numbers hardly matter has not found its optimum either.
[[nodiscard]] Eigen::VectorXd coulomb_of(const Candidate& richer);

/// The parameters at which one kind is what another is without what that is richer by.
[[nodiscard]] Eigen::VectorXd as_kind(const EffectType& type, const Candidate& other);

/// A richer kind without what it is richer by.
[[nodiscard]] Eigen::VectorXd levelled(const Candidate& richer);

}  // namespace steerid
