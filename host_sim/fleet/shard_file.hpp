// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The table of one shard: OUT/fleet/shard_3_of_10.jsonl. Its first line says to what question and to which records the
// others are answers; each other line is one record, by vehicle and then by name:
//
//   {"schema":"steerid.shard/1","command":"diagnose","program":sha256,"options":{..},"shard":3,"of":10,
//    "records":4,"records_in_all":40,"list_sha256":..}
//   {"record":"a17","log":"a17/log.csv","vehicle":"VIN042","date":"2026-05-01","mileage_km":10412.5,
//    "ended":"answered"|"unusable"|"fault","error":"","made_from":{..},"answer":{..}}
//
// The file appears whole, when every record of the shard has its line: where it is, the shard is done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "fleet/record_list.hpp"
#include "fleet/shard.hpp"

namespace steerid::fleet {

/// Folder of all that is about more than one record, in the folder of the answers.
inline constexpr const char* kFleetFolder = "fleet";

/// What all shards of a run have in common, and which of them this one is.
struct ShardHeader {
  std::string command;             ///< "diagnose" or "identify"
  std::string program;             ///< SHA-256 of the program itself
  nlohmann::ordered_json options;  ///< what an answer hangs on beside the files
  Shard shard;
  std::size_t records = 0;  ///< of this shard
  std::size_t records_in_all = 0;
  std::string list_sha256;  ///< digest_of() all records
};

[[nodiscard]] std::string to_line(const ShardHeader& header);

/// "shard_3_of_10.jsonl"
[[nodiscard]] std::string shard_file_name(const Shard& shard);

enum class Ended : std::uint8_t {
  kAnswered,
  kUnusable,  ///< the data are at fault
  kFault,     ///< this program is
};

/// How it ended with one record.
struct RecordLine {
  ListedRecord record;
  Ended ended = Ended::kAnswered;
  std::string error;                 ///< why there is no answer
  nlohmann::ordered_json made_from;  ///< {"log":{"bytes":,"sha256":},"sim":{..}}; null where they could not be read
  nlohmann::ordered_json answer;     ///< null without one
};

/// One line of JSON, line feed included. Bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string to_line(const RecordLine& line);

/// Reads a shard's table line by line; holds one block of it, and the file open only while it reads that block, so that
/// thousands of them can be merged.
class ShardReader {
 public:
  /// Throws BadInput when the file is no shard's table.
  explicit ShardReader(std::filesystem::path file);

  [[nodiscard]] const ShardHeader& header() const { return header_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  /// The next record's line; false at the end. Throws BadInput when the file is damaged or has fewer or more lines than
  /// its header says.
  bool next(RecordLine& line);

 private:
  bool next_text(std::string& text);
  [[noreturn]] void complain(const std::string& expected, const std::string& found) const;

  std::filesystem::path file_;
  ShardHeader header_;
  std::string block_;
  std::size_t at_ = 0;        // in the block
  std::uint64_t offset_ = 0;  // of the block's end in the file
  std::size_t number_ = 0;    // of the line
};

}  // namespace steerid::fleet
