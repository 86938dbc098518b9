// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The shards of one run, checked against each other, and their records one after the other in the order that one
// machine would have them in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "fleet/shard_file.hpp"

namespace steerid::fleet {

class ShardSet {
 public:
  /// Each of `given` is a folder of answers, whose fleet/ holds tables of shards, or such a table itself. Throws
  /// BadInput when there is none; when program, options, records or the number of shards differ, naming what differs
  /// and where; and when a shard is there twice with different bytes.
  explicit ShardSet(const std::vector<std::filesystem::path>& given);

  /// Of the whole run; its `shard` and `records` say nothing.
  [[nodiscard]] const ShardHeader& question() const { return readers_.front().reader.header(); }

  /// Numbers of the shards that are not there.
  [[nodiscard]] const std::vector<std::size_t>& missing() const { return missing_; }
  [[nodiscard]] std::size_t records() const { return records_; }  ///< of the shards that are there

  /// Throws BadInput, naming them, when shards are missing.
  void require_all() const;

  /// Calls `take` with each record, by vehicle and then by name, and with the folder of its shard's answers. Once only.
  /// Throws BadInput when a shard holds a record that is not its own, or one that another has.
  void each(const std::function<void(const RecordLine&, const std::filesystem::path& answers)>& take);

 private:
  struct Source {
    ShardReader reader;
    RecordLine line;
    bool more = false;
  };
  void add(const std::filesystem::path& file);
  void advance(Source& source);

  std::vector<Source> readers_;
  std::vector<std::size_t> missing_;
  std::size_t records_ = 0;
};

}  // namespace steerid::fleet
