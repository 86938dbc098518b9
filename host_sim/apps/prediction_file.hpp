// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The angle that someone's own simulator takes under a record's torques: the columns time_s and angle_rad of a CSV file
// as a log may be (log/csv_source.hpp), the clock that of the record. Other columns are not looked at.
#pragma once

#include <filesystem>
#include <vector>

#include "log/record.hpp"

namespace steerid {

/// One angle a sample of `record`, rad: that of the stamp, or between stamps at most 20 ms apart the cubic through the
/// four nearest. Throws BadInput, naming the file and where it can the line, for whatever is no such file, and where it
/// lacks a stamp of the record, or moves more than 29 times as far as the record: half of what degrees make of radians.
[[nodiscard]] std::vector<double> read_prediction(const std::filesystem::path& file, const Record& record);

}  // namespace steerid
