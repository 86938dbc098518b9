// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/shard.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>

#include "fleet/file_hash.hpp"
#include "log/bad_input.hpp"

namespace steerid::fleet {
namespace {

std::optional<std::uint64_t> whole_number(std::string_view text, int base) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

bool Shard::holds(std::string_view record_path) const {
  const std::string digits = sha256(record_path);
  return whole_number(std::string_view(digits).substr(0, 16), 16).value() % of == number - 1;
}

std::string Shard::text() const { return fmt::format("{}/{}", number, of); }

Shard parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string_view::npos) {
    const auto number = whole_number(text.substr(0, slash), 10);
    const auto of = whole_number(text.substr(slash + 1), 10);
    if (number && of && *number >= 1 && *number <= *of) return {*number, *of};
  }
  throw BadOption(
      fmt::format("--shard: expected K/N with K from 1 to N, such as 3/10, found {}", in_quotes(std::string(text))));
}

}  // namespace steerid::fleet
