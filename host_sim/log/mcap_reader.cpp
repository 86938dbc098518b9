// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/mcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "log/bad_input.hpp"
#include "log/byte_reader.hpp"
#include "log/mcap_format.hpp"
#include "log/packed_bytes.hpp"

namespace steerid {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;  // of a record or a chunk; recorders make some MiB
constexpr std::size_t kHead = 9;                                // kind and length

}  // namespace

bool is_mcap(std::string_view first_bytes) { return first_bytes.starts_with(mcap::kMagic); }

McapReader::McapReader(std::istream& in, const std::string& name) : in_(in), name_(name) {
  if (!read_content(mcap::kMagic.size()) || !is_mcap(content_)) complain("the first bytes of an MCAP file");
}

bool McapReader::next(McapMessage& message) {
  Piece piece;
  while (next_piece(piece)) {
    switch (piece.kind) {
      case mcap::kSchema:
        take_schema(piece.content);
        break;
      case mcap::kChannel:
        take_channel(piece.content);
        break;
      case mcap::kMessage:
        message = message_of(piece.content);
        return true;
      default:
        break;
    }
  }
  return false;
}

/// The next record, out of a chunk or of the file.
bool McapReader::next_piece(Piece& piece) {
  while (!done_) {
    if (piece_of_chunk(piece)) return true;
    if (!read_content(kHead)) break;
    ByteReader head(content_);
    piece.kind = static_cast<std::uint8_t>(head.whole(1));
    const std::uint64_t size = head.u64();
    switch (piece.kind) {
      case mcap::kDataEnd:
      case mcap::kFooter:
        done_ = true;
        return false;
      case mcap::kSchema:
      case mcap::kChannel:
      case mcap::kMessage:
      case mcap::kChunk:
        if (size > kMostBytes) complain("a record of 256 MiB or less");
        if (!read_content(size)) break;
        if (piece.kind != mcap::kChunk) {
          piece.content = content_;
          return true;
        }
        unpack_chunk();
        continue;
      case 0:
        complain("a record's kind");
      default:
        pass_over(size);
        if (!cut_) continue;
        break;
    }
    break;
  }
  cut_ = !done_;
  done_ = true;
  return false;
}

bool McapReader::piece_of_chunk(Piece& piece) {
  if (used_ == chunk_.size()) return false;
  ByteReader records(std::string_view(chunk_).substr(used_));
  piece.kind = static_cast<std::uint8_t>(records.whole(1));
  piece.content = records.bytes(records.u64());
  if (!records.ok()) complain("whole records in a chunk");
  used_ = chunk_.size() - records.rest().size();
  return true;
}

/// False where the file ends before.
bool McapReader::read_content(std::uint64_t size) {
  constexpr std::uint64_t kStep = std::uint64_t{1} << 20;  // what is promised may not be there
  content_.clear();
  while (content_.size() < size) {
    const std::size_t before = content_.size();
    content_.resize(before + std::min(size - before, kStep));
    in_.read(content_.data() + before, static_cast<std::streamsize>(content_.size() - before));
    const auto got = static_cast<std::size_t>(in_.gcount());
    read_ += got;
    if (before + got < content_.size()) return false;
  }
  return true;
}

void McapReader::pass_over(std::uint64_t size) {
  constexpr std::uint64_t kStep = std::uint64_t{1} << 40;
  while (size > 0 && in_) {
    const std::uint64_t step = std::min(size, kStep);
    in_.ignore(static_cast<std::streamsize>(step));
    size -= step;
    read_ += static_cast<std::uint64_t>(in_.gcount());
  }
  cut_ = !in_;
}

void McapReader::unpack_chunk() {
  ByteReader fields(content_);
  (void)fields.bytes(16);  // the first and the last stamp
  const std::uint64_t size = fields.u64();
  const std::uint32_t checksum = fields.u32();
  const std::string_view method = fields.text();
  const std::string_view packed = fields.bytes(fields.u64());
  if (!fields.ok() || size > kMostBytes) complain("a chunk of 256 MiB or less");
  auto records = unpacked(method, packed, size);
  if (!records) {
    complain(method.empty() || method == "lz4" || method == "zstd" ? "a chunk that unpacks"
                                                                   : "a chunk packed by lz4, zstd or not at all");
  }
  if (checksum != 0 && crc32_of(*records) != checksum) complain("a chunk that has its checksum");
  chunk_ = std::move(*records);
  used_ = 0;
}

void McapReader::take_schema(std::string_view content) {
  ByteReader fields(content);
  const std::uint16_t id = fields.u16();
  McapSchema schema{
      .name = std::string(fields.text()), .encoding = std::string(fields.text()), .text = std::string(fields.text())};
  if (!fields.ok()) complain("a whole schema");
  schemas_.try_emplace(id, std::move(schema));
}

void McapReader::take_channel(std::string_view content) {
  ByteReader fields(content);
  const std::uint16_t id = fields.u16();
  const std::uint16_t schema = fields.u16();
  McapChannel channel{.topic = std::string(fields.text()), .encoding = std::string(fields.text()), .schema = {}};
  if (!fields.ok()) complain("a whole channel");
  if (const auto found = schemas_.find(schema); found != schemas_.end()) {
    channel.schema = found->second;
  } else if (schema != 0) {
    complain("a channel's schema before the channel");
  }
  channels_.try_emplace(id, std::move(channel));
}

McapMessage McapReader::message_of(std::string_view content) const {
  ByteReader fields(content);
  McapMessage message{.channel = fields.u16()};
  (void)fields.u32();  // counts the channel's messages
  message.log_ns = fields.u64();
  message.publish_ns = fields.u64();
  if (!fields.ok()) complain("a whole message");
  if (!channels_.contains(message.channel)) complain("a message's channel before the message");
  message.data = fields.rest();
  return message;
}

void McapReader::complain(const std::string& expected) const {
  throw bad_input({.file = name_,
                   .expected = expected,
                   .found = fmt::format("something else before byte {}", read_),
                   .advice = "copy the file anew, or mend it by `mcap recover`"});
}

}  // namespace steerid
