// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The evidence of something that no set of changes holds: what shapes without a name gain on top of the best set.
//
// Torques of angle and rate, courses in time, responses of another order and channels of another gain are fitted beside
// the set (gap/sets/rivals.hpp). What the plainest of them gains beyond the price of its coefficients, and of its
// choice among all of them, divided by what is left a line, are the nats by which the record speaks for a discrepancy.
// It is a feature of the calibration (gap/sets/inclusion.hpp) and decides nothing by itself. Costs about as much as
// fitting a set.
#pragma once

#include "gap/sets/set_fit.hpp"

namespace steerid::gap {

/// Nats, 0 and more.
[[nodiscard]] double discrepancy_nats(const FittedSet& one, const SetFitter& fitter);

}  // namespace steerid::gap
