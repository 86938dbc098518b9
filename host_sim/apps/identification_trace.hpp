// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The recursive estimate after every tick, as CSV: `steerid identify --trace`.
#pragma once

#include <filesystem>

#include "apps/firmware_run.hpp"

namespace steerid {

/// time_s of the record, in a fault too; for each parameter its value, standard deviation and state; what a take-over
/// has to know of the driver:
///   time_s,inertia_kgm2,inertia_sd_kgm2,inertia_state,damping_nms_per_rad,...,stiffness_nm_per_rad,...,driver_state,hands
/// The file appears whole or not at all. An unknown standard deviation is an empty cell.
void write_trace(const std::filesystem::path& target, const FirmwareRun& run);

}  // namespace steerid
