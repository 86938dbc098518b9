// The text of a JSON file that a user wrote.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace steerid {

/// Throws BadInput that says in which line and column of `name` the text is no JSON.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, std::string_view name);

}  // namespace steerid
