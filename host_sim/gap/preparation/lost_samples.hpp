// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Lost angle samples, put back by cubics through the kept ones.
//
// A straight line over a gap cuts every peak: of a sine of 5 Hz of which three samples in ten are lost it takes
// 3 %, which a fit then finds as 1 % too much inertia, damping and stiffness. The cubic through two kept samples on
// either side errs by at most h^4/24 (9/16 within the gap of an even grid) of the fourth derivative: below 0.2 % of
// that sine.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace steerid::gap {

/// The angle with what is marked in `lost` rebuilt. Gaps at the ends of the record, and those beside which there are no
/// two kept samples, stay as they are.
[[nodiscard]] std::vector<double> over_lost_samples(std::vector<double> angle_rad, const std::vector<char>& lost);

/// The density of the rebuilt angle's noise over that of white noise which the kept samples have, one a frequency: as a
/// kept sample stands for its neighbours, too, fewer samples average it. Of three samples in ten lost it is 2 below 12
/// Hz at 100 Hz. `lost` has one value a sample, and keeps at least one sample.
[[nodiscard]] Eigen::VectorXd rebuilt_noise_gain(const std::vector<char>& lost, const Eigen::VectorXd& omega_rad_s,
                                                 double rate_hz);

/// Variance of the white noise of what was kept: cubics quieten the noise that they go through, so that the rebuilt
/// angle has less. From what the cubic through two kept neighbours on either side misses of the sample between them;
/// 0 where fewer than a hundred have such.
[[nodiscard]] double kept_noise_variance(const std::vector<double>& angle_rad, const std::vector<char>& lost);

}  // namespace steerid::gap
