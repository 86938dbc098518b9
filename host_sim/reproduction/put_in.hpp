// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What was put into the virtual drivers, beside what was found of it. The drivers are drawn from tables I and II and
// from three factors for both arms (experiment/virtual_subject.hpp), so a table that looks like the paper's says only
// that the identification gives back what it was given. One line for each thing put in: the same statistic of the true
// arms and of the answers.
#pragma once

#include <string>
#include <vector>

#include "reproduction/table_rows.hpp"

namespace steerid {

struct PutIn {
  std::string what;    ///< "J, passive over active"
  std::string unit;    ///< empty for a ratio
  std::string origin;  ///< where it comes from
  Spread truth;
  Spread plain;   ///< valid batch answers, as the paper excites
  Spread probed;  ///< likewise, with the probe
};

/// Ratios of J, B and C between the tasks, between both arms and one and between the positions, each of two records of
/// one subject that differ in nothing else; then the ranges of J, B and C in each task.
[[nodiscard]] std::vector<PutIn> put_in(const ExperimentRun& run);

}  // namespace steerid
