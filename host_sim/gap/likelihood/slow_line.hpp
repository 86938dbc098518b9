// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether what passes for a slow torque is a single tone.
//
// A torque that nobody measured is a course of its own: over the lines on which it stands above the other noise its
// power is spread as its colour says. A steady sinusoid near 1 Hz makes the slow torque large enough to hold it, and
// then stands alone in the middle of all those lines.
#pragma once

#include "gap/likelihood/whittle.hpp"

namespace steerid {

/// The share of one frequency, a line and a half either way in every block, in what is left over the density expected
/// there, over the lines of `fit`'s seen blocks on which its slow torque is more than half of that. A slow torque's is
/// some three lines of ten, a sinusoid's nearly all. 0 where there are too few lines to tell.
[[nodiscard]] double slow_line_share(const Whittle& whittle, ResidualModel& model, const Whittle::Fit& fit);

}  // namespace steerid
