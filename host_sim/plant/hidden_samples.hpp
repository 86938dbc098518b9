// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Samples of a band-limited signal that are known only to lie beyond a level: what was clipped.
//
// The signal is taken for an autoregression, whose coefficients and hidden samples are worked out in turns (Janssen,
// Veldhuis and Vries, IEEE Trans. ASSP 34, 1986): the coefficients by least squares from all samples, then the hidden
// samples as those of the least innovations. A peak of a probe comes back to thousandths; what a plateau of many of the
// signal's own periods hid does not, and the same model says how uncertain it is.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace steerid {

/// Consecutive hidden samples.
struct HiddenStretch {
  std::size_t first = 0;
  std::size_t count = 0;
  int side = 1;  ///< 1: they lie above the level, -1: below minus the level
};

/// Where a channel that was clipped at +-level before its noise was added is clipped. The noise is read off what lies
/// beyond the level.
[[nodiscard]] std::vector<HiddenStretch> clipped_stretches(std::span<const double> signal, double level);

class HiddenSamples {
 public:
  /// Fills the hidden samples of `signal`, which lie beyond `level` on the side of their stretch. Stretches are in
  /// order and do not touch.
  HiddenSamples(std::span<double> signal, std::vector<HiddenStretch> stretches, double level);

  [[nodiscard]] const std::vector<HiddenStretch>& stretches() const { return stretches_; }

  /// What may be wrong with a filled stretch: independent shapes, one a column, each of the size of its standard
  /// deviation. Left out are those of which a sample's mean square is below `negligible_variance` times the stretch's
  /// length, and whatever is faster than `highest` (cycles a sample).
  [[nodiscard]] Eigen::MatrixXd uncertain(const HiddenStretch& stretch, double negligible_variance,
                                          double highest) const;

 private:
  void fit_coefficients(std::span<const double> signal);
  void fill(std::span<double> signal, double level) const;
  [[nodiscard]] double coupling(std::size_t one, std::size_t other, std::size_t samples) const;

  std::vector<HiddenStretch> stretches_;
  Eigen::VectorXd coefficients_;  // 1, a1, .. ap
  Eigen::VectorXd coupled_;       // sum over k of a_k a_(k+lag)
  double innovation_variance_ = 0;
};

}  // namespace steerid
