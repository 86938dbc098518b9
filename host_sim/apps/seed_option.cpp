// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/seed_option.hpp"

#include <limits>

#include "apps/option_kinds.hpp"

namespace steerid {

void add_seed(CLI::App& command, std::uint64_t& seed, const std::string& of_what) {
  whole_from(command.add_option("--seed", seed, of_what), 0, std::numeric_limits<std::uint64_t>::max())
      ->type_name("SEED")
      ->capture_default_str();
}

}  // namespace steerid
