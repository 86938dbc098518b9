// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What each of several changes closes of a gap that they close together.
//
// What a change closes depends on those that are made already: a reflex beside backlash helps once the backlash is
// there. No order is the right one, so that each gets the mean over orders of what it closes at its place (Shapley, A
// value for n-person games, 1953). Shapley's mean is over all n! orders; here it is over the 2 n that begin with
// another change each and go on forwards or backwards, in which each change stands at each place twice: up to three
// changes these are all. The shares of all changes sum to what they close together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace steerid::gap {

/// Of `count` changes, up to 64. `closed` is what the changes whose bits are set close together, and is asked once a
/// set.
[[nodiscard]] std::vector<double> shared_among(std::size_t count, const std::function<double(std::uint64_t)>& closed);

}  // namespace steerid::gap
