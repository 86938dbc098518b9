// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whatever arrives on the line, the link's reader keeps within its bounds, and what it takes is what its own writer
// would have sent.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "link/frame.hpp"

namespace {

template <class Message>
void expect_round_trip(std::span<const std::uint8_t> bytes) {
  Message message;
  if (!steerid::link::read_payload(bytes, message)) return;
  const auto again = steerid::link::payload(message);
  if (again.bytes().size() != bytes.size()) std::abort();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (again.bytes()[i] != bytes[i]) std::abort();
  }
}

void take_apart(std::span<const std::uint8_t> payload) {
  expect_round_trip<steerid::Sample>(payload);
  expect_round_trip<steerid::Estimate>(payload);
  expect_round_trip<steerid::link::Identity>(payload);
  expect_round_trip<steerid::link::Start>(payload);
  expect_round_trip<steerid::link::Health>(payload);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  // As a stream of bytes.
  steerid::link::FrameReader reader;
  for (const std::uint8_t byte : bytes) {
    if (reader.push(byte)) take_apart(reader.payload());
  }
  // As a payload that a good frame carries: a fuzzer does not find the CRC by itself.
  const auto payload = bytes.first(size < steerid::link::kMostPayload ? size : steerid::link::kMostPayload);
  take_apart(payload);
  steerid::link::FrameWriter writer;
  steerid::link::FrameReader other;
  bool came = false;
  for (const std::uint8_t byte : writer.frame(steerid::link::Type::kSample, payload)) came = other.push(byte);
  if (!came || other.payload().size() != payload.size()) std::abort();
  return 0;
}
