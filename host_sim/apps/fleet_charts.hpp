// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The charts of a fleet's page.
#pragma once

#include <string>
#include <vector>

#include "apps/record_links.hpp"
#include "fleet/summary.hpp"
#include "report/parts.hpp"

namespace steerid {

/// Those that stand above the table of this key (fleet/summary_tables.hpp); none where nothing is to be seen.
[[nodiscard]] std::vector<report::Part> fleet_charts(const std::string& table, const fleet::Summary& summary,
                                                     const RecordLinks& links);

}  // namespace steerid
