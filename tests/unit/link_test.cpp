// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The link against the published check value of its CRC, hand-made encodings, the examples of its document, and a
// campaign that damages every bit and chance bytes.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "link/frame.hpp"
#include "support/seed.hpp"

namespace steerid::link {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes copy(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, "%02X ", byte);
    text += digits;
  }
  if (!text.empty()) text.pop_back();
  return text;
}

Sample sample() {
  return {.stamp_us = 1'230'000,
          .angle_urad = -45'678,
          .torque_driver_mnm = 1'500,
          .torque_motor_mnm = -250,
          .sequence = 123,
          .valid_bits = kAllChannelsValid};
}

/// What a car has.
Sample column_sample() {
  Sample s = sample();
  s.torque_bar_mnm = 1'500;
  s.torque_rim_mnm = -2'000'000;
  s.probe_mnm = -250;
  s.torque_driver_mnm = 0;
  s.valid_bits = kAngleValid | kTorqueMotorValid | kTorqueBarValid | kTorqueRimValid | kProbeValid;
  return s;
}

Estimate estimate() {
  Estimate e;
  e.stamp_us = 1'230'000;
  e.inertia = {110'250, 1'200, ParameterState::kValid};
  e.damping = {1'500'000, 20'000, ParameterState::kHolding};
  e.stiffness = {22'700'000, INT32_MAX, ParameterState::kNotExcited};
  e.driver = DriverState::kBraced;
  e.hands = HandCount::kTwo;
  e.counters = {1, 2, 3, 4, 5, 6, 7, 65535};
  return e;
}

bool equal(const Sample& a, const Sample& b) {
  return a.stamp_us == b.stamp_us && a.angle_urad == b.angle_urad && a.torque_driver_mnm == b.torque_driver_mnm &&
         a.torque_motor_mnm == b.torque_motor_mnm && a.torque_bar_mnm == b.torque_bar_mnm &&
         a.torque_rim_mnm == b.torque_rim_mnm && a.probe_mnm == b.probe_mnm && a.sequence == b.sequence &&
         a.valid_bits == b.valid_bits;
}

/// What came out of a reader: payloads with their types.
struct Heard {
  Type type;
  Bytes payload;
};
std::vector<Heard> listen(FrameReader& reader, const Bytes& bytes) {
  std::vector<Heard> heard;
  for (const std::uint8_t byte : bytes) {
    if (reader.push(byte)) heard.push_back({reader.type(), copy(reader.payload())});
  }
  return heard;
}

void append(Bytes& all, std::span<const std::uint8_t> more) { all.insert(all.end(), more.begin(), more.end()); }

TEST(Link, CrcHasItsPublishedCheckValue) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc32(Bytes(digits.begin(), digits.end())), 0xCBF43926U);
  EXPECT_EQ(crc32({}), 0U);
}

// Examples of Cheshire and Baker's rule, worked by hand.
TEST(Link, StuffingByHand) {
  const std::pair<Bytes, Bytes> pairs[] = {
      {{}, {1}},
      {{0}, {1, 1}},
      {{0, 0}, {1, 1, 1}},
      {{5}, {2, 5}},
      {{5, 0}, {2, 5, 1}},
      {{0, 5}, {1, 2, 5}},
      {{5, 6, 0, 7}, {3, 5, 6, 2, 7}},
      {{5, 0, 0, 6}, {2, 5, 1, 2, 6}},
  };
  for (const auto& [data, encoding] : pairs) {
    Bytes into(data.size() + 1);
    ASSERT_EQ(cobs_encode(data, into), encoding.size());
    EXPECT_EQ(into, encoding);
    Bytes back = encoding;
    ASSERT_EQ(cobs_decode(back), data.size());
    back.resize(data.size());
    EXPECT_EQ(back, data);
  }
  for (Bytes bad : {Bytes{3, 5}, Bytes{5}, Bytes{2, 5, 9, 1}}) EXPECT_EQ(cobs_decode(bad), 0U);
}

