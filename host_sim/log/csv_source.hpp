// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A CSV file as a log.
//
// UTF-8, UTF-16 or Latin-1; commas, semicolons or tabs; decimal point, or decimal comma where that does not separate
// cells; names in quotes; units in a row of their own; lines that start with # and blank lines anywhere; LF or CRLF.
// Time stamps may be numbers or date and time (log/time_text.hpp). Cells that are not wanted are passed over unread.
//
// Cost: about 60 ns a cell that is wanted (150 MB/s).
#pragma once

#include <memory>

#include "log/log_source.hpp"

namespace steerid {

/// Throws BadInput when there is no line of names.
[[nodiscard]] std::unique_ptr<LogSource> open_csv(OpenedLog log);

}  // namespace steerid
