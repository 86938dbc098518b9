// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Reads a drive from a CSV file of any column names.
//
// The file: an optional UTF-8 byte-order mark, a header line with the columns' names, one row a sample. Lines that
// start with # and blank lines may stand anywhere. LF or CRLF. Cells are separated by commas, semicolons or tabs,
// whichever the header holds most of; they may be quoted and have spaces around them. Decimal point, no decimal comma.
// Columns that no channel needs are passed over unread.
//
// The channels: a column named in LogFormat, else the contract's. Time, angle and one of torque_bar, torque_rim,
// torque_driver and torque_motor must be there. With a bar or a rim, a channel that has no column is absent
// (Record::channels). With neither, the paper's equation holds: a torque_driver or torque_motor that has no column
// counts as zero. Units come from LogFormat, else from the column's suffix (`_ms`, `_deg`), else SI is taken and a note
// says so.
//
// The rows: a needed cell that is empty or NaN (also NA, N/A, null, none) leaves the whole row out; from the second
// such row in a sequence on it is a gap. Time must increase from row to row
// and lie within 1e10 s of zero. At least 50 rows, at 50 Hz or more.
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

#include "log/log_format.hpp"
#include "log/record.hpp"
#include "log/record_quality.hpp"

namespace steerid {

inline constexpr std::size_t kFewestRows = 50;  ///< one second at the lowest rate
inline constexpr double kLowestRateHz = 50.0;
inline constexpr double kLatestTimeS = 1e10;  ///< a double there still tells 2 us apart; an epoch in seconds is 2e9

/// The record in `path`, in SI units, with the signs of `format`. `noticed`, when given, receives what the reader saw
/// on the way. Long files show a progress bar on a terminal.
[[nodiscard]] Record read_log(const std::filesystem::path& path, const LogFormat& format = {},
                              RecordQuality* noticed = nullptr);

/// The same from a stream; `name` stands for the file in sentences.
[[nodiscard]] Record read_log(std::istream& in, const std::string& name, const LogFormat& format = {},
                              RecordQuality* noticed = nullptr);

}  // namespace steerid
