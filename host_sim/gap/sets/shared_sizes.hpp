// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The sizes of a set's changes, where several records of one wheel have them in common.
//
// An effect is the wheel's, whatever is driven: one size explains all records, or else it is another one in each. With
// S_r what record r tells of the sizes s, all its other numbers free (the Schur complement of its information, over its
// excess), they have
//
//   s = (sum S_r)^-1 sum S_r s_r,   covariance (sum S_r)^-1
//
// and each record is fitted anew with them held: by its own J, B and C, and by what is a drive's own, such as instants,
// phases and the shares that no simulation is trusted in (Hypothesis::sizes()). Where that is not taken the sizes of
// the record that tells most are tried. A size in common is paid for once; it is taken where the records are likelier
// with it, the prior odds included.
//
// Cost: one fit a record, or two, with few numbers free.
#pragma once

#include <span>

#include "gap/sets/searched_sets.hpp"

namespace steerid::gap {

/// Puts the fits with sizes in common in the place of the records' own fits of the set, all of which have been visited,
/// where these sizes are taken. The own one stays as FittedSet::apart. Of a set that was asked about before nothing is
/// done.
void share_sizes(std::span<const RecordSets> records, const EffectSet& set);

}  // namespace steerid::gap
