// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Against the closed forms of games whose Shapley values are known.
#include "gap/diagnosis/shared_among.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace steerid::gap {
namespace {

TEST(SharedAmong, ChangesThatDoNotMeetKeepTheirOwn) {
  const std::array<double, 5> own = {0.4, 0.1, 0.0, 0.3, 0.05};
  const auto shares = shared_among(own.size(), [&](std::uint64_t made) {
    double sum = 0;
    for (std::size_t i = 0; i < own.size(); ++i) sum += (made >> i & 1) != 0 ? own[i] : 0;
    return sum;
  });
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(shares[i], own[i], 1e-12) << i;
}

/// Neither closes anything without the other: half each, where one order gives nothing to one of them.
TEST(SharedAmong, ThoseThatNeedEachOtherShareAlike) {
  const auto shares = shared_among(2, [](std::uint64_t made) { return made == 3 ? 0.9 : 0.0; });
  EXPECT_DOUBLE_EQ(shares[0], 0.45);
  EXPECT_DOUBLE_EQ(shares[1], 0.45);
}

/// The airport game (Littlechild and Owen, Management Science 20, 1973): what is closed is the largest one's. Of 1, 2
/// and 3 each shares every step that it needs.
TEST(SharedAmong, IsShapleysValueOfThree) {
  const auto shares = shared_among(3, [](std::uint64_t made) { return static_cast<double>(std::bit_width(made)); });
  EXPECT_NEAR(shares[0], 1.0 / 3, 1e-12);
  EXPECT_NEAR(shares[1], 1.0 / 3 + 1.0 / 2, 1e-12);
  EXPECT_NEAR(shares[2], 1.0 / 3 + 1.0 / 2 + 1, 1e-12);
}

TEST(SharedAmong, SumsToWhatAllClose) {
  for (std::size_t count = 0; count < 8; ++count) {
    const auto closed = [](std::uint64_t made) {
      return static_cast<double>((made * 2654435761U) % 1000 * (made != 0));
    };
    const auto shares = shared_among(count, closed);
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), closed((std::uint64_t{1} << count) - 1), 1e-9);
  }
}

}  // namespace
}  // namespace steerid::gap
