// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Monte Carlo studies: many seeded drives with a known answer, every method on the very same records.
//
//   efficiency    three arms, two noise levels, six methods: how far from the Cramer-Rao bound each one is
//   uncertainty   three arms, five kinds of noise, the project's own methods: whether a stated deviation is one
//
// Runs on every core. A drive depends on the seed, its case and its number only, and results are put in their place by
// number: the answer is the same bits on any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "study/estimators.hpp"
#include "study/score.hpp"
#include "study/steady_drive.hpp"

namespace steerid {

struct StudyCase {
  std::string wheel;  ///< "relaxed"
  std::string noise;  ///< "angle 0.03 degree"
  SteadyDrive drive;
};

struct StudyPlan {
  std::string name;
  std::string title;
  std::vector<StudyCase> cases;
  std::vector<Method> methods;
};

[[nodiscard]] StudyPlan efficiency_study();
[[nodiscard]] StudyPlan uncertainty_study();

/// All studies, in the order of the help text.
[[nodiscard]] std::vector<StudyPlan> all_studies();

struct CaseResult {
  StudyCase what;
  std::vector<MethodScore> scores;  ///< one a method of the plan
};

struct StudyResult {
  StudyPlan plan;
  std::size_t drives = 0;  ///< of each case
  std::uint64_t seed = 0;
  std::vector<CaseResult> cases;
};

/// `threads` 0: one a core. `at_drive` is told, on the calling thread, how many drives are done.
[[nodiscard]] StudyResult run_study(
    const StudyPlan& plan, std::size_t drives, std::uint64_t seed, unsigned threads = 0,
    const std::function<void(std::size_t done)>& at_drive = [](std::size_t) {});

}  // namespace steerid
