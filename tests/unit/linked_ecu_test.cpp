// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The ECU at the end of the link on a board that is a script: what comes in, when the timer ticks, how long a step
// takes.
#include "ecu/linked_ecu.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace steerid {
namespace {

struct Script {
  std::deque<std::uint8_t> incoming;
  std::vector<std::uint8_t> sent;
  std::deque<std::uint32_t> sleeps;  ///< by how many ticks the timer has moved on after each sleep
  std::uint32_t ticks = 0;
  std::uint32_t step_us = 100;
  bool room = true;
  bool timer_runs = false;
  int watchdogs = 0;
  int kicks = 0;
  bool valid = false;
  bool fault = false;
  std::optional<bool> reset_keeping;
};

class ScriptedBoard {
 public:
  explicit ScriptedBoard(Script& script) : s_(&script) {}
  bool receive(std::uint8_t& byte) {
    if (s_->incoming.empty()) return false;
    byte = s_->incoming.front();
    s_->incoming.pop_front();
    return true;
  }
  bool send(std::span<const std::uint8_t> bytes) {
    if (s_->room) s_->sent.insert(s_->sent.end(), bytes.begin(), bytes.end());
    return s_->room;
  }
  [[nodiscard]] bool can_send() const { return s_->room; }
  void sleep() {
    ASSERT_FALSE(s_->sleeps.empty()) << "it would sleep for ever";
    s_->ticks += s_->sleeps.front();
    s_->sleeps.pop_front();
  }
  void run_timer(bool on) { s_->timer_runs = on; }
  [[nodiscard]] std::uint32_t timer_ticks() const { return s_->ticks; }
  void start_stopwatch() {}
  [[nodiscard]] std::uint32_t stopwatch_us() const { return s_->step_us; }
  void set_lines(bool valid, bool fault) {
    s_->valid = valid;
    s_->fault = fault;
  }
  void start_watchdog() { ++s_->watchdogs; }
  void kick_watchdog() { ++s_->kicks; }
  void reset(bool keep) { s_->reset_keeping = keep; }
  [[nodiscard]] link::Identity identity() const { return {.restored = 1}; }
  [[nodiscard]] std::uint32_t overflows() const { return 7; }

 private:
  Script* s_;
};

class LinkedEcuTest : public testing::Test {
 protected:
  void hears(std::span<const std::uint8_t> bytes) {
    script_.incoming.insert(script_.incoming.end(), bytes.begin(), bytes.end());
  }
  template <class Message>
  std::optional<Message> said(link::Type type) {
    std::optional<Message> last;
    link::FrameReader reader;
    for (const std::uint8_t byte : script_.sent) {
      Message message;
      if (reader.push(byte) && reader.type() == type && link::read_payload(reader.payload(), message)) last = message;
    }
    return last;
  }

