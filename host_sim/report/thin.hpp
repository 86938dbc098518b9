// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Fewer points that look the same.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace steerid::report {

/// The indices, rising, of at most `keep` points of the line y over x that keep its shape: the first, the last, and of
/// each stretch between them the point that spans the largest triangle with its neighbours (LTTB: Steinarsson,
/// Downsampling Time Series for Visual Representation, 2013, section 4.2). A stretch without any finite value
/// keeps one point all the same, so that a gap stays a gap; one shorter than a stretch is closed. All indices when
/// there are `keep` or fewer; `keep` is 3 or more. Cost: linear in the number of points.
std::vector<std::size_t> thinned(std::span<const double> x, std::span<const double> y, std::size_t keep);

}  // namespace steerid::report
