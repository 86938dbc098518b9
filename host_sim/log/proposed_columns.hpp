// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whole --columns line that a log's names and units suggest, for people to look at and to hand on.
#pragma once

#include <string>
#include <vector>

#include "log/chosen_columns.hpp"
#include "log/log_format.hpp"

namespace steerid {

/// `said`, with what its channels lack filled in by likeness (log/column_guess.hpp), each with its unit where the name
/// or the file states one.
[[nodiscard]] ColumnChoices proposed_columns(const std::vector<NamedLog>& logs, const ColumnChoices& said);

/// As --columns takes it: "time=t:ms,angle=theta:deg".
[[nodiscard]] std::string columns_text(const ColumnChoices& choices);

}  // namespace steerid
