// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "log/bad_input.hpp"
#include "log/input_file.hpp"
#include "log/text.hpp"
#include "log/text_encoding.hpp"

namespace steerid {
namespace {

constexpr std::uint32_t kExtendedMark = 0x80000000U;

/// What is left of a line while it is read from its front; blanks are passed over.
class Rest {
 public:
  explicit Rest(std::string_view text) : text_(text) {}

  bool take(std::string_view words) {
    text_ = trimmed(text_);
    if (!text_.starts_with(words)) return false;
    text_.remove_prefix(words.size());
    return true;
  }

  std::string_view word() {
    text_ = trimmed(text_);
    const std::size_t end = std::min(text_.find_first_of(" \t:"), text_.size());
    const std::string_view found = text_.substr(0, end);
    text_.remove_prefix(end);
    return found;
  }

  template <class Number>
  bool number(Number& value) {
    text_ = trimmed(text_);
    if (text_.starts_with('+')) text_.remove_prefix(1);
    const auto [stop, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) return false;
    text_.remove_prefix(static_cast<std::size_t>(stop - text_.data()));
    return true;
  }

  /// The text up to `end`, which is taken too.
  std::string_view until(char end) {
    const std::size_t at = std::min(text_.find(end), text_.size());
    const std::string_view found = text_.substr(0, at);
    text_.remove_prefix(std::min(at + 1, text_.size()));
    return found;
  }

 private:
  std::string_view text_;
};

std::optional<DbcMessage> message_of(Rest rest) {
  std::uint32_t id = 0;
  if (!rest.number(id)) return std::nullopt;
  DbcMessage message{.name = std::string(rest.word())};
  if (message.name.empty() || !rest.take(":")) return std::nullopt;
  message.extended = (id & kExtendedMark) != 0;
  message.id = id & ~kExtendedMark;
  return message;
}

std::optional<DbcSignal> signal_of(Rest rest) {
  DbcSignal signal{.name = std::string(rest.word())};
  if (!rest.take(":")) {
    const std::string_view mark = rest.word();
    signal.selects = mark == "M";
    if (mark.starts_with('m')) {
      std::uint64_t value = 0;
      if (!Rest(mark.substr(1)).number(value)) return std::nullopt;
      signal.selected_by = value;
    }
    if (!rest.take(":")) return std::nullopt;
  }
  int order = 0;
  if (!rest.number(signal.start) || !rest.take("|") || !rest.number(signal.length) || !rest.take("@") ||
      !rest.number(order)) {
    return std::nullopt;
  }
  signal.motorola = order == 0;
  signal.number = rest.take("-") ? DbcSignal::Number::kSigned : DbcSignal::Number::kUnsigned;
  rest.take("+");
  if (!rest.take("(") || !rest.number(signal.factor) || !rest.take(",") || !rest.number(signal.offset) ||
      !rest.take(")")) {
    return std::nullopt;
  }
  if (rest.take("[")) rest.until(']');
  if (rest.take("\"")) signal.unit = rest.until('"');
  const bool fits = signal.length >= 1 && signal.length <= 64 && signal.start < 8 * CanFrame::kMostBytes;
  const bool finite = std::isfinite(signal.factor) && std::isfinite(signal.offset);
  return fits && finite && !signal.name.empty() ? std::optional(signal) : std::nullopt;
}

/// SIG_VALTYPE_ 100 Name : 1;
void set_value_type(Rest rest, std::vector<DbcMessage>& messages) {
  std::uint32_t id = 0;
  if (!rest.number(id)) return;
  const std::string_view name = rest.word();
  int type = 0;
  if (!rest.take(":") || !rest.number(type)) return;
  for (DbcMessage& message : messages) {
    if (message.id != (id & ~kExtendedMark) || message.extended != ((id & kExtendedMark) != 0)) continue;
    for (DbcSignal& signal : message.signals) {
      if (signal.name != name) continue;
      if (type == 1 && signal.length == 32) signal.number = DbcSignal::Number::kFloat;
      if (type == 2 && signal.length == 64) signal.number = DbcSignal::Number::kDouble;
    }
  }
}

}  // namespace

std::optional<std::uint64_t> DbcSignal::raw(const CanFrame& frame) const {
  if (length == 0 || length > 64) return std::nullopt;
  std::uint64_t bits = 0;
  std::size_t at = start;
  for (std::size_t i = 0; i < length; ++i) {
    if (at / 8 >= frame.bytes) return std::nullopt;
    const std::uint64_t bit = (frame.data.at(at / 8) >> (at % 8)) & 1U;
    if (motorola) {
      bits = (bits << 1U) | bit;
      at = at % 8 == 0 ? at + 15 : at - 1;  // down to bit 0, then to bit 7 of the next byte
    } else {
      bits |= bit << i;
      ++at;
    }
  }
  return bits;
}

std::optional<double> DbcSignal::value(const CanFrame& frame) const {
  const auto bits = raw(frame);
  if (!bits) return std::nullopt;
  double number_read = static_cast<double>(*bits);
  switch (number) {
    case Number::kUnsigned:
      break;
    case Number::kSigned: {
      const std::uint64_t high = std::uint64_t{1} << ((length - 1) % 64);
      number_read = static_cast<double>(static_cast<std::int64_t>((*bits ^ high) - high));
      break;
    }
    case Number::kFloat:
      number_read = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(*bits)));
      break;
    case Number::kDouble:
      number_read = std::bit_cast<double>(*bits);
      break;
  }
  const double scaled = number_read * factor + offset;
  return std::isfinite(scaled) ? std::optional(scaled) : std::nullopt;
}

std::vector<DbcMessage> parse_dbc(std::string_view text, const std::string& name) {
  std::vector<DbcMessage> messages;
  std::size_t number = 0;
  const auto complain = [&](const char* expected, std::string_view line) {
    throw bad_input({.file = name,
                     .line = number,
                     .expected = expected,
                     .found = in_quotes(line),
                     .advice = "check that it is a whole DBC file"});
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line = trimmed(line.substr(0, line.size() - 1));
    ++number;
    Rest rest(line);
    if (rest.take("BO_ ")) {
      auto message = message_of(rest);
      if (!message) complain("BO_ ID NAME: LENGTH SENDER", line);
      messages.push_back(std::move(*message));
    } else if (rest.take("SG_ ")) {
      auto signal = signal_of(rest);
      if (!signal || messages.empty())
        complain("SG_ NAME : START|LENGTH@ORDER+ (FACTOR,OFFSET) [LOW|HIGH] \"UNIT\"", line);
      if (!is_utf8(signal->unit)) signal->unit = utf8_of_windows_1252(signal->unit);
      messages.back().signals.push_back(std::move(*signal));
    } else if (rest.take("SIG_VALTYPE_ ")) {
      set_value_type(rest, messages);
    }
  }
  if (messages.empty()) {
    throw bad_input(
        {.file = name, .expected = "a DBC file", .found = "no message in it", .advice = "name the bus's DBC"});
  }
  return messages;
}

std::vector<DbcMessage> load_dbc(const std::filesystem::path& file) {
  return parse_dbc(read_whole_file(file, "a DBC file"), file.string());
}

}  // namespace steerid
