// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/csv_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "log/bad_input.hpp"
#include "log/text.hpp"

namespace steerid {

CsvLines::CsvLines(std::istream& in, std::string name) : in_(in), name_(std::move(name)), block_(kBlockBytes) {
  fill();
  const std::string_view head(block_.data(), end_);
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) {
    throw bad_input({.file = name_, .expected = "UTF-8 text", .found = "UTF-16", .advice = "save the file as UTF-8"});
  }
  if (head.starts_with("\xef\xbb\xbf")) begin_ = 3;
}

bool CsvLines::fill() {
  // Only the piece of a line that the block's end cuts off is moved, so a byte is moved once at most.
  std::memmove(block_.data(), block_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (end_ == block_.size()) {
    throw bad_input({.file = name_,
                     .line = number_ + 1,
                     .expected = fmt::format("lines shorter than {} bytes", kBlockBytes),
                     .found = "a longer one",
                     .advice = "check that this is a CSV text file"});
  }
  in_.read(block_.data() + end_, static_cast<std::streamsize>(block_.size() - end_));
  if (in_.bad()) {
    throw bad_input({.file = name_,
                     .expected = "a readable file",
                     .found = fmt::format("a read error after {} bytes", bytes_read_),
                     .advice = "check the disk or copy the file anew"});
  }
  const auto got = static_cast<std::size_t>(in_.gcount());
  end_ += got;
  bytes_read_ += got;
  return got > 0;
}

bool CsvLines::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const char* const first = block_.data() + begin_;
    const std::size_t held = end_ - begin_;
    const void* const newline = held > searched ? std::memchr(first + searched, '\n', held - searched) : nullptr;
    if (newline != nullptr) {
      line = std::string_view(first, static_cast<std::size_t>(static_cast<const char*>(newline) - first));
      begin_ += line.size() + 1;
      break;
    }
    searched = held;
    if (fill()) continue;
    if (held == 0) return false;
    line = std::string_view(block_.data(), held);  // the last line may lack its newline
    begin_ = end_;
    break;
  }
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++number_;
  return true;
}

CsvCells::CsvCells(std::string_view line, char separator) : rest_(line), separator_(separator) {}

void CsvCells::pass_blanks() {
  while (!rest_.empty() && (rest_.front() == ' ' || (rest_.front() == '\t' && separator_ != '\t'))) {
    rest_.remove_prefix(1);
  }
}

bool CsvCells::next(std::string_view& cell) {
  if (at_end_) return false;
  pass_blanks();
  if (rest_.starts_with('"')) return next_quoted(cell);
  const std::size_t stop = rest_.find(separator_);
  cell = trimmed(rest_.substr(0, stop));
  at_end_ = stop == std::string_view::npos;
  if (!at_end_) rest_.remove_prefix(stop + 1);
  return true;
}

bool CsvCells::next_quoted(std::string_view& cell) {
  unquoted_.clear();
  std::size_t i = 1;
  for (; i < rest_.size(); ++i) {
    if (rest_[i] == '"') {
      if (i + 1 == rest_.size() || rest_[i + 1] != '"') break;
      ++i;
    }
    unquoted_ += rest_[i];
  }
  if (i >= rest_.size()) broken_ = true;
  rest_.remove_prefix(std::min(i + 1, rest_.size()));
  pass_blanks();
  at_end_ = rest_.empty();
  if (!at_end_ && rest_.front() != separator_) {
    broken_ = true;
    at_end_ = true;
  }
  if (!at_end_) rest_.remove_prefix(1);
  cell = trimmed(unquoted_);
  return true;
}

bool CsvCells::next_number(double& value) {
  if (at_end_) return false;
  pass_blanks();
  const char* const last = rest_.data() + rest_.size();
  const auto [stop, error] = std::from_chars(rest_.data(), last, value);
  if (error != std::errc{} || !std::isfinite(value)) return false;  // from_chars knows "inf" and "nan" too
  if (stop != last && *stop != separator_) return false;
  at_end_ = stop == last;
  rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()) + (at_end_ ? 0 : 1));
  return true;
}

char detect_separator(std::string_view header) {
  std::size_t commas = 0;
  std::size_t semicolons = 0;
  std::size_t tabs = 0;
  bool in_quotes = false;
  for (const char c : header) {
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    commas += c == ',' ? 1 : 0;
    semicolons += c == ';' ? 1 : 0;
    tabs += c == '\t' ? 1 : 0;
  }
  if (commas >= semicolons && commas >= tabs) return ',';
  return semicolons >= tabs ? ';' : '\t';
}

}  // namespace steerid
