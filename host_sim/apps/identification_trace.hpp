// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The recursive estimate after every tick, as CSV or MCAP: `steerid identify --trace`.
#pragma once

#include <filesystem>

#include "apps/firmware_run.hpp"
#include "log/table_writer.hpp"

namespace steerid {

/// time_s of the record, in a fault too; for each parameter its value, standard deviation and state; what a take-over
/// has to know of the driver:
///   time_s,inertia_kgm2,inertia_sd_kgm2,inertia_state,damping_nms_per_rad,...,stiffness_nm_per_rad,...,
///   driver_state,hands
/// then the 95 % interval of each: inertia_low_kgm2,inertia_high_kgm2,...
/// The file appears whole or not at all. An unknown standard deviation is an empty cell, and so are its interval's
/// ends.
void write_trace(const std::filesystem::path& target, const FirmwareRun& run,
                 McapMessages messages = McapMessages::kCdr);

/// What an MCAP file's topic is called after: /steerid/estimate.
inline constexpr const char* kTraceTable = "estimate";

}  // namespace steerid
