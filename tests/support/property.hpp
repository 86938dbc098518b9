// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Properties by rapidcheck, with the project's seeds.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdint>
#include <sstream>
#include <utility>

#include "support/seed.hpp"

namespace steerid::test {

/// Fails the running test, with the shrunken counterexample, unless `property` holds for `count` generated inputs.
template <typename Property>
void check_property(std::uint64_t fallback_seed, int count, Property&& property) {
  rc::detail::TestParams params;
  params.seed = seed(fallback_seed);
  params.maxSuccess = count;
  const rc::detail::TestResult result =
      rc::detail::checkTestable(std::forward<Property>(property), rc::detail::TestMetadata{}, params);
  std::ostringstream message;
  rc::detail::printResultMessage(result, message);
  EXPECT_TRUE(result.is<rc::detail::SuccessResult>()) << message.str();
}

}  // namespace steerid::test
