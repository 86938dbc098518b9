// One kind of dry friction as another: where a fit of it begins. All return J, B, C and the values that a fit of the
// wanted kind takes, from the parameters of a candidate of the given kind.
#pragma once

#include <Eigen/Core>

#include "gap/comparison.hpp"

namespace steerid {

/// J, B and C of one fit with an effect's values behind them; `own` is the number of values that the fit's effect had.
[[nodiscard]] Eigen::VectorXd point_of(const Eigen::VectorXd& x, std::size_t own, const Effect& effect);

/// With bristles for a fit by free runs to begin from: so stiff that the wheel swings on them above all lines of the
/// fit. From there a fit finds stiffer and softer ones, and from ideal friction neither.
[[nodiscard]] Eigen::VectorXd with_bristles(const Candidate& candidate);

/// The parameters at which a richer kind is Coulomb's. A richer model that fits worse than what it contains has not
/// found its optimum.
[[nodiscard]] Eigen::VectorXd as_coulomb(const EffectType& type, const Candidate& coulomb);

/// The Coulomb friction in the middle of a richer kind. A simpler model that fits far worse than a richer one whose
/// additional numbers hardly matter has not found its optimum either.
[[nodiscard]] Eigen::VectorXd coulomb_of(const Candidate& richer);

/// A richer kind without what it is richer by.
[[nodiscard]] Eigen::VectorXd levelled(const Candidate& richer);

}  // namespace steerid
