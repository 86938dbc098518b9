// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Analysis of variance with repeated measures: what a label does to a quantity when the same subjects were measured at
// all of its levels. The subjects are a random effect: a level is judged against how differently the subjects answer to
// it, and not against the spread of records, of which twelve of one subject are no twelve subjects.
//
//   y[s][k] = mean + subject[s] + level[k] + e[s][k]
//   F       = (SS_levels/(k - 1))/(SS_error/((n - 1)(k - 1)))
//   epsilon   Greenhouse and Geisser (1959): how far the differences between levels are from equally variable,
//             1/(k - 1) to 1; both degrees of freedom are multiplied by it. 1 for two levels.
//   p         of F with these degrees of freedom, by the regularised incomplete beta function
//   partial eta^2 = SS_levels/(SS_levels + SS_error)
//
// In a design that is complete and balanced the test of a main effect is this one on each subject's means at each
// level.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace steerid {

struct RepeatedMeasures {
  std::size_t subjects = 0;
  std::vector<double> level_mean;  ///< empty when there is no test
  double f = 0;
  double epsilon = 1;
  double p = 1;
  double partial_eta_squared = 0;

  [[nodiscard]] bool tested() const { return !level_mean.empty(); }
  /// Degrees of freedom before epsilon.
  [[nodiscard]] double between() const { return static_cast<double>(level_mean.size()) - 1; }
  [[nodiscard]] double within() const { return (static_cast<double>(subjects) - 1) * between(); }
};

/// `y[subject][level]`, all of equal length. There is no test of fewer than 3 subjects or 2 levels, nor of values that
/// leave no error.
[[nodiscard]] RepeatedMeasures repeated_measures(std::span<const std::vector<double>> y);

/// The regularised incomplete beta function I(x; a, b), 0 and 1 beyond the ends of [0, 1].
[[nodiscard]] double incomplete_beta(double x, double a, double b);

}  // namespace steerid
