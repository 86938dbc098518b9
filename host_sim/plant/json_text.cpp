// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

using nlohmann::json;

/// What the parser gives as it comes by: nothing is kept but the keys of the objects that are open, and the parser
/// itself needs a bit a level.
class Limits {
 public:
  using number_integer_t = json::number_integer_t;
  using number_unsigned_t = json::number_unsigned_t;
  using number_float_t = json::number_float_t;
  using string_t = json::string_t;
  using binary_t = json::binary_t;

  bool null() { return true; }                                         // NOLINT(readability-*): the library's names
  bool boolean(bool) { return true; }                                  // NOLINT
  bool number_integer(number_integer_t) { return true; }               // NOLINT
  bool number_unsigned(number_unsigned_t) { return true; }             // NOLINT
  bool number_float(number_float_t, const string_t&) { return true; }  // NOLINT
  bool string(string_t&) { return true; }                              // NOLINT
  bool binary(binary_t&) { return true; }                              // NOLINT
  bool start_object(std::size_t) { return deeper(); }
  bool start_array(std::size_t) { return deeper(); }
  bool end_object() { return higher(); }
  bool end_array() { return higher(); }

  bool key(string_t& name) {
    if (open_.back().insert(name).second) return true;
    refused_ = fmt::format("expected each key once in an object, found {} twice; delete one of them", in_quotes(name));
    return false;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) {
    constexpr int kFirstOfOutOfRange = 401;
    position_ = position;
    too_large_ = error.id >= kFirstOfOutOfRange;
    return false;
  }

  [[nodiscard]] const std::string& refused() const { return refused_; }
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] bool too_large() const { return too_large_; }

 private:
  bool deeper() {
    open_.emplace_back();
    if (static_cast<int>(open_.size()) <= kDeepestJson) return true;
    refused_ = fmt::format("expected at most {} levels of brackets, found more; no file of this program needs them",
                           kDeepestJson);
    return false;
  }
  bool higher() {
    open_.pop_back();
    return true;
  }

  std::vector<std::set<std::string>> open_;
  std::string refused_;
  std::size_t position_ = 0;
  bool too_large_ = false;
};

/// The text with a note of how far the parser has read it.
struct Reading {
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  using iterator_category = std::input_iterator_tag;

  const char* at;
  const char** furthest;

  reference operator*() const { return *at; }
  Reading& operator++() {
    *furthest = std::max(*furthest, ++at);
    return *this;
  }
  bool operator==(const Reading& other) const { return at == other.at; }
  bool operator!=(const Reading& other) const { return at != other.at; }
};

std::string place(std::string_view text, std::size_t at, std::string_view name) {
  const std::string_view before = text.substr(0, at);
  const auto line = 1 + std::ranges::count(before, '\n');
  const std::size_t newline = before.rfind('\n');
  return fmt::format("{}, line {}, column {}", name, line,
                     at - (newline == std::string_view::npos ? 0 : newline + 1) + 1);
}

}  // namespace

void check_json(std::string_view text, std::string_view name) {
  Limits limits;
  const char* furthest = text.data();
  const char* const end = text.data() + text.size();
  if (json::sax_parse(Reading{text.data(), &furthest}, Reading{end, &furthest}, &limits, json::input_format_t::json,
                      true, true)) {
    return;
  }
  const auto read = static_cast<std::size_t>(furthest - text.data());
  if (!limits.refused().empty()) {
    throw BadInput(fmt::format("{}: {}", place(text, read == 0 ? 0 : read - 1, name), limits.refused()));
  }
  if (limits.too_large()) {
    throw BadInput(fmt::format("{}: expected numbers that fit a double, found one that does not; shorten it",
                               place(text, read == 0 ? 0 : read - 1, name)));
  }
  const std::size_t at = std::min(limits.position() == 0 ? 0 : limits.position() - 1, text.size());
  throw BadInput(fmt::format("{}: expected JSON, found {}; check brackets, commas and quotes", place(text, at, name),
                             at < text.size() ? in_quotes(text.substr(at, 1)) : "the end of the file"));
}

}  // namespace steerid
