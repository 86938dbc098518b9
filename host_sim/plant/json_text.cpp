#include "plant/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "log/bad_input.hpp"

namespace steerid {

nlohmann::json parse_json(std::string_view text, std::string_view name) {
  using nlohmann::json;
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    const std::size_t at = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
    const std::string_view before = text.substr(0, at);
    const auto line = 1 + std::ranges::count(before, '\n');
    const std::size_t newline = before.rfind('\n');
    const std::size_t column = at - (newline == std::string_view::npos ? 0 : newline + 1) + 1;
    throw BadInput(fmt::format("{}, line {}, column {}: expected JSON, found {}; check brackets, commas and quotes",
                               name, line, column,
                               at < text.size() ? in_quotes(text.substr(at, 1)) : "the end of the file"));
  } catch (const json::exception&) {
    throw BadInput(fmt::format("{}: expected JSON with numbers that fit a double; shorten the number", name));
  }
}

}  // namespace steerid
