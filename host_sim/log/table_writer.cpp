// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/table_writer.hpp"

#include "log/csv_writer.hpp"
#include "log/mcap_writer.hpp"

namespace steerid {

bool is_mcap_name(const std::filesystem::path& target) { return target.extension() == ".mcap"; }

std::unique_ptr<TableWriter> open_table(const std::filesystem::path& target, const Table& table) {
  if (is_mcap_name(target)) return std::make_unique<McapWriter>(target, table);
  return std::make_unique<CsvWriter>(target, table.columns, table.comments);
}

}  // namespace steerid
