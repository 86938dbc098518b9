// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Sets of changes that several records of one wheel speak for together.
//
// The records are independent given the wheel, so that log evidences add. J, B and C are every record's own (an arm is
// another one in every drive). The sizes of what is changed are the wheel's (gap/sets/shared_sizes.hpp) where one size
// explains all records; that they differ is no reason to name something else, and is said instead
// (gap/diagnosis/together.hpp).
#pragma once

#include <span>

#include "gap/sets/searched_sets.hpp"

namespace steerid::gap {

/// The most likely sets of every record, as one record's: misfits, penalties and costs are sums, all else is the first
/// record's. A set that another record has visited is fitted to a record that has not, and joins what it has visited.
[[nodiscard]] SearchedSets joint_sets(std::span<const RecordSets> records);

/// Fits the set to the records that have not visited it, and all of them with sizes in common where these are taken.
void fit_together(std::span<const RecordSets> records, const FittedSet& wanted);

}  // namespace steerid::gap