  Script script_;
  ScriptedBoard board_{script_};
  link::FrameWriter host_;
};

TEST_F(LinkedEcuTest, SaysWhoItIsAndWaitsToBeStarted) {
  LinkedEcu ecu(board_);
  ASSERT_TRUE(said<link::Identity>(link::Type::kHello));
  EXPECT_EQ(said<link::Identity>(link::Type::kHello)->restored, 1);
  hears(host_.frame(link::Type::kSample, Sample{}));  // before the start: no tick
  hears(host_.frame(link::Type::kStart, link::Start{link::Pace::kLink}));
  hears(host_.frame(link::Type::kTick));
  EXPECT_EQ(ecu.wait_tick(), Status::kOk);
  Sample sample;
  EXPECT_EQ(ecu.read_sample(sample), Status::kNoData);
  ASSERT_TRUE(said<link::Start>(link::Type::kStart));
  EXPECT_FALSE(script_.timer_runs);
  EXPECT_EQ(script_.watchdogs, 0);
}

TEST_F(LinkedEcuTest, WhereTheLinkPacesEveryMessageIsATick) {
  LinkedEcu ecu(board_);
  hears(host_.frame(link::Type::kStart, link::Start{link::Pace::kLink}));
  for (int k = 0; k < 3; ++k) hears(host_.frame(link::Type::kSample, Sample{.stamp_us = k * kTickPeriodUs}));
  for (int k = 0; k < 3; ++k) {
    ASSERT_EQ(ecu.wait_tick(), Status::kOk);
    Sample sample;
    ASSERT_EQ(ecu.read_sample(sample), Status::kOk);
    EXPECT_EQ(sample.stamp_us, k * kTickPeriodUs);
    EXPECT_EQ(ecu.read_sample(sample), Status::kNoData);  // once only
    Estimate estimate;
    estimate.stamp_us = sample.stamp_us + 1;
    EXPECT_EQ(ecu.publish(estimate), Status::kOk);
    EXPECT_EQ(said<Estimate>(link::Type::kEstimate)->stamp_us, sample.stamp_us + 1);
    ecu.kick_watchdog();
  }
  EXPECT_EQ(script_.kicks, 3);
}

TEST_F(LinkedEcuTest, CountsLateMissedAndOverrunAndPublishesThem) {
  LinkedEcu ecu(board_);
  hears(host_.frame(link::Type::kStart, link::Start{link::Pace::kTimer}));
  // 97 ticks in time, one after which two have passed, one after which four have, one in time.
  for (int k = 0; k < 97; ++k) script_.sleeps.push_back(1);
  for (const std::uint32_t passed : {2U, 4U, 1U}) script_.sleeps.push_back(passed);
  int late = 0;
  for (int k = 0; k < 100; ++k) {
    const Status status = ecu.wait_tick();
    if (status == Status::kLate) ++late;
    script_.step_us = k == 50 ? 10'001 : k == 51 ? 10'000 : 100;
    ecu.set_valid(true);
    ecu.set_fault(k == 99);
    ecu.kick_watchdog();
  }
  EXPECT_TRUE(script_.timer_runs);
  EXPECT_EQ(script_.watchdogs, 1);
  EXPECT_EQ(script_.kicks, 100);
  EXPECT_EQ(late, 2);
  EXPECT_TRUE(script_.valid && script_.fault);
  const auto health = said<link::Health>(link::Type::kHealth);
  ASSERT_TRUE(health);
  EXPECT_EQ(health->ticks, 100U);
  EXPECT_EQ(health->late, 2U);
  EXPECT_EQ(health->missed, 4U);
  EXPECT_EQ(health->overrun, 1U);
  EXPECT_EQ(health->longest_step_us, 10'001U);
  EXPECT_EQ(health->overflows, 7U);
  EXPECT_EQ(health->valid_line, 1U);
  EXPECT_EQ(health->fault_line, 1U);
}

TEST_F(LinkedEcuTest, TakesNothingDamagedAndCountsIt) {
  LinkedEcu ecu(board_);
  hears(host_.frame(link::Type::kStart, link::Start{link::Pace::kTimer}));
  const auto frame = host_.frame(link::Type::kSample, Sample{});
  std::vector<std::uint8_t> bad(frame.begin(), frame.end());
  bad[7] = static_cast<std::uint8_t>(bad[7] ^ 0x10U);
  hears(bad);
  hears(host_.frame(link::Type::kSample, link::Start{}));  // a good frame that is no sample
  for (int k = 0; k < 100; ++k) {
    script_.sleeps.push_back(1);
    ASSERT_EQ(ecu.wait_tick(), Status::kOk);
    Sample sample;
    ASSERT_EQ(ecu.read_sample(sample), Status::kNoData);
    ecu.kick_watchdog();
  }
  const auto health = said<link::Health>(link::Type::kHealth);
  ASSERT_TRUE(health);
  EXPECT_EQ(health->frames_damaged, 1U);
  EXPECT_EQ(health->frames_foreign, 1U);
  EXPECT_EQ(health->frames_lost, 1U);  // the damaged one's number never came
}

TEST_F(LinkedEcuTest, ResetsWhenAskedAndKeepsOrForgets) {
  for (const bool keep : {true, false}) {
    LinkedEcu ecu(board_);
    hears(host_.frame(link::Type::kReset, link::Reset{static_cast<std::uint8_t>(keep ? 1 : 0)}));
    hears(host_.frame(link::Type::kStart, link::Start{link::Pace::kLink}));
    hears(host_.frame(link::Type::kTick));
    EXPECT_EQ(ecu.wait_tick(), Status::kOk);
    EXPECT_EQ(script_.reset_keeping, keep);
  }
}

TEST_F(LinkedEcuTest, AFullLineIsAnErrorOfPublish) {
  LinkedEcu ecu(board_);
  script_.room = false;
  EXPECT_EQ(ecu.publish(Estimate{}), Status::kIoError);
  EXPECT_EQ(ecu.request_probe_torque(0), Status::kOk);
  EXPECT_EQ(ecu.request_probe_torque(5), Status::kOutOfRange);
}

}  // namespace
}  // namespace steerid
