// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The board without its hardware: CAN by a pair of sockets, ticks by the timer, no lines wired. What needs a kernel's
// GPIO chip is in tests/linux_guest.
#include "linux_gpiod/board.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <array>
#include <cstring>
#include <vector>

namespace steerid::linux_gpiod {
namespace {

class BoardTest : public testing::Test {
 protected:
  BoardTest() {
    std::array<int, 2> pair{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, pair.data()), 0);
    eps_ = Descriptor(pair[1]);
    board_.emplace(BoardLines{}, CanSocket(Descriptor(pair[0])), stop_.number());
  }

  void send(const can::Frame& frame) {
    can_frame raw{};
    raw.can_id = frame.id;
    raw.can_dlc = frame.length;
    std::copy(frame.data.begin(), frame.data.end(), raw.data);
    ASSERT_EQ(::send(eps_.number(), &raw, sizeof raw, 0), static_cast<ssize_t>(sizeof raw));
  }
  void send_sample(std::int32_t angle_urad) {
    Sample sample;
    sample.stamp_us = stamp_us_ += kTickPeriodUs;
    sample.angle_urad = angle_urad;
    for (const can::Frame& frame : can::pack(sample, alive_)) send(frame);
    alive_ = can::next_alive(alive_);
  }
  /// Identifiers of all that the board has sent.
  std::vector<unsigned> received() {
    std::vector<unsigned> ids;
    for (can_frame raw{}; ::recv(eps_.number(), &raw, sizeof raw, MSG_DONTWAIT) > 0;) ids.push_back(raw.can_id);
    return ids;
  }

  Descriptor stop_{::eventfd(0, 0)};
  Descriptor eps_;
  std::optional<Board> board_;
  std::uint8_t alive_ = 0;
  std::int64_t stamp_us_ = 0;
};

TEST_F(BoardTest, HandsOutOneSampleATickInTheirOrder) {
  send_sample(1);
  send_sample(2);
  Sample sample;
  ASSERT_EQ(board_->read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.angle_urad, 1);
  ASSERT_EQ(board_->read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.angle_urad, 2);
  EXPECT_EQ(board_->read_sample(sample), Status::kNoData);
  EXPECT_EQ(sample.angle_urad, 2);
}

TEST_F(BoardTest, KeepsTheNewestWhenTheQueueOverflowsAndCountsTheOthers) {
  for (int i = 1; i <= 4; ++i) send_sample(i);
  Sample sample;
  ASSERT_EQ(board_->read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.angle_urad, 4);
  EXPECT_EQ(board_->counters().dropped, 3U);
  EXPECT_EQ(board_->read_sample(sample), Status::kNoData);
}

TEST_F(BoardTest, SendsFiveMessagesATickAndTheCountersEveryTenth) {
  ASSERT_EQ(board_->publish(Estimate{}), Status::kOk);
  EXPECT_EQ(received(), (std::vector<unsigned>{0x130, 0x131, 0x132, 0x133, 0x135, 0x136, 0x137, 0x138, 0x139}));
  ASSERT_EQ(board_->publish(Estimate{}), Status::kOk);
  EXPECT_EQ(received(), (std::vector<unsigned>{0x130, 0x131, 0x132, 0x133, 0x135}));
  ASSERT_EQ(board_->request_probe_torque(100), Status::kOk);
  EXPECT_EQ(received(), (std::vector<unsigned>{0x134}));
}

TEST_F(BoardTest, SaysThatSamplesContradictEachOtherAndPublishesTheCounts) {
  send_sample(1);
  Sample forged;
  forged.stamp_us = stamp_us_;
  forged.angle_urad = 2;
  send(can::pack(forged, 0)[0]);
  Sample sample;
  ASSERT_EQ(board_->read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.angle_urad, 1);
  EXPECT_FALSE(board_->samples_agree());
  for (int i = 0; i < can::SampleAssembly::kTrialSamples; ++i) {
    send_sample(1);
    EXPECT_EQ(board_->read_sample(sample), Status::kNoData);
  }
  EXPECT_TRUE(board_->samples_agree());
  ASSERT_EQ(board_->publish(Estimate{}), Status::kOk);
  can::Frame bus;
  for (can_frame raw{}; ::recv(eps_.number(), &raw, sizeof raw, MSG_DONTWAIT) > 0;) {
    if (raw.can_id == can::kInputBusId) std::copy_n(raw.data, bus.data.size(), bus.data.begin());
  }
  EXPECT_EQ(can::get(bus, can::kBusCounters[1]), 1);
  EXPECT_EQ(can::get(bus, can::kBusCounters[3]), can::SampleAssembly::kTrialSamples);
}

TEST_F(BoardTest, SaysWhenNothingCanBeSent) {
  eps_.close();
  EXPECT_EQ(board_->publish(Estimate{}), Status::kIoError);
  EXPECT_FALSE(board_->can_works());
  EXPECT_EQ(board_->counters().send_failed, 1U);
  Sample sample;
  EXPECT_EQ(board_->read_sample(sample), Status::kNoData);
}

TEST_F(BoardTest, TicksByTheTimerCountsWhatItMissedAndStopsWhenAsked) {
  ASSERT_NE(board_->wait_tick(), Status::kEndOfStream);
  const timespec three_periods{.tv_sec = 0, .tv_nsec = 35'000'000};
  ::nanosleep(&three_periods, nullptr);
  EXPECT_EQ(board_->wait_tick(), Status::kLate);
  EXPECT_GE(board_->tick_counters().missed, 2U);
  EXPECT_EQ(board_->tick_counters().ticks, 2U);
  EXPECT_FALSE(board_->probe_enabled());
  board_->kick_watchdog();
  EXPECT_EQ(board_->latency().count(), 1U);
  const std::uint64_t one = 1;
  ASSERT_EQ(::write(stop_.number(), &one, sizeof one), static_cast<ssize_t>(sizeof one));
  EXPECT_EQ(board_->wait_tick(), Status::kEndOfStream);
}

TEST(Distribution, QuantilesAreRightWithinABucket) {
  Distribution times;
  EXPECT_EQ(times.quantile_us(0.5), 0);
  for (int us = 1; us <= 10'000; ++us) times.add(std::int64_t{us} * 1000);
  // A bucket is a quarter octave wide: at most a fourth above the truth, and never below it.
  for (const double part : {0.1, 0.5, 0.9, 0.99}) {
    EXPECT_GE(static_cast<double>(times.quantile_us(part)), part * 10'000) << part;
    EXPECT_LE(static_cast<double>(times.quantile_us(part)), part * 10'000 * 1.25) << part;
  }
  EXPECT_EQ(times.quantile_us(1.0), 10'000);
  EXPECT_EQ(times.largest_us(), 10'000);
  times.add(-5);
  times.add(std::int64_t{1} << 60);
  EXPECT_EQ(times.count(), 10'002U);
}

}  // namespace
}  // namespace steerid::linux_gpiod
