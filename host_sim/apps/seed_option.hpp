// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// --seed, the same in every command.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace steerid {

/// Adds --seed to `command`: `of_what` it is, for the help. Anything but a whole number of 64 bits is refused: a
/// negative one would pass for a very large one.
void add_seed(CLI::App& command, std::uint64_t& seed,
              const std::string& of_what = "Of everything that is drawn at random");

}  // namespace steerid
