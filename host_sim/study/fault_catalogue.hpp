// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every defect that the study of faults goes through, and mixtures of two.
#pragma once

#include <vector>

#include "study/faulty_drive.hpp"

namespace steerid {

/// Each defect of host_sim/sensors and of the bus: stuck, swapped and turned-round channels, bias, drift, gain, lag,
/// delay, saturation, noise, losses, jitter, extreme integers, stamps that stand still, repeat or jump a day.
[[nodiscard]] const std::vector<Fault>& all_faults();

/// Both at once; not visible when either is not.
[[nodiscard]] Fault both(const Fault& first, const Fault& second);

}  // namespace steerid
