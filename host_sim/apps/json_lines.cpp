// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/json_lines.hpp"

#include <fmt/format.h>

#include <exception>
#include <string>

#include "log/bad_input.hpp"
#include "log/text.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

Json request_of(const std::string& line, std::size_t number) {
  Json request = Json::parse(line, nullptr, false);
  if (request.is_object()) return request;
  throw bad_input({.file = "standard input",
                   .line = number,
                   .expected = "a JSON object",
                   .found = in_quotes(line),
                   .advice = "write one request a line"});
}

}  // namespace

void answer_lines(std::istream& in, std::ostream& out, const std::function<Json(const Json& request)>& answer) {
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (trimmed(line).empty()) continue;
    Json said = {{"id", nullptr}};
    try {
      const Json request = request_of(line, number);
      said["id"] = request.value("id", Json(number));
      Json found = answer(request);
      said["ended"] = "answered";
      said["answer"] = std::move(found);
    } catch (const BadInput& error) {
      said["ended"] = "unusable";
      said["error"] = error.what();
    } catch (const std::exception& error) {
      said["ended"] = "fault";
      said["error"] = fmt::format("internal error: {}", error.what());
    }
    out << said.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n' << std::flush;
    if (!out) throw BadInput("standard output: expected a reader of the answers, found none; keep the pipe open");
  }
}

std::string text_of(const Json& request, const char* field) {
  const auto found = request.find(field);
  if (found != request.end() && found->is_string()) return found->get<std::string>();
  throw bad_input({.file = "the request",
                   .expected = fmt::format("a path under \"{}\"", field),
                   .found = found == request.end() ? "none" : found->dump(),
                   .advice = "name the file"});
}

}  // namespace steerid
