// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Runs this very program again, as a process of its own: what it is not told it cannot know.
#pragma once

#include <string>
#include <vector>

namespace steerid {

/// `steerid arguments...`, its output going where ours goes; waits for it and gives its exit code. Throws
/// std::runtime_error when it cannot be started or dies.
int run_own_process(const std::vector<std::string>& arguments);

}  // namespace steerid
