// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/can_text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "log/bad_input.hpp"
#include "log/csv_lines.hpp"
#include "log/text.hpp"

namespace steerid {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

template <class Number>
bool whole(std::string_view text, Number& value, int base) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc() && stop == text.data() + text.size();
}

bool seconds(std::string_view text, double& value) {
  constexpr double kLatestS = 1e10;  // as of every log
  return is_number(text, false, value) && std::abs(value) <= kLatestS;
}

/// Two digits a byte.
bool take_bytes(std::string_view hex, CanFrame& frame) {
  if (hex.size() % 2 != 0 || hex.size() / 2 > CanFrame::kMostBytes) return false;
  frame.bytes = hex.size() / 2;
  for (std::size_t i = 0; i < frame.bytes; ++i) {
    if (!whole(hex.substr(2 * i, 2), frame.data.at(i), 16)) return false;
  }
  return true;
}

bool take_bytes(const std::vector<std::string_view>& words, std::size_t first, std::size_t count, int base,
                CanFrame& frame) {
  if (count > CanFrame::kMostBytes || words.size() < first + count) return false;
  frame.bytes = count;
  for (std::size_t i = 0; i < count; ++i) {
    if (!whole(words[first + i], frame.data.at(i), base)) return false;
  }
  return true;
}

class TextFrames : public CanFrames {
 public:
  explicit TextFrames(OpenedLog log) : log_(std::move(log)), lines_(*log_.in, log_.name) {}

  bool next(CanFrame& frame) override {
    for (std::string_view line; lines_.next(line);) {
      frame = CanFrame{};
      try {
        if (take(line, frame)) return true;
      } catch (const BadInput&) {
        if (!lines_.end_is_open()) throw;  // else the writer was stopped in this line: no frame
      }
    }
    return false;
  }

 protected:
  /// False for a line that is no data frame.
  virtual bool take(std::string_view line, CanFrame& frame) = 0;

  [[noreturn]] void complain(std::string_view line) const {
    throw bad_input({.file = log_.name,
                     .line = lines_.number(),
                     .expected = "a whole CAN frame",
                     .found = in_quotes(line),
                     .advice = "delete the line"});
  }

 private:
  OpenedLog log_;
  CsvLines lines_;
};

class Candump final : public TextFrames {
 public:
  using TextFrames::TextFrames;

 protected:
  bool take(std::string_view line, CanFrame& frame) override {
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty()) return false;
    const std::string_view stamp = words[0];
    const bool stamped = stamp.size() > 2 && stamp.front() == '(' && stamp.back() == ')' &&
                         seconds(stamp.substr(1, stamp.size() - 2), frame.time_s);
    if (!stamped || words.size() < 3) complain(line);
    const std::size_t mark = words[2].find('#');
    return mark == std::string_view::npos ? take_columns(words, line, frame)
                                          : take_compact(words[2], mark, line, frame);
  }

 private:
  bool take_id(std::string_view text, CanFrame& frame) {
    frame.extended = text.size() > 3;
    return whole(text, frame.id, 16) && frame.id < 0x20000000U;
  }

  bool take_compact(std::string_view text, std::size_t mark, std::string_view line, CanFrame& frame) {
    std::uint32_t id = 0;
    if (whole(text.substr(0, mark), id, 16) && id >= 0x20000000U) return false;  // an error frame
    std::string_view data = text.substr(mark + 1);
    if (data.starts_with('R')) return false;  // a remote frame
    if (data.starts_with('#')) data.remove_prefix(std::min<std::size_t>(2, data.size()));
    if (!take_id(text.substr(0, mark), frame) || !take_bytes(data, frame)) complain(line);
    return true;
  }

  bool take_columns(const std::vector<std::string_view>& words, std::string_view line, CanFrame& frame) {
    if (line.find("remote") != std::string_view::npos || line.find("ERRORFRAME") != std::string_view::npos)
      return false;
    std::size_t count = 0;
    const std::string_view length = words.size() > 3 ? words[3] : std::string_view();
    const bool counted = length.size() > 2 && length.front() == '[' && length.back() == ']' &&
                         whole(length.substr(1, length.size() - 2), count, 10);
    if (!counted || !take_id(words[2], frame) || !take_bytes(words, 4, count, 16, frame)) complain(line);
    return true;
  }
};

class Asc final : public TextFrames {
 public:
  using TextFrames::TextFrames;

 protected:
  bool take(std::string_view line, CanFrame& frame) override {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() >= 2 && equal_ignoring_case(words[0], "base")) {
      base_ = equal_ignoring_case(words[1], "dec") ? 10 : 16;
      if (words.size() >= 4) relative_ = equal_ignoring_case(words[3], "relative");
    }
    double stamp_s = 0;
    if (words.size() < 5 || !seconds(words[0], stamp_s)) return false;
    frame.time_s = now_s_ = relative_ ? now_s_ + stamp_s : stamp_s;
    if (equal_ignoring_case(words[1], "CANFD")) return take_fd(words, line, frame);
    if (words[4] != "d" || !is_channel(words[1])) return false;
    std::size_t count = 0;
    if (words.size() < 6 || !take_id(words[2], frame) || !whole(words[5], count, base_) ||
        !take_bytes(words, 6, count, base_, frame)) {
      complain(line);
    }
    return true;
  }

 private:
  static bool is_channel(std::string_view text) {
    unsigned channel = 0;
    return whole(text, channel, 10);
  }

  bool take_id(std::string_view text, CanFrame& frame) const {
    frame.extended = text.ends_with('x');
    if (frame.extended) text.remove_suffix(1);
    return whole(text, frame.id, base_) && frame.id < 0x20000000U;
  }

  /// CANFD channel direction ID [name] bit-rate-switch state code length data
  bool take_fd(const std::vector<std::string_view>& words, std::string_view line, CanFrame& frame) const {
    std::size_t at = 5;
    if (words.size() > at && words[at] != "0" && words[at] != "1") ++at;  // the message's name
    std::size_t count = 0;
    if (words.size() < at + 4 || !take_id(words[4], frame) || !whole(words[at + 3], count, 10) ||
        !take_bytes(words, at + 4, count, 16, frame)) {
      complain(line);
    }
    return true;
  }

  int base_ = 16;
  bool relative_ = false;
  double now_s_ = 0;
};

std::string_view first_line(std::string_view text) { return trimmed(text.substr(0, text.find_first_of("\r\n"))); }

}  // namespace

bool is_candump(std::string_view first_bytes) {
  const std::vector<std::string_view> words = words_of(first_line(first_bytes));
  double stamp_s = 0;
  return words.size() >= 3 && words[0].size() > 2 && words[0].front() == '(' && words[0].back() == ')' &&
         seconds(words[0].substr(1, words[0].size() - 2), stamp_s) &&
         words[1].find_first_of(",;") == std::string_view::npos;
}

bool is_asc(std::string_view first_bytes) {
  const std::size_t base = first_bytes.find("base ");
  const std::string_view head = first_bytes.substr(0, std::min<std::size_t>(first_bytes.size(), 400));
  return (head.starts_with("date ") || head.starts_with("base ")) && base < head.size() &&
         head.find("timestamps") != std::string_view::npos;
}

std::unique_ptr<CanFrames> candump_frames(OpenedLog log) { return std::make_unique<Candump>(std::move(log)); }
std::unique_ptr<CanFrames> asc_frames(OpenedLog log) { return std::make_unique<Asc>(std::move(log)); }

}  // namespace steerid
