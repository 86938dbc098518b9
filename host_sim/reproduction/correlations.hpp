// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Figure 10 with its significance: how the labels of a record (task, number of hands, hand position) go along with the
// identified parameters.
//
//   r        Pearson; t = r sqrt(df/(1 - r^2)) is Student's with df = n - 2 where there is no
//            correlation, and its two-sided p is the regularised incomplete beta function I(1 - r^2; df/2, 1/2)
//   paired   the same with all else equal: of the records that share the subject and the other two labels the mean is
//            taken off, df = n - groups - 1. A subject is measured twelve times, so the records are not independent,
//            and the spread between subjects and tasks hides what a second hand does (Bakdash and Marusich 2017)
//   eta^2    share of the variance between the classes of a label. A hand position is a name, not a number; a straight
//            line through "first, second, third" can miss any pattern. F test: p = I(1 - eta^2; (n - k)/2, (k - 1)/2)
//   effect   analysis of variance with the subjects as a random effect and the positions as categories: the one test
//            here that takes records of one subject for what they are (repeated_measures.hpp). The others' p take the
//            records for independent, as figure 10 of the paper does
//   many     twelve tests at once: Holm (1979) bounds the chance of any false claim, Benjamini and Hochberg (1995) the
//            expected share of false ones
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "reproduction/experiment_run.hpp"
#include "reproduction/repeated_measures.hpp"

namespace steerid {

struct Association {
  double coefficient = 0;  ///< r or eta^2; 0 when either side never varies
  double p = 1;
};

[[nodiscard]] Association pearson(std::span<const double> x, std::span<const double> y);
/// `group[i]` from 0; every group's mean of x and y is taken off first.
[[nodiscard]] Association pearson_paired(std::span<const double> x, std::span<const double> y,
                                         std::span<const std::size_t> group);
/// `label[i]` from 0 names a class.
[[nodiscard]] Association correlation_ratio(std::span<const std::size_t> label, std::span<const double> y);

/// Adjusted p, in the order given.
[[nodiscard]] std::vector<double> holm(std::span<const double> p);
[[nodiscard]] std::vector<double> benjamini_hochberg(std::span<const double> p);

/// Counted as passive 1, active 0; one or two hands; and the grips 1 (3, 3 + 9), 2 (12, 12 + 6) and 3 (1:30, 10:10).
inline constexpr std::array<std::string_view, 3> kLabels{"task", "number of hands", "hand position"};
inline constexpr std::array<std::string_view, 4> kQuantities{"J", "B", "C", "f"};

struct LabelCorrelation {
  std::size_t label = 0;     ///< of kLabels
  std::size_t quantity = 0;  ///< of kQuantities
  std::size_t records = 0;   ///< with a valid answer
  Association plain;
  double holm_p = 1;
  double benjamini_hochberg_p = 1;
  Association paired;
  double paired_holm_p = 1;
  Association ratio;
  double ratio_holm_p = 1;
  RepeatedMeasures effect;  ///< of the subjects all of whose records have an answer
  double effect_holm_p = 1;
};

inline constexpr double kSignificance = 0.05;

/// Twelve, label by label, of the batch answers that are valid.
[[nodiscard]] std::vector<LabelCorrelation> label_correlations(std::span<const IdentifiedRecord> records);

}  // namespace steerid
