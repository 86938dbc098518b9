// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "hil/ecu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "log/bad_input.hpp"

namespace steerid::hil {
namespace {

/// A line that is never silent and says nothing must not be listened to for ever.
class Deadline {
 public:
  explicit Deadline(int after_ms) : at_(Clock::now() + std::chrono::milliseconds(after_ms)) {}
  [[nodiscard]] bool over() const { return Clock::now() > at_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point at_;
};

}  // namespace

Ecu::Ecu(ByteChannel channel) : channel_(std::move(channel)) { meet(); }

void Ecu::meet() {
  constexpr int kAskAgainMs = 500;
  met_ = started_ = false;
  good_ = 0;
  reader_.forget_sequence();
  for (int waited_ms = 0; waited_ms < kPatienceMs; waited_ms += kAskAgainMs) {
    if (waited_ms > 0) channel_.write(writer_.frame(link::Type::kHello));
    for (const Deadline soon(kAskAgainMs); !met_ && !soon.over() && listen(kAskAgainMs);) continue;
    if (met_) return;
  }
  std::string came = "nothing came";
  if (reader_.damaged() + reader_.foreign() + good_ > 0) {
    came = fmt::format(
        "{} damaged frames, {} of another version and {} others came; look at the line's rate and at "
        "docs/link_protocol.md",
        reader_.damaged(), reader_.foreign(), good_);
  }
  throw BadInput(fmt::format("the ECU does not answer: no hello within {} s, {}", kPatienceMs / 1000, came));
}

void Ecu::start(link::Pace pace) {
  started_ = started_again_ = false;
  channel_.write(writer_.frame(link::Type::kStart, link::Start{pace}));
  for (const Deadline last(kPatienceMs); !started_;) {
    if (last.over() || !listen(kPatienceMs)) throw BadInput("the ECU does not start");
  }
  lost_before_ = reader_.lost();
}

void Ecu::damaged_sample(const Sample& sample, std::mt19937_64& random) {
  const auto frame = writer_.frame(link::Type::kSample, sample);
  std::vector<std::uint8_t> bytes(frame.begin(), frame.end());
  do {  // twice the same bit leaves it as it was
    for (std::uint64_t n = 1 + random() % 3; n > 0; --n) {
      std::uint8_t& byte = bytes[random() % (bytes.size() - 1)];
      byte = static_cast<std::uint8_t>(byte ^ (1U << (random() % 8)));
    }
  } while (std::ranges::equal(bytes, frame));
  channel_.write(bytes);
}

void Ecu::reset(bool keep_saved) {
  channel_.write(writer_.frame(link::Type::kReset, link::Reset{static_cast<std::uint8_t>(keep_saved ? 1 : 0)}));
  meet();
}

Estimate Ecu::estimate() {
  for (const Deadline last(kPatienceMs); estimates_.empty();) {
    if (last.over() || !listen(kPatienceMs)) {
      throw BadInput(fmt::format("the ECU fell silent: no estimate within {} s", kPatienceMs / 1000));
    }
    if (started_again_)
      throw BadInput("the ECU started again by itself in mid-drive; look at its watchdog and its supply");
    if (const std::uint32_t lost = reader_.lost() - lost_before_; lost > 0) {
      throw BadInput(
          fmt::format("{} of the ECU's frames were lost on the way ({} came damaged), so that its estimates cannot be "
                      "told apart; look at the line and its rate, or give --real-time",
                      lost, reader_.damaged()));
    }
  }
  return pop();
}

std::optional<Estimate> Ecu::estimate_if_any(int timeout_ms) {
  if (estimates_.empty()) listen(timeout_ms);
  if (estimates_.empty()) return std::nullopt;
  return pop();
}

Estimate Ecu::pop() {
  const Estimate next = estimates_.front();
  estimates_.pop_front();
  return next;
}

bool Ecu::listen(int timeout_ms) {
  const auto bytes = channel_.read(timeout_ms);
  for (const std::uint8_t byte : bytes) {
    if (!reader_.push(byte)) continue;
    ++good_;
    take(reader_.type());
  }
  return !bytes.empty();
}

void Ecu::take(link::Type type) {
  if (type == link::Type::kHello && link::read_payload(reader_.payload(), identity_)) {
    met_ = true;
    // Answers to questions come before that to the start: this hello was not asked for.
    started_again_ = started_;
  }
  if (type == link::Type::kStart) started_ = true;
  if (type == link::Type::kHealth) static_cast<void>(link::read_payload(reader_.payload(), health_));
  Estimate estimate;
  if (type == link::Type::kEstimate && link::read_payload(reader_.payload(), estimate)) estimates_.push_back(estimate);
}

}  // namespace steerid::hil
