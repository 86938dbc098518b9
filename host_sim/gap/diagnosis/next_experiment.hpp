// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The next experiment: the probe that would settle what a record leaves unsettled among sets of changes.
//
// A change is unsettled where its probability, or that of the sets that judge it otherwise than the answer does, lies
// between 5 and 95 %. Its rival is the likeliest of those sets; it counts with that probability. So does the answer
// without that change: the probe's record is diagnosed alone, and a change that does not show in it is not named.
// Whether J, B and C are those given is no question here: they are free in every drive.
//
// An unmeasured torque, and what begins or ends at instants, has a course in time that another drive has not. It cannot
// be simulated ahead: sets that differ by it alone are told apart by no probe.
#pragma once

#include "gap/diagnosis/best_probe.hpp"
#include "gap/diagnosis/set_answer.hpp"

namespace steerid::gap {

/// Where nothing is unsettled, or no probe would settle it, `separates` is empty and `why` says so.
[[nodiscard]] NextExperiment next_experiment(const SetAnswer& found, const PreparedRecord& prepared);

}  // namespace steerid::gap
