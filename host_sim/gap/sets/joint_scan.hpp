// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which effects explain together what a model leaves, by least squares before anything is fitted.
//
// Where several effects are missing, the best single one makes up for the others, and so do J, B and C: a search that
// adds one effect after another ends where no single step leads on. So all subsets of two and of three candidates are
// compared (regression by all subsets; Furnival and Wilson, Technometrics 16, 1974). The column of a candidate is what
// one of its starting values changes in the prediction, whitened. What the model's own numbers can do is projected out,
// J, B and C with their prior: a column is a slope, and right near the simulation's J, B and C alone.
//
// An effect of a subset counts where it takes off kLeast times the nats that are left a line, beside the others. Costs
// one evaluation of the model a starting value, some tens in all, and a regression of three numbers a subset, some ten
// thousands.
#pragma once

#include <vector>

#include "gap/sets/spectral_search.hpp"

namespace steerid::gap {

/// Nats over the dispersion: what an added number costs at least.
inline constexpr double kLeast = 4;

/// What effects are looked for beside.
struct JointSetting {
  const SpectralRecord& record;
  const Parts& parts;
  const SearchOrigin& origin;  ///< a point of the model of `parts`, with its scan
  const Spectrum& offset;      ///< of the model (gap/model/spectral_model.hpp)
  double wheel_sd = 0;         ///< prior of J, B and C, a share of each
};

struct JointCandidate {
  const Hypothesis* hypothesis = nullptr;
  std::vector<StartingPoint> points{};
};

/// Effects at values to begin a fit from.
struct JointStart {
  std::vector<const Hypothesis*> added{};
  Point at{};       ///< of the model, with those that are added behind its own
  double nats = 0;  ///< that they explain
};

/// The best subsets of two and of three, `count` of either at most; subsets that differ by kinds of a family count as
/// one.
[[nodiscard]] std::vector<JointStart> joint_starts(const JointSetting& setting,
                                                   const std::vector<JointCandidate>& candidates, std::size_t count);

}  // namespace steerid::gap
