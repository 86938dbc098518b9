// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How large a slow torque a wheel's free run misses.
//
// A slow torque that changes within half a minute hardly shows in blocks of 5 to 10 s: what a block begins and ends
// with is free there (gap/likelihood/block_spectra.hpp), and so is most of what changes in between. The free run knows
// nothing of blocks. What it leaves of the angle below 1 Hz, taken back through the wheel's response, is that torque.
#pragma once

#include "gap/likelihood/whittle.hpp"
#include "gap/model/simulated_model.hpp"

namespace steerid {

/// rms over the seen blocks, as a share of the applied torque's; less what the white noise of torque and angle makes
/// of it. 0 where the run diverges. For wheels that a spring holds.
[[nodiscard]] double slow_share_of_run(const SpectralRecord& record, const Whittle& whittle, SimulatedModel& model,
                                       const Whittle::Fit& fit);

}  // namespace steerid
