// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a record must have before anything can be said about it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fit/gauss_newton.hpp"
#include "log/record.hpp"

namespace steerid::gap {

/// Throws BadInput, one sentence, when the record is too short, its angle never moves (or its resolution hides that),
/// both torques never change, or torque and angle have nothing to do with each other.
void require_usable(const Record& record);

/// Whether a run that leaves so much makes less than half of the motion's power.
[[nodiscard]] bool misses_most(double nrmse);

/// Throws BadInput when no parameter of the wheel is excited: then nothing that it lacks can be either. A strong effect
/// makes the deviations of J, B and C as large as they are without excitation; that is none if the closest linear
/// wheel, whose free run leaves `closest_nrmse` (fit/amplitude_fit.hpp), still makes most of the measured motion, or
/// does so beside a constant torque, `beside_offset_nrmse`, which is asked for only if that decides.
/// Sentences about single parameters that are not excited are returned.
[[nodiscard]] std::vector<std::string> require_excited(const BatchFit& fit, double closest_nrmse,
                                                       const std::function<double()>& beside_offset_nrmse);

}  // namespace steerid::gap
