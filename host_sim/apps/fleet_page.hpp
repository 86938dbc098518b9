// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a fleet's records have in common, as files beside their answers: OUT/fleet/report.html, and each of its tables
// as CSV and JSON lines for other tools (fleet/summary_tables.hpp).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "fleet/merge.hpp"
#include "fleet/summary.hpp"
#include "report/page.hpp"

namespace steerid {

/// `out` is the folder of the answers. A number of one record leads to that record's own page, or to its answer where
/// it has no page; a count leads to a table of the records.
[[nodiscard]] report::Page fleet_page(const fleet::Summary& summary, const std::filesystem::path& out);

/// fleet::merge(), and then the files of what the records have in common; no page where the records were to have none.
/// `at_record` is told how many of how many records are merged. Throws BadInput as the merge does.
fleet::Merged merge_with_report(
    const std::vector<std::filesystem::path>& shards, const std::filesystem::path& out, bool allow_missing = false,
    const std::function<void(std::size_t done, std::size_t of)>& at_record = [](std::size_t, std::size_t) {});

}  // namespace steerid
