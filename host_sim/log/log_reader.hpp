// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Reads a drive from its log, or from several logs with clocks of their own, whatever its columns are called.
//
// The formats are those of log/log_sources.cpp, told apart by their first bytes; docs/logs.md says what each may hold.
//
// The channels: a column named in LogFormat, else the contract's. Time, angle and one of torque_bar, torque_rim,
// torque_driver and torque_motor must be there. With a bar or a rim, a channel that has no column is absent
// (Record::channels). With neither, the paper's equation holds: a torque_driver or torque_motor that has no column
// counts as zero. Units come from LogFormat, else from the column's suffix (`_ms`, `[deg]`), else from the file beside
// the name (a row of units, a DBC), else SI is taken and a note says so.
//
// The rows: a needed cell that is empty or NaN (also NA, N/A, null, none) leaves the whole row out; from the second
// such row in a sequence on it is a gap. Columns of several clocks become rows as log/one_record.hpp says. Time must
// not go back from row to row and lie within 1e10 s of zero. At least 50 rows, at 50 Hz or more.
//
// Everything else ends in BadInput with one sentence that names file, line and column. Nothing is guessed.
//
// Cost: about 60 ns a cell that is needed (150 MB/s); memory is the record itself plus, for a moment at
// the end, one more column.
#pragma once

#include <cstddef>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "log/chosen_columns.hpp"
#include "log/log_format.hpp"
#include "log/record.hpp"
#include "log/record_quality.hpp"
#include "log/stamp_limits.hpp"

namespace steerid {

inline constexpr std::size_t kFewestRows = 50;  ///< one second at the lowest rate

/// The record in `path`, in SI units, with the signs of `format`. `noticed`, when given, receives what the reader saw
/// on the way. Long files show a progress bar on a terminal.
[[nodiscard]] Record read_log(const std::filesystem::path& path, const LogFormat& format = {},
                              RecordQuality* noticed = nullptr);

/// The same of several logs of one drive, each with a clock of its own; the clocks agree.
[[nodiscard]] Record read_log(const std::vector<std::filesystem::path>& paths, const LogFormat& format = {},
                              RecordQuality* noticed = nullptr);

/// The files, each open and ready to be read once.
[[nodiscard]] std::vector<NamedLog> open_logs(const std::vector<std::filesystem::path>& paths, const LogFormat& format);

/// The same of one log from a stream; `name` stands for the file in sentences.
[[nodiscard]] Record read_log(std::istream& in, const std::string& name, const LogFormat& format = {},
                              RecordQuality* noticed = nullptr);

}  // namespace steerid
