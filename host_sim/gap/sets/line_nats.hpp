// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// On which lines of the spectrum a change acts, and what is left there.
//
// Two fitted sets say of every line what its residual is, and how large its noise. What the record is expected to tell
// between them there is four times the Bhattacharyya distance of two complex normals,
//
//   g_k = |r0_k - r1_k|^2 / S_k + 4 log S_k - 2 log (S0_k S1_k),   S_k = (S0_k + S1_k) / 2
//
// which is the mean difference of their log likelihoods where the noise is the same. Where it is not, that difference
// depends on which of the two is taken for the truth: a set that passes 1e8 times the noise on one line would have 1e8
// nats there (A. Bhattacharyya, Bulletin of the Calcutta Mathematical Society 35, 1943).
//
// It has no noise of its own, unlike the gain of a line. A change that acts on few lines has a weight of one
// on those, and next to none elsewhere:
//
//   w_k = g_k (sum g) / (sum g^2)
//
// whose sum is the number of lines that it acts on (the participation ratio). A sum over the lines times w is then what
// of something stands where the change acts.
#pragma once

#include <Eigen/Core>

#include "gap/sets/set_fit.hpp"

namespace steerid::gap {

/// What a fitted set says of every line that is not held out; nothing elsewhere.
struct SetLines {
  SetLines() = default;
  SetLines(const FittedSet& one, const Whittle& whittle);

  /// Puts the lines of another record behind these.
  void append(const SetLines& other);

  Spectrum residual;       ///< without the blocks' ends
  Eigen::ArrayXd density;  ///< of its noise; one where nothing is said
  Eigen::ArrayXd counted;  ///< one a line; a half at zero, which is real; zero where nothing is said
};

/// What tells `without` from `with`, nats a line.
[[nodiscard]] Eigen::ArrayXd expected_nats(const SetLines& with, const SetLines& without);

/// The weights of such nats.
[[nodiscard]] Eigen::ArrayXd acting_on(const Eigen::ArrayXd& nats);

/// Nats of `all` on the lines on which a change of `nats` acts: those of the change over its share of all, in the mean
/// over its nats. A line on which all of it is something else's does not count against it.
[[nodiscard]] double nats_beside(const Eigen::ArrayXd& nats, const Eigen::ArrayXd& all);

/// Nats that the set leaves above the floor, and by chance (FittedSet::left_nats()), on lines of these weights, of
/// which there is one at least.
[[nodiscard]] double left_nats_on(const Eigen::ArrayXd& weights, const SetLines& one);

}  // namespace steerid::gap
