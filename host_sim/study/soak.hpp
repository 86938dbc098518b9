// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Millions of updates of the firmware's task, in float and in fixed point, over excited, quiet, held, switched-off and
// faulty stretches (soak_drive.hpp), 20 s of each and now and then half an hour of nothing; and hours of exactly zero
// input from the start.
//
//   unsound        updates after which a number was not finite, D not positive or a parameter outside its limits
//   least D        the smallest element of D in P = U D U' (identifier/ud_covariance.hpp) that there ever was
//   overflows      fixed point: operations that ran out of range
//   right again    excited stretches that end valid and within 5 % of the truth
#pragma once

#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct SoakStudy {
  std::uint64_t updates = 20'000'000;  ///< of each kind of number
  std::uint64_t seed = 1;
};

/// Figures: tables "soak" and "zeros", rows "float" and "fixed". The zeros last a fifth as long, 11 hours at full size.
[[nodiscard]] Findings run_soak_study(const SoakStudy& study, const StudyProgress& at);

}  // namespace steerid
