// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Writes rows as the messages of an MCAP file, which PlotJuggler, Foxglove and ROS 2 open: https://mcap.dev/spec.
//
// One topic, /steerid/WHAT, a message a row, stamped by the column time_s. Its schema lists the columns: as a JSON
// Schema, or as a ROS 2 message (steerid/msg/WHAT) of float64 and string. In JSON a number that is missing is left out,
// in CDR it is NaN. Chunks of 1 MiB are packed by zstd and have their checksums; a summary indexes them. MCAP has no
// stamps before zero: a clock that begins there begins at zero.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "log/table_writer.hpp"
#include "log/whole_file.hpp"

namespace steerid {

class McapWriter final : public TableWriter {
 public:
  McapWriter(const std::filesystem::path& target, Table table);

  McapWriter& cell(double value) override;
  McapWriter& cell(double value, int digits) override;
  McapWriter& cell(std::string_view text) override;
  void end_row() override;
  void commit() override;

 private:
  using Cell = std::variant<double, std::string>;

  struct Chunk {
    std::uint64_t first_ns = 0;
    std::uint64_t last_ns = 0;
    std::uint64_t at = 0;
    std::uint64_t bytes = 0;
    std::uint64_t index_at = 0;
    std::uint64_t index_bytes = 0;
    std::uint64_t packed = 0;
    std::uint64_t unpacked = 0;
  };

  void write(std::string_view bytes);
  void begin_channel();
  void write_chunk();
  void write_summary();
  [[nodiscard]] std::uint64_t stamp_ns();
  [[nodiscard]] std::string schema_text() const;
  [[nodiscard]] std::string message() const;

  WholeFile file_;
  Table table_;
  std::vector<Cell> row_{};
  std::string schema_{};   ///< its record; empty until the first row tells texts from numbers
  std::string channel_{};  ///< its record
  std::string records_{};  ///< of the present chunk
  std::string index_{};    ///< stamp and place of each of its messages
  std::vector<Chunk> chunks_{};
  std::uint64_t at_ = 0;
  std::uint32_t checksum_ = 0;
  std::uint64_t rows_ = 0;
  double zero_s_ = 0;
  std::uint64_t first_ns_ = 0;
  std::uint64_t last_ns_ = 0;
  std::uint64_t chunk_first_ns_ = 0;
  std::uint64_t metadata_at_ = 0;
  std::uint64_t metadata_bytes_ = 0;
};

}  // namespace steerid
