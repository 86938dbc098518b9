// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How far fitted numbers may be from the true ones.
//
// Three estimates of the same variance, of which the largest counts, number by number:
//   from the model   I^-1 times the excess over the floor: right where the misfit is noise of the floor's colour
//   from the blocks  what the fit would move by if a block were left out, linearised (block jackknife; Cameron and
//                    Miller, A practitioner's guide to cluster-robust inference, J. Human Resources 50 (2015), CR3):
//                    right whatever the misfit's colour within a block, as long as blocks err independently
//   from the bands   the same with bands of frequency that tell equally much: a model that misses something finds other
//                    numbers where the wheel is slow than where it is fast
// Groups are few, hence Student's quantile. A group that holds most of what is known of a number cannot be left out:
// the block in which a ramp begins, or the band of a sinusoid. Of that number such groups say nothing.
//
// Priors count half in either, and the interval also holds where the fit would be with so much less of them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/likelihood/whittle.hpp"

namespace steerid::gap {

/// Priors steer a fit where the record says little. How wide they are is a guess, so that an interval rests on them
/// only half as much.
inline constexpr double kPriorsLoosened = 2;

struct FitSpread {
  Eigen::VectorXd low;  ///< of the 95 % intervals, within the numbers' limits; infinite where nothing is known
  Eigen::VectorXd high;
  Eigen::MatrixXd root;  ///< times independent standard normals: a deviation of all numbers as it may be
};

/// The inverse of an information matrix. A direction of which next to nothing is known keeps a finite variance.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information);

/// `fit` is that of `model` on the blocks of `roles`. Costs two evaluations of the model a fitted number.
[[nodiscard]] FitSpread spread_of(const Whittle& whittle, ResidualModel& model, const Whittle::Fit& fit,
                                  const std::vector<Fitted>& fitted, const Whittle::Roles& roles);

}  // namespace steerid::gap
