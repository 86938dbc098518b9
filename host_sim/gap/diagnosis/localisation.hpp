// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where the gap is: the refit's excess residual laid out along frequency, velocity, position, amplitude, time, distance
// from reversals and torque channel, each with a block-bootstrap interval, and the series that a report shows.
#pragma once

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/preparation/prepared_record.hpp"

namespace steerid::gap {

/// Fills where, axes, spectrum, map and the torque residuals of series; series' angles must be there.
void localise(Diagnosis& diagnosis, const PreparedRecord& prepared, const NoiseFloor& floor);

}  // namespace steerid::gap