TEST(Link, MessagesComeBackAsTheyWent) {
  FrameWriter writer;
  FrameReader reader;
  const Sample sent = sample();
  auto heard = listen(reader, copy(writer.frame(Type::kSample, sent)));
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].type, Type::kSample);
  Sample got;
  ASSERT_TRUE(read_payload(heard[0].payload, got));
  EXPECT_TRUE(equal(got, sent));

  heard = listen(reader, copy(writer.frame(Type::kSample, column_sample())));
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].payload.size(), 35U);
  ASSERT_TRUE(read_payload(heard[0].payload, got));
  EXPECT_TRUE(equal(got, column_sample()));
  // The shorter sample leaves nothing of the longer one behind.
  ASSERT_TRUE(read_payload(payload(sample()).bytes(), got));
  EXPECT_TRUE(equal(got, sample()));

  heard = listen(reader, copy(writer.frame(Type::kEstimate, estimate())));
  ASSERT_EQ(heard.size(), 1U);
  Estimate e;
  ASSERT_TRUE(read_payload(heard[0].payload, e));
  EXPECT_EQ(copy(payload(e).bytes()), copy(payload(estimate()).bytes()));
  EXPECT_EQ(e.stiffness.sd_micro, INT32_MAX);
  EXPECT_EQ(e.counters.late_tick, 65535);
  EXPECT_EQ(e.driver, DriverState::kBraced);

  Health health;
  health.longest_step_us = 123;
  health.fault_line = 1;
  heard = listen(reader, copy(writer.frame(Type::kHealth, health)));
  ASSERT_EQ(heard.size(), 1U);
  Health h;
  ASSERT_TRUE(read_payload(heard[0].payload, h));
  EXPECT_EQ(h.longest_step_us, 123U);
  EXPECT_EQ(h.fault_line, 1U);
  EXPECT_EQ(reader.lost(), 0U);
  EXPECT_EQ(reader.damaged(), 0U);
}

TEST(Link, MessagesOfTheWrongLengthOrWithUnknownValuesAreNone) {
  Sample s;
  for (const Sample& sent : {sample(), column_sample()}) {
    Bytes bytes = copy(payload(sent).bytes());
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      EXPECT_FALSE(read_payload(std::span(bytes).first(length), s)) << length;
    }
    bytes.push_back(0);
    EXPECT_FALSE(read_payload(bytes, s));
  }
  Start start;
  EXPECT_TRUE(read_payload(Bytes{1}, start));
  EXPECT_EQ(start.pace, Pace::kLink);
  EXPECT_FALSE(read_payload(Bytes{2}, start));
}

// Every byte of the examples in docs/link_protocol.md.
TEST(Link, TheDocumentsExamplesAreWhatIsSent) {
  std::ifstream file(STEERID_LINK_DOCUMENT);
  ASSERT_TRUE(file.good()) << STEERID_LINK_DOCUMENT;
  std::stringstream text;
  text << file.rdbuf();
  FrameWriter writer;
  const Bytes hello = copy(writer.frame(Type::kHello));
  const Bytes start = copy(writer.frame(Type::kStart, Start{Pace::kLink}));
  const Bytes a_sample = copy(writer.frame(Type::kSample, sample()));
  const Bytes a_column_sample = copy(writer.frame(Type::kSample, column_sample()));
  FrameWriter ecu;
  const Bytes identity = copy(ecu.frame(Type::kHello, Identity{}));
  const Bytes an_estimate = copy(ecu.frame(Type::kEstimate, estimate()));
  // Long ones are broken into lines of 24 bytes.
  const auto broken = [](const Bytes& bytes) {
    std::string lines;
    for (std::size_t at = 0; at < bytes.size(); at += 24) {
      lines += "    " + hex(std::span(bytes).subspan(at, std::min<std::size_t>(24, bytes.size() - at))) + "\n";
    }
    return lines;
  };
  for (const Bytes& frame : {hello, start, a_sample, a_column_sample, identity, an_estimate}) {
    EXPECT_NE(text.str().find(broken(frame)), std::string::npos) << broken(frame);
  }
}

