// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Signals in a payload, the checksum and what it finds.
#include <gtest/gtest.h>

#include <random>
#include <string_view>

#include "can/protection.hpp"
#include "support/seed.hpp"

namespace steerid::can {
namespace {

TEST(CanProtection, ChecksumHasTheCheckValueOfItsPublishedAlgorithm) {
  // CRC-8/AUTOSAR over the digits 1 to 9 is 0xDF in every catalogue of CRCs.
  std::uint8_t crc = 0xFF;
  for (const char digit : std::string_view("123456789")) crc = crc8_2f_byte(crc, static_cast<std::uint8_t>(digit));
  EXPECT_EQ(crc ^ 0xFF, 0xDF);
}

TEST(CanSignal, LiesWhereADbcFileSays) {
  Frame frame;
  put(frame, Signal{.start = 12, .length = 4}, 0xA);
  put(frame, Signal{.start = 16, .length = 32, .is_signed = true}, -2);
  EXPECT_EQ(frame.data, (std::array<std::uint8_t, 8>{0, 0xA0, 0xFE, 0xFF, 0xFF, 0xFF, 0, 0}));
}

TEST(CanSignal, StopsAtTheEndsOfItsRange) {
  constexpr Signal kTwelve{.start = 3, .length = 12, .is_signed = true};
  constexpr Signal kPlain{.start = 20, .length = 5};
  Frame frame;
  for (const auto& [written, read] : {std::pair{99'999, 2047}, {-99'999, -2048}, {2047, 2047}, {-2048, -2048}}) {
    put(frame, kTwelve, written);
    EXPECT_EQ(get(frame, kTwelve), read);
  }
  put(frame, kPlain, -1);
  EXPECT_EQ(get(frame, kPlain), 0);
  put(frame, kPlain, 32);
  EXPECT_EQ(get(frame, kPlain), 31);
}

TEST(CanSignal, LeavesItsNeighboursAlone) {
  std::mt19937_64 random(test::seed(7));
  for (int i = 0; i < 2000; ++i) {
    const auto length = static_cast<std::uint8_t>(1 + random() % 48);
    const auto start = static_cast<std::uint8_t>(random() % (65U - length));
    const Signal signal{.start = start, .length = length, .is_signed = random() % 2 == 0};
    Frame frame;
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random());
    const std::uint64_t before = word(frame);
    const std::int64_t value = signal.lowest() + static_cast<std::int64_t>(random() % (std::uint64_t{1} << length));
    put(frame, signal, value);
    EXPECT_EQ(get(frame, signal), value);
    EXPECT_EQ((word(frame) ^ before) & ~(signal.mask() << start), 0U) << int{start} << "|" << int{length};
  }
}

/// Flips the bits of `pattern` in byte 0 to 7 of a protected frame and counts how many patterns pass.
template <class Patterns>
int passing(const Frame& frame, Patterns patterns) {
  int passed = 0;
  patterns([&](std::uint64_t pattern) {
    Frame hit = frame;
    const std::uint64_t bits = word(frame) ^ pattern;
    for (unsigned i = 0; i < 8U; ++i) hit.data[i] = static_cast<std::uint8_t>(bits >> (8U * i));
    // A counter of 15 is refused for itself; here only the checksum is on trial.
    passed += hit.data[0] == checksum(hit) ? 1 : 0;
  });
  return passed;
}

TEST(CanProtection, FindsEveryErrorOfUpToThreeBits) {
  // The polynomial's Hamming distance is 4 up to 119 bits of data (Koopman and Chakravarty, 2004); these are 72.
  Frame frame{.id = 0x120, .length = 8, .data = {}};
  put(frame, Signal{16, 32, true}, -123'456);
  protect(frame, 9);
  EXPECT_EQ(passing(frame,
                    [](auto hit) {
                      for (unsigned a = 0; a < 64U; ++a) {
                        for (unsigned b = a; b < 64U; ++b) {
                          for (unsigned c = b; c < 64U; ++c) {
                            const auto bit = [](unsigned i) { return std::uint64_t{1} << i; };
                            hit(bit(a) | bit(b) | bit(c));
                          }
                        }
                      }
                    }),
            0);
}

TEST(CanProtection, LetsOneIn256OfRandomPayloadsPassAndNoMore) {
  // 2^-8 of 200,000 is 781; five standard deviations of that count (28) to each side.
  std::mt19937_64 random(test::seed(8));
  Frame frame{.id = 0x121, .length = 8, .data = {}};
  protect(frame, 3);
  const int passed = passing(frame, [&](auto hit) {
    for (int i = 0; i < 200'000; ++i) hit(random());
  });
  EXPECT_GT(passed, 781 - 140);
  EXPECT_LT(passed, 781 + 140);
}

TEST(CanProtection, AFrameUnderAnotherIdentifierDoesNotPass) {
  Frame frame{.id = 0x120, .length = 8, .data = {}};
  protect(frame, 0);
  ASSERT_TRUE(intact(frame));
  // 8 bits tell 255 of 256 identifiers apart; those of this project's messages must all differ from each other.
  for (std::uint16_t id = 0x120; id < 0x140; ++id) {
    frame.id = id;
    EXPECT_EQ(intact(frame), id == 0x120) << id;
  }
}

TEST(CanProtection, RefusesAShortFrameAndACounterThatIsNeverSent) {
  Frame frame{.id = 0x120, .length = 8, .data = {}};
  protect(frame, 14);
  EXPECT_TRUE(intact(frame));
  frame.length = 7;
  EXPECT_FALSE(intact(frame));
  frame.length = 8;
  protect(frame, 15);
  EXPECT_FALSE(intact(frame));
}

TEST(CanProtection, TheCounterRunsFromZeroToFourteen) {
  std::uint8_t alive = 0;
  for (int i = 1; i <= 45; ++i) {
    alive = next_alive(alive);
    EXPECT_EQ(alive, i % 15);
  }
}

}  // namespace
}  // namespace steerid::can
