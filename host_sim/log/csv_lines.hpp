// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The two layers below a CSV record: lines out of a stream that is read in blocks, cells out of a line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "log/text_encoding.hpp"

namespace steerid {

/// Lines without their LF, CRLF or CR, counted from 1, in UTF-8 whatever the file is written in: a byte-order mark is
/// passed over, UTF-16 (by its mark, or by a zero beside every character) is converted, and a line that is no UTF-8 is
/// taken as Windows-1252, which has Latin-1 in it. Zeros at the end, of room that was reserved on the disk and never
/// written, are no text. Holds one block of the file at a time. Throws BadInput when the stream fails, when a line does
/// not fit a block, and when there are more than kMostZeros.
class CsvLines {
 public:
  /// `name` stands for the file in sentences.
  CsvLines(std::istream& in, std::string name);

  /// The next line; false at the end. The text stays valid until the next call.
  bool next(std::string_view& line);

  [[nodiscard]] std::size_t number() const { return number_; }

  /// The last line has been given, and nothing ends it: what writes the file was stopped, or leaves the end out.
  [[nodiscard]] bool end_is_open() const { return end_is_open_; }
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }

  static constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
  static constexpr std::uint64_t kMostZeros = std::uint64_t{1} << 28;  ///< a file may be all holes

 private:
  bool fill();
  std::size_t read_utf8(char* to, std::size_t room);
  std::size_t read_utf16(char* to, std::size_t room);

  std::istream& in_;
  std::string name_;
  std::vector<char> block_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t number_ = 0;
  char newline_ = '\n';  ///< CR where the file's first block has no LF
  bool end_is_open_ = false;
  std::uint64_t zeros_ = 0;  ///< that were left out
  std::uint64_t bytes_read_ = 0;
  Encoding encoding_ = Encoding::kUtf8;
  std::vector<char> raw_{};  ///< UTF-16 that is to be converted
  char16_t surrogate_ = 0;   ///< the first of a pair that a block's end has cut
  std::string converted_{};  ///< a line of Windows-1252
};

/// The number that a cell's whole text is: decimal point or, where `decimal_comma`, comma. Not "inf" or "nan".
[[nodiscard]] bool is_number(std::string_view text, bool decimal_comma, double& value);

/// Walks over the cells of one line. Spaces around a cell go; a cell in double quotes may hold the separator, and a
/// doubled quote stands for one.
class CsvCells {
 public:
  CsvCells(std::string_view line, char separator);

  /// The next cell; false when there is none. The text stays valid until the next call.
  bool next(std::string_view& cell);

  /// Reads the next cell when it is a plain finite number and nothing else; else false, and next() still gives that
  /// cell.
  bool next_number(double& value);

  /// A quote that does not close, or text after the closing one.
  [[nodiscard]] bool broken() const { return broken_; }

 private:
  void pass_blanks();
  bool next_quoted(std::string_view& cell);

  std::string_view rest_;
  char separator_;
  bool at_end_ = false;
  bool broken_ = false;
  std::string unquoted_;
};

}  // namespace steerid
