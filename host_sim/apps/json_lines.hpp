// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// --json-lines: a request a line on standard input, an answer a line on standard output, for whatever drives many
// processes by pipes.
//
//   {"id":7,"real":"a17/log.csv","sim":"a17/sim.json"}            request: what names the files, and an id of any kind
//   {"id":7,"ended":"answered","answer":{..}}                    answer, in the order of the requests
//   {"id":8,"ended":"unusable","error":"a18/log.csv: ..."}       the data are at fault, or the request is
//   {"id":9,"ended":"fault","error":"internal error: ..."}       this program is
#pragma once

#include <functional>
#include <istream>
#include <nlohmann/json.hpp>
#include <ostream>

namespace steerid {

/// Answers every line of `in` by `answer`, and none less because another was bad. `answer` gets the request, an object,
/// and throws BadInput where it or its files are at fault. Throws BadInput when `out` cannot be written.
void answer_lines(std::istream& in, std::ostream& out,
                  const std::function<nlohmann::ordered_json(const nlohmann::ordered_json& request)>& answer);

/// The text of a request's field. Throws BadInput when it has none, or another kind of value.
[[nodiscard]] std::string text_of(const nlohmann::ordered_json& request, const char* field);

}  // namespace steerid
