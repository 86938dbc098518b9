// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The hypotheses, by kind. Each function adds its own.
#pragma once

#include <memory>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "log/resample.hpp"

namespace steerid::gap {

/// Whether an effect leaves the wheel some inertia: more than the least share that its parameter can be.
[[nodiscard]] inline bool keeps_inertia(double share, const Parameter& of) { return share > 1.01 * of.low; }

/// An edge in time is soft over a sample to either side of it, so that a fit can move it.
inline constexpr double kSoftEdge_s = 2 / kResampledRateHz;

using Hypotheses = std::vector<std::unique_ptr<Hypothesis>>;

template <class... Each>
void add(Hypotheses& all) {
  (all.push_back(std::make_unique<Each>()), ...);
}

void add_friction_hypotheses(Hypotheses& all);  ///< of the rate and its history
void add_spring_hypotheses(Hypotheses& all);    ///< of the angle
void add_time_hypotheses(Hypotheses& all);      ///< of time
void add_response_hypotheses(Hypotheses& all);  ///< linear: a changed response
void add_hands_off_hypothesis(Hypotheses& all);

}  // namespace steerid::gap
