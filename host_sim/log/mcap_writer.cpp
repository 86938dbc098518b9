// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/mcap_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "log/mcap_format.hpp"
#include "log/packed_bytes.hpp"

namespace steerid {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr std::uint16_t kOnly = 1;  // schema and channel
constexpr std::string_view kMetadataName = "steerid";

template <class Whole>
void put(std::string& to, Whole value) {
  for (std::size_t i = 0; i < sizeof(Whole); ++i) to += static_cast<char>(value >> (8 * i) & 0xffU);
}

void put_text(std::string& to, std::string_view text) {
  put(to, static_cast<std::uint32_t>(text.size()));
  to += text;
}

std::string record(mcap::Kind kind, std::string_view content) {
  std::string text;
  text += static_cast<char>(kind);
  put(text, static_cast<std::uint64_t>(content.size()));
  return text.append(content);
}

/// "estimate" becomes "Estimate".
std::string type_name(std::string_view what) {
  std::string name(what);
  if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& target, Table table) : file_(target), table_(std::move(table)) {
  write(mcap::kMagic);
  std::string header;
  put_text(header, table_.messages == McapMessages::kCdr ? "ros2" : "");
  put_text(header, "steerid");
  write(record(mcap::kHeader, header));
  if (table_.comments.empty()) return;
  std::string pairs;
  put_text(pairs, "comment");
  put_text(pairs, fmt::format("{}", fmt::join(table_.comments, "\n")));
  std::string metadata;
  put_text(metadata, kMetadataName);
  put_text(metadata, pairs);
  metadata_at_ = at_;
  write(record(mcap::kMetadata, metadata));
  metadata_bytes_ = at_ - metadata_at_;
}

McapWriter& McapWriter::cell(double value) {
  row_.emplace_back(value);
  return *this;
}

McapWriter& McapWriter::cell(double value, int digits) {
  if (!std::isfinite(value)) return cell(value);
  return cell(std::stod(fmt::format("{:.{}f}", value, digits)));  // as a reader of CSV has it
}

McapWriter& McapWriter::cell(std::string_view text) {
  row_.emplace_back(std::string(text));
  return *this;
}

void McapWriter::end_row() {
  if (row_.size() != table_.columns.size()) {
    throw std::logic_error(fmt::format("a row of {} cells under {} columns", row_.size(), table_.columns.size()));
  }
  if (channel_.empty()) begin_channel();
  const std::uint64_t ns = stamp_ns();
  if (records_.empty()) {
    records_ = schema_ + channel_;
    chunk_first_ns_ = ns;
  }
  put(index_, ns);
  put(index_, static_cast<std::uint64_t>(records_.size()));
  std::string content;
  put(content, kOnly);
  put(content, static_cast<std::uint32_t>(rows_));
  put(content, ns);
  put(content, ns);
  content += message();
  records_ += record(mcap::kMessage, content);
  if (rows_ == 0) first_ns_ = ns;
  last_ns_ = ns;
  ++rows_;
  row_.clear();
  if (records_.size() >= kChunkBytes) write_chunk();
}

void McapWriter::commit() {
  if (!records_.empty()) write_chunk();
  std::string end;
  put(end, checksum_);
  write(record(mcap::kDataEnd, end));
  write_summary();
  write(mcap::kMagic);
  file_.commit();
}

void McapWriter::write(std::string_view bytes) {
  file_.write(bytes);
  at_ += bytes.size();
  checksum_ = crc32_of(bytes, checksum_);
}

/// The first row tells texts from numbers.
void McapWriter::begin_channel() {
  const bool cdr = table_.messages == McapMessages::kCdr;
  const std::string type = type_name(table_.what);
  std::string schema;
  put(schema, kOnly);
  put_text(schema, cdr ? "steerid/msg/" + type : "steerid." + type);
  put_text(schema, cdr ? "ros2msg" : "jsonschema");
  put_text(schema, schema_text());
  std::string channel;
  put(channel, kOnly);
  put(channel, kOnly);
  put_text(channel, "/steerid/" + table_.what);
  put_text(channel, cdr ? "cdr" : "json");
  put_text(channel, "");  // no metadata
  schema_ = record(mcap::kSchema, schema);
  channel_ = record(mcap::kChannel, channel);
}

std::uint64_t McapWriter::stamp_ns() {
  const auto time = std::ranges::find(table_.columns, "time_s");
  if (time == table_.columns.end()) throw std::logic_error("messages without a column time_s");
  const double time_s = std::get<double>(row_[static_cast<std::size_t>(time - table_.columns.begin())]);
  if (rows_ == 0) zero_s_ = std::min(0.0, time_s);
  return static_cast<std::uint64_t>(std::llround((time_s - zero_s_) * 1e9));
}

std::string McapWriter::schema_text() const {
  const bool cdr = table_.messages == McapMessages::kCdr;
  std::string text;
  nlohmann::ordered_json properties = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < row_.size(); ++i) {
    const bool number = std::holds_alternative<double>(row_[i]);
    text += (number ? "float64 " : "string ") + table_.columns[i] + "\n";
    properties[table_.columns[i]] = {{"type", number ? "number" : "string"}};
  }
  if (cdr) return text;
  return nlohmann::ordered_json{
      {"title", "steerid." + type_name(table_.what)}, {"type", "object"}, {"properties", std::move(properties)}}
      .dump();
}

