// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a study works out of every drive of every case, on all cores.
#pragma once

#include <cstddef>
#include <vector>

#include "parallel/work_in_parallel.hpp"
#include "study/findings.hpp"

namespace steerid {

/// answers[case][drive] of `answer_of(case, number of the drive)`; the order of the work changes nothing.
template <class Answer, class Case, class AnswerOf>
[[nodiscard]] std::vector<std::vector<Answer>> answers_of_drives(const std::vector<Case>& cases, std::size_t drives,
                                                                 const StudyProgress& at, const AnswerOf& answer_of) {
  std::vector<std::vector<Answer>> answers(cases.size(), std::vector<Answer>(drives));
  const std::size_t jobs = cases.size() * drives;
  work_in_parallel(
      jobs, 0, [&](std::size_t done) { at(done, jobs); },
      [&](std::size_t job) { answers[job / drives][job % drives] = answer_of(cases[job / drives], job % drives); });
  return answers;
}

}  // namespace steerid
