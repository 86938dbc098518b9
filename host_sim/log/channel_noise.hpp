// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What noise a channel has, and by which steps it counts: whether a reading can come twice by chance.
#pragma once

#include <span>

namespace steerid {

/// The deviation of the channel's white noise: the median of what samples are off the cubic through their neighbours
/// (log/neighbours.hpp), a sixth of a fourth difference, 6 |x_i - by_neighbours(x, i)| / (0.6745 sqrt(70)). 0 where the
/// differences do not alternate as those of noise: neighbours have a correlation of -0.8 and other signs in four of
/// five, those of a motion far below the sampling rate in one of ten.
[[nodiscard]] double white_noise_deviation(std::span<const double> x);

/// The smallest distance between two values that are not the same; infinite where all are.
[[nodiscard]] double smallest_step(std::span<const double> x);

/// Whether a reading that comes twice in a row is no chance where samples are off what predicts them by `deviation`:
/// ten steps. Of finer ones 3 % of the rows of a wheel that rests repeat.
[[nodiscard]] bool repeats_tell(double deviation, std::span<const double> x);

}  // namespace steerid