std::string McapWriter::message() const {
  if (table_.messages == McapMessages::kJson) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (const auto* text = std::get_if<std::string>(&row_[i])) {
        json[table_.columns[i]] = *text;
      } else if (const double value = std::get<double>(row_[i]); std::isfinite(value)) {
        json[table_.columns[i]] = value;
      }
    }
    return json.dump();
  }
  const std::string head("\0\1\0\0", 4);  // plain CDR, the lowest byte first
  std::string body;
  const auto align = [&](std::size_t step) { body.resize((body.size() + step - 1) / step * step, '\0'); };
  for (const Cell& cell : row_) {
    if (const auto* text = std::get_if<std::string>(&cell)) {
      align(4);
      put(body, static_cast<std::uint32_t>(text->size() + 1));
      body.append(*text).push_back('\0');
    } else {
      const double value = std::get<double>(cell);
      align(8);
      put(body, std::bit_cast<std::uint64_t>(std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN()));
    }
  }
  return head + body;
}

void McapWriter::write_chunk() {
  const std::string packed = packed_by_zstd(records_);
  std::string content;
  put(content, chunk_first_ns_);
  put(content, last_ns_);
  put(content, static_cast<std::uint64_t>(records_.size()));
  put(content, crc32_of(records_));
  put_text(content, "zstd");
  put(content, static_cast<std::uint64_t>(packed.size()));
  content += packed;
  Chunk chunk{.first_ns = chunk_first_ns_, .last_ns = last_ns_, .at = at_};
  write(record(mcap::kChunk, content));
  chunk.bytes = at_ - chunk.at;
  chunk.index_at = at_;
  std::string index;
  put(index, kOnly);
  put_text(index, index_);
  write(record(mcap::kMessageIndex, index));
  chunk.index_bytes = at_ - chunk.index_at;
  chunk.packed = packed.size();
  chunk.unpacked = records_.size();
  chunks_.push_back(chunk);
  records_.clear();
  index_.clear();
}

void McapWriter::write_summary() {
  const std::uint64_t begin = at_;
  std::string summary;
  std::string offsets;
  const auto group = [&](mcap::Kind kind, const std::string& records) {
    if (records.empty()) return;
    std::string offset;
    offset += static_cast<char>(kind);
    put(offset, begin + summary.size());
    put(offset, static_cast<std::uint64_t>(records.size()));
    offsets += record(mcap::kSummaryOffset, offset);
    summary += records;
  };
  group(mcap::kSchema, schema_);
  group(mcap::kChannel, channel_);
  std::string statistics;
  put(statistics, rows_);
  put(statistics, static_cast<std::uint16_t>(rows_ > 0 ? 1 : 0));
  put(statistics, static_cast<std::uint32_t>(rows_ > 0 ? 1 : 0));
  put(statistics, std::uint32_t{0});  // attachments
  put(statistics, static_cast<std::uint32_t>(metadata_bytes_ > 0 ? 1 : 0));
  put(statistics, static_cast<std::uint32_t>(chunks_.size()));
  put(statistics, first_ns_);
  put(statistics, last_ns_);
  std::string counts;
  if (rows_ > 0) {
    put(counts, kOnly);
    put(counts, rows_);
  }
  put_text(statistics, counts);
  group(mcap::kStatistics, record(mcap::kStatistics, statistics));
  std::string chunks;
  for (const Chunk& chunk : chunks_) {
    std::string content;
    put(content, chunk.first_ns);
    put(content, chunk.last_ns);
    put(content, chunk.at);
    put(content, chunk.bytes);
    std::string indexes;
    put(indexes, kOnly);
    put(indexes, chunk.index_at);
    put_text(content, indexes);
    put(content, chunk.index_bytes);
    put_text(content, "zstd");
    put(content, chunk.packed);
    put(content, chunk.unpacked);
    chunks += record(mcap::kChunkIndex, content);
  }
  group(mcap::kChunkIndex, chunks);
  if (metadata_bytes_ > 0) {
    std::string content;
    put(content, metadata_at_);
    put(content, metadata_bytes_);
    put_text(content, kMetadataName);
    group(mcap::kMetadataIndex, record(mcap::kMetadataIndex, content));
  }
  // The footer's checksum is of summary, offsets and the footer up to it.
  std::string footer;
  footer += static_cast<char>(mcap::kFooter);
  put(footer, std::uint64_t{20});
  put(footer, begin);
  put(footer, begin + summary.size());
  std::string all = summary + offsets + footer;
  put(all, crc32_of(all));
  write(all);
}

}  // namespace steerid
