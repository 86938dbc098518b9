// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The shards of a run brought together: the same files, to the byte, as one machine writes that answers all records, in
// however many shards they were answered.
//
//   OUT/table.csv             a row a record (answer_table.hpp)
//   OUT/NAME/...              every record's own answer, where the shards' folders have it
//   OUT/fleet/records.jsonl   a line a record, as in the tables of the shards
//
// Records pass one by one, so that memory does not grow with their number.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "fleet/shard_file.hpp"

namespace steerid::fleet {

struct MergeOptions {
  bool allow_missing = false;  ///< merge the shards that are there, and say which are not
  /// Hears of every record once it is merged, in their order.
  std::function<void(const RecordLine&, std::size_t done, std::size_t of)> at_record = [](const RecordLine&,
                                                                                          std::size_t, std::size_t) {};
  /// Hears, before any record, what they were asked.
  std::function<void(const ShardHeader&)> at_question = [](const ShardHeader&) {};
};

struct Merged {
  std::size_t records = 0;
  std::size_t answered = 0;
  std::size_t unusable = 0;
  std::size_t faults = 0;
  std::vector<std::size_t> missing_shards;
  std::size_t missing_records = 0;
  std::size_t without_files = 0;  ///< answered, but their own answer is in no shard's folder
};

/// `shards` as ShardSet takes them. Answers that lie in another folder than `out` are linked into it, or copied where
/// that cannot be done. Nothing of OUT/table.csv and OUT/fleet takes its place before all is written. Throws BadInput.
Merged merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& out,
             const MergeOptions& options);

}  // namespace steerid::fleet
