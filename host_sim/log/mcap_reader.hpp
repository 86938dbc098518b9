// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The messages of an MCAP file, one after the other, out of chunks or loose. The format: https://mcap.dev/spec.
//
// Read are Schema, Channel, Message and Chunk; attachments, metadata, indexes and the summary are passed over, so that
// a file which a recorder did not finish is read up to its end. Chunks may be packed by lz4 or zstd; their checksums
// are held. Memory: a chunk, of 256 MiB at most.
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <string>
#include <string_view>

namespace steerid {

struct McapSchema {
  std::string name;
  std::string encoding;  ///< "jsonschema", "ros2msg"; empty for none
  std::string text;
};

struct McapChannel {
  std::string topic;
  std::string encoding;  ///< of its messages: "json", "cdr"
  McapSchema schema;
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_ns = 0;      ///< when it was recorded
  std::uint64_t publish_ns = 0;  ///< when it was sent, or when it was recorded
  std::string_view data{};       ///< until the next one
};

[[nodiscard]] bool is_mcap(std::string_view first_bytes);

class McapReader {
 public:
  /// `name` stands for the file in sentences. Both outlive the reader.
  McapReader(std::istream& in, const std::string& name);

  /// False at the end. Throws BadInput where the file is none.
  bool next(McapMessage& message);

  /// Of the last message; those of a channel are the same all through the file.
  [[nodiscard]] const McapChannel& channel(std::uint16_t id) const { return channels_.at(id); }

  /// True at the end where the file ends in mid-record, or without saying that it ends.
  [[nodiscard]] bool cut() const { return cut_; }

 private:
  struct Piece {
    std::uint8_t kind = 0;
    std::string_view content{};
  };

  bool next_piece(Piece& piece);
  bool piece_of_chunk(Piece& piece);
  bool read_content(std::uint64_t size);
  void pass_over(std::uint64_t size);
  void unpack_chunk();
  void take_schema(std::string_view content);
  void take_channel(std::string_view content);
  [[nodiscard]] McapMessage message_of(std::string_view content) const;
  [[noreturn]] void complain(const std::string& expected) const;

  std::istream& in_;
  const std::string& name_;
  std::uint64_t read_ = 0;
  bool cut_ = false;
  bool done_ = false;
  std::string content_{};  ///< of the file's present record
  std::string chunk_{};    ///< unpacked
  std::size_t used_ = 0;   ///< of it
  std::map<std::uint16_t, McapSchema> schemas_{};
  std::map<std::uint16_t, McapChannel> channels_{};
};

}  // namespace steerid
