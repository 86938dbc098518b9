// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/csv_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "log/bad_input.hpp"
#include "log/text.hpp"

namespace steerid {

CsvLines::CsvLines(std::istream& in, std::string name) : in_(in), name_(std::move(name)), block_(kBlockBytes) {
  raw_.resize(4);
  in_.read(raw_.data(), static_cast<std::streamsize>(raw_.size()));
  raw_.resize(static_cast<std::size_t>(in_.gcount()));
  encoding_ = encoding_of({raw_.data(), raw_.size()});
  fill();
  const std::string_view begin(block_.data(), end_);
  if (begin.find('\n') == std::string_view::npos && begin.find('\r') != std::string_view::npos) newline_ = '\r';
}

std::size_t CsvLines::read_utf8(char* to, std::size_t room) {
  const std::size_t held = std::min(raw_.size(), room);
  std::copy_n(raw_.begin(), held, to);
  raw_.erase(raw_.begin(), raw_.begin() + static_cast<std::ptrdiff_t>(held));
  in_.read(to + held, static_cast<std::streamsize>(room - held));
  return held + static_cast<std::size_t>(in_.gcount());
}

std::size_t CsvLines::read_utf16(char* to, std::size_t room) {
  // Two bytes become three at most; a half pair that is left over becomes three of its own.
  const std::size_t wanted = (room - 4) / 3 * 2;
  const std::size_t held = raw_.size();
  raw_.resize(wanted + held);
  in_.read(raw_.data() + held, static_cast<std::streamsize>(wanted - std::min(held, wanted)));
  raw_.resize(held + static_cast<std::size_t>(in_.gcount()));
  const std::string text = utf8_of_utf16(raw_, encoding_, surrogate_);
  std::copy(text.begin(), text.end(), to);
  return text.size();
}

bool CsvLines::fill() {
  // Only the piece of a line that the block's end cuts off is moved, so a byte is moved once at most.
  std::memmove(block_.data(), block_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  constexpr std::size_t kRoomForUtf16 = 16;
  if (block_.size() - end_ < (encoding_ == Encoding::kUtf8 ? 1 : kRoomForUtf16)) {
    throw bad_input({.file = name_,
                     .line = number_ + 1,
                     .expected = fmt::format("lines shorter than {} bytes", kBlockBytes),
                     .found = "a longer one",
                     .advice = "check that this is a CSV text file"});
  }
  const std::size_t room = block_.size() - end_;
  const std::size_t got =
      encoding_ == Encoding::kUtf8 ? read_utf8(block_.data() + end_, room) : read_utf16(block_.data() + end_, room);
  if (in_.bad()) {
    throw bad_input({.file = name_,
                     .expected = "a readable file",
                     .found = fmt::format("a read error after {} bytes", bytes_read_),
                     .advice = "check the disk or copy the file anew"});
  }
  end_ += got;
  while (end_ > begin_ && block_[end_ - 1] == '\0') {
    --end_;
    ++zeros_;
  }
  if (zeros_ > kMostZeros) {
    throw bad_input({.file = name_,
                     .line = number_ + 1,
                     .expected = "text",
                     .found = "zeros",
                     .advice = "cut off what was never written"});
  }
  bytes_read_ += got;
  return got > 0;
}

bool CsvLines::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const char* const first = block_.data() + begin_;
    const std::size_t held = end_ - begin_;
    const void* const newline = held > searched ? std::memchr(first + searched, newline_, held - searched) : nullptr;
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
    end_is_open_ = true;
    break;
  }
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);  // of a file, or of one that was appended
  ++number_;
  if (!is_utf8(line)) {
    converted_ = utf8_of_windows_1252(line);
    line = converted_;
  }
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

bool is_number(std::string_view text, bool decimal_comma, double& value) {
  std::array<char, 64> with_point{};
  const std::size_t comma = decimal_comma ? text.find(',') : std::string_view::npos;
  if (comma != std::string_view::npos) {
    if (text.size() > with_point.size() || text.find('.') != std::string_view::npos) return false;
    std::ranges::copy(text, with_point.begin());
    with_point.at(comma) = '.';
    text = std::string_view(with_point.data(), text.size());
  }
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && stop == text.data() + text.size() && std::isfinite(value);
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

}  // namespace steerid
