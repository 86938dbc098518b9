// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How an estimate follows a parameter that changes, by the measures of the field (van de Ruit, Cavallo, Lataire, van
// der Helm, Mugge, van Wingerden and Schouten 2020, "Revealing time-varying joint impedance with kernel-based
// regression and nonparametric decomposition", IEEE Transactions on Control Systems Technology 28(1)): repeats of one
// course by different drives, each relative to its own truth.
//
//   bias     of the estimates' mean over the drives, root mean square over time
//   random   of their spread about that mean, likewise
//   total    root of the sum of both squares: the normalised root mean square error (NRMSE)
//   VAF      variance accounted for: 1 - var(estimate - truth) / var(truth) of a drive; the median drive
//   lag      the delay of the truth that the estimates are closest to, in squares, 0 to 10 s
//   rise     from 10 to 90 % of the way, of the mean over the drives
//   settled  after the change has ended, until within 15 % to stay; as long as the record lasts when never
#pragma once

#include <vector>

namespace steerid {

/// One parameter in one drive, a value a tick of 10 ms, from the change's start on.
struct FollowedCourse {
  std::vector<double> truth;
  std::vector<double> estimate;
};

struct Following {
  double bias = 0;    ///< over the truth
  double random = 0;  ///< likewise
  double total = 0;   ///< likewise
  double accounted = 0;
  double lag_s = 0;
  double rise_s = 0;        ///< NaN where the estimates never go from 10 to 90 %
  double truth_rise_s = 0;  ///< of the truth
  double settled_median_s = 0;
  double settled_p90_s = 0;
};

/// `drives` are of equal length, at least one; `change_s` is how long the change takes. Where the truth does not change
/// VAF, lag and rise are NaN.
[[nodiscard]] Following following_of(const std::vector<FollowedCourse>& drives, double change_s);

}  // namespace steerid