TEST(Link, CountsWhatWasLostAndWhatIsForeign) {
  FrameWriter writer;
  FrameReader reader;
  listen(reader, copy(writer.frame(Type::kTick)));
  for (int i = 0; i < 3; ++i) static_cast<void>(writer.frame(Type::kTick));
  EXPECT_EQ(listen(reader, copy(writer.frame(Type::kTick))).size(), 1U);
  EXPECT_EQ(reader.lost(), 3U);
  // Across the wrap.
  for (int i = 5; i < 65'536; ++i) static_cast<void>(writer.frame(Type::kTick));
  reader.forget_sequence();
  EXPECT_EQ(listen(reader, copy(writer.frame(Type::kTick))).size(), 1U);
  EXPECT_EQ(reader.lost(), 3U);

  // A good frame of version 2, by hand: 02 04 00 00 and its CRC.
  Bytes packet{2, 4, 0, 0};
  const std::uint32_t crc = crc32(packet);
  for (unsigned i = 0; i < 4; ++i) packet.push_back(static_cast<std::uint8_t>(crc >> (8 * i)));
  Bytes frame(packet.size() + 1);
  frame.resize(cobs_encode(packet, frame));
  frame.push_back(0);
  EXPECT_EQ(listen(reader, frame).size(), 0U);
  EXPECT_EQ(reader.foreign(), 1U);
  EXPECT_EQ(reader.damaged(), 0U);
}

// Any garbage before a frame costs at most that frame; the one behind it always comes through.
TEST(Link, IsInStepAgainAfterAnyGarbage) {
  std::mt19937_64 random(test::seed(80));
  for (int run = 0; run < 20'000; ++run) {
    FrameWriter writer;
    FrameReader reader;
    Bytes bytes(random() % 300);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    append(bytes, writer.frame(Type::kTick));
    append(bytes, writer.frame(Type::kSample, sample()));
    const auto heard = listen(reader, bytes);
    ASSERT_FALSE(heard.empty());
    ASSERT_EQ(heard.back().type, Type::kSample);
    ASSERT_LE(heard.size(), 2U);
  }
}

// No frame with one or two bits wrong is ever taken for a sample: every one of them, on the wire as it is.
TEST(Link, NoOneOrTwoWrongBitsMakeASample) {
  FrameWriter writer;
  const Bytes good = copy(writer.frame(Type::kSample, sample()));
  const std::size_t bits = good.size() * 8;
  std::int64_t tried = 0;
  for (std::size_t i = 0; i < bits; ++i) {
    for (std::size_t j = i; j < bits; ++j) {
      Bytes bad = good;
      bad[i / 8] = static_cast<std::uint8_t>(bad[i / 8] ^ (1U << (i % 8)));
      if (j != i) bad[j / 8] = static_cast<std::uint8_t>(bad[j / 8] ^ (1U << (j % 8)));
      bad.push_back(0);
      FrameReader reader;
      ASSERT_EQ(listen(reader, bad).size(), 0U) << i << ' ' << j;
      ++tried;
    }
  }
  std::printf("%lld damaged frames, none taken\n", static_cast<long long>(tried));
  EXPECT_EQ(tried, static_cast<std::int64_t>(bits * (bits + 1) / 2));
}

// Chance damage to a stream: bits turned, bytes lost, doubled or invented. What is taken is what was sent. With 2^-32
// for each of some 100'000 damaged frames a wrong one would be a surprise of one in 40'000.
TEST(Link, ACampaignOfDamageLetsNothingWrongThrough) {
  std::mt19937_64 random(test::seed(81));
  std::int64_t damaged = 0;
  std::int64_t taken = 0;
  FrameWriter writer;
  FrameReader reader;
  for (int run = 0; run < 200'000; ++run) {
    Sample sent = sample();
    sent.stamp_us = run;
    sent.angle_urad = static_cast<std::int32_t>(random());
    Bytes bytes = copy(writer.frame(Type::kSample, sent));
    const bool harm = random() % 2 == 0;
    if (harm) {
      ++damaged;
      for (std::uint64_t n = 1 + random() % 4; n > 0; --n) {
        const std::size_t at = random() % bytes.size();
        switch (random() % 4) {
          case 0:
            bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << (random() % 8)));
            break;
          case 1:
            bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
            break;
          case 2:
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes[at]);
            break;
          default:
            bytes[at] = static_cast<std::uint8_t>(random());
            break;
        }
        if (bytes.empty()) break;
      }
    }
    for (const Heard& heard : listen(reader, bytes)) {
      ASSERT_EQ(heard.type, Type::kSample);
      Sample got;
      ASSERT_TRUE(read_payload(heard.payload, got));
      // Harm can happen to undo itself; then it is the frame that was sent.
      ASSERT_TRUE(equal(got, sent));
      ++taken;
    }
  }
  std::printf("%lld of 200000 frames damaged, %lld taken, every one as sent\n", static_cast<long long>(damaged),
              static_cast<long long>(taken));
  EXPECT_GT(damaged, 90'000);
  EXPECT_GT(taken, 90'000 / 2);
}

}  // namespace
}  // namespace steerid::link
