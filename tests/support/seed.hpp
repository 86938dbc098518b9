// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Seeds of random tests: every random test takes its seed here, so that a failure can be repeated.
#pragma once

#include <cstdint>

namespace steerid::test {

/// The seed for this test: STEERID_SEED from the environment when it is set, else `fallback`.
/// Prints it, and records it as a property of the running test.
std::uint64_t seed(std::uint64_t fallback);

}  // namespace steerid::test
