// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Text as HTML and XML have it, between tags and inside of quotes.
#pragma once

#include <string>
#include <string_view>

namespace steerid::report {

[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace steerid::report
