// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The one reader of JSON files, whoever wrote them.
//
// Taken is JSON by RFC 8259 with comments (`// ...` to the end of the line, `/* ... */`), so that a template can
// explain itself; a file in UTF-16, as PowerShell writes it, too. Refused, each with one sentence that names file, line
// and column: what is no JSON, an object with a key twice (readers would differ in which they take), more than
// kDeepestJson levels, and a number beyond a double. A file is read whole up to 16 MiB (log/input_file.hpp).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "log/input_file.hpp"
#include "log/text_encoding.hpp"

namespace steerid {

inline constexpr int kDeepestJson = 64;

/// Throws BadInput that says in which line and column of `name` the text is none of the above.
void check_json(std::string_view text, std::string_view name);

/// The same and what it holds; `Json` may be nlohmann::ordered_json.
template <class Json = nlohmann::json>
[[nodiscard]] Json parse_json(std::string_view text, std::string_view name) {
  const std::string utf8 = utf8_of(std::string(text));
  check_json(utf8, name);
  return Json::parse(utf8, nullptr, true, true);
}

/// The file's. `what` is what it should be: "a simulation in JSON".
template <class Json = nlohmann::json>
[[nodiscard]] Json load_json(const std::filesystem::path& file, std::string_view what,
                             std::uint64_t most_bytes = kMostBytesOfJson) {
  return parse_json<Json>(read_whole_file(file, what, most_bytes), file.string());
}

}  // namespace steerid
