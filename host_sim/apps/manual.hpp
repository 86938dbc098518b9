// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is made from the options themselves: the manual page steerid(1) and the completion for bash. An option that is
// added is in both.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace steerid {

/// In man(7)'s language.
[[nodiscard]] std::string manual_page(const CLI::App& app);

/// A script for /usr/share/bash-completion/completions.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

}  // namespace steerid
