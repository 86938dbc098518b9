// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Samples and estimates through their messages and back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "can/estimate_messages.hpp"
#include "can/sample_messages.hpp"
#include "support/seed.hpp"

namespace steerid::can {
namespace {

/// Sample number `i` of a sender, anything in its channels.
Sample any_sample(std::mt19937_64& random, int i) {
  const auto within = [&random](std::int64_t limit) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * limit + 1)) - limit;
  };
  Sample sample;
  // To the end of the wire's 48 bits; half a period of jitter at most, between two.
  sample.stamp_us = (std::int64_t{1} << 48U) - (1000 - i) * kTickPeriodUs + static_cast<std::int64_t>(random() % 4'900);
  sample.angle_urad = static_cast<std::int32_t>(within(20'000'000));
  sample.torque_driver_mnm = static_cast<std::int32_t>(within(100'000));
  sample.torque_motor_mnm = static_cast<std::int32_t>(within(100'000));
  sample.sequence = static_cast<std::uint16_t>(random());
  sample.torque_bar_mnm = static_cast<std::int32_t>(within(32'767));
  sample.torque_rim_mnm = static_cast<std::int32_t>(within(32'767));
  sample.probe_mnm = static_cast<std::int32_t>(within(32'767));
  sample.valid_bits = static_cast<std::uint8_t>(random() % 64);
  return sample;
}

void expect_same(const Sample& read, const Sample& sent) {
  EXPECT_EQ(read.stamp_us, sent.stamp_us);
  EXPECT_EQ(read.angle_urad, sent.angle_urad);
  EXPECT_EQ(read.torque_driver_mnm, sent.torque_driver_mnm);
  EXPECT_EQ(read.torque_motor_mnm, sent.torque_motor_mnm);
  const bool column = (sent.valid_bits & kColumnChannels) != 0;
  EXPECT_EQ(read.torque_bar_mnm, column ? sent.torque_bar_mnm : 0);
  EXPECT_EQ(read.torque_rim_mnm, column ? sent.torque_rim_mnm : 0);
  EXPECT_EQ(read.probe_mnm, column ? sent.probe_mnm : 0);
  EXPECT_EQ(read.sequence, sent.sequence);
  EXPECT_EQ(read.valid_bits, sent.valid_bits);
}

TEST(SampleMessages, ASampleArrivesAsItWasSentInAnyOrderOfItsFrames) {
  std::mt19937_64 random(test::seed(11));
  SampleAssembly assembly;
  std::uint8_t alive = 0;
  for (int i = 0; i < 500; ++i) {
    const Sample sent = any_sample(random, i);
    auto frames = pack(sent, alive);
    std::shuffle(frames.begin(), frames.end(), random);
    Sample read;
    for (std::size_t k = 0; k + 1 < frames.size(); ++k) EXPECT_EQ(assembly.take(frames[k], read), Status::kNoData);
    ASSERT_EQ(assembly.take(frames[frames.size() - 1], read), Status::kOk);
    expect_same(read, sent);
    alive = next_alive(alive);
  }
  EXPECT_EQ(assembly.counters().corrupt + assembly.counters().repeated + assembly.counters().incomplete, 0);
}

TEST(SampleMessages, TorquesBeyondTheSignalStopAtItsEnd) {
  Sample sample;
  sample.torque_driver_mnm = INT32_MAX;
  sample.torque_motor_mnm = INT32_MIN;
  SampleAssembly assembly;
  Sample read;
  for (const Frame& frame : pack(sample, 1)) static_cast<void>(assembly.take(frame, read));
  EXPECT_EQ(read.torque_driver_mnm, (1 << 23) - 1);
  EXPECT_EQ(read.torque_motor_mnm, -(1 << 23));
}

/// The bytes of a sender that knows of three messages only, written down when there were no others.
TEST(SampleMessages, ASenderOfThreeMessagesIsUnderstood) {
  const Sample sent{.stamp_us = 1'230'000,
                    .angle_urad = -45'678,
                    .torque_driver_mnm = 1'500,
                    .torque_motor_mnm = -250,
                    .torque_bar_mnm = 1,
                    .sequence = 123};
  const auto frames = pack(sent, 7);
  ASSERT_EQ(frames.size(), 3U);
  const std::array<std::uint8_t, 7> angle{0x17, 0x92, 0x4D, 0xFF, 0xFF, 0x7B, 0x00};
  const std::array<std::uint8_t, 7> torque{0x37, 0xDC, 0x05, 0x00, 0x06, 0xFF, 0xFF};
  const std::array<std::uint8_t, 7> time{0x07, 0xB0, 0xC4, 0x12, 0x00, 0x00, 0x00};
  SampleAssembly assembly;
  Sample read;
  Status status = Status::kNoData;
  const std::array<std::pair<std::uint16_t, std::array<std::uint8_t, 7>>, 3> old{
      {{0x120, angle}, {0x121, torque}, {0x122, time}}};
  for (std::size_t i = 0; i < old.size(); ++i) {
    Frame frame{.id = old[i].first, .length = 8, .data = {}};
    std::copy(old[i].second.begin(), old[i].second.end(), frame.data.begin() + 1);
    frame.data[0] = checksum(frame);
    EXPECT_EQ(frame, frames[i]) << i;
    status = assembly.take(frame, read);
  }
  ASSERT_EQ(status, Status::kOk);
  EXPECT_EQ(read.valid_bits, kAllChannelsValid);
  EXPECT_EQ(read.torque_driver_mnm, 1'500);
  EXPECT_EQ(read.torque_bar_mnm, 0);
}

TEST(SampleMessages, ATorqueOfTheColumnBeyondItsSignalIsSentAsInvalid) {
  Sample sample;
  sample.valid_bits = kAngleValid | kTorqueBarValid | kTorqueRimValid | kProbeValid;
  sample.torque_bar_mnm = 32'768;
  sample.torque_rim_mnm = -32'768;
  sample.probe_mnm = -32'769;
  SampleAssembly assembly;
  Sample read;
  for (const Frame& frame : pack(sample, 1)) static_cast<void>(assembly.take(frame, read));
  EXPECT_EQ(read.valid_bits, kAngleValid | kTorqueRimValid);
  EXPECT_EQ(read.torque_rim_mnm, -32'768);
}

/// Before the sample is whole and after: it contradicts WheelTime, so that there are two senders.
TEST(SampleMessages, AColumnThatWasNotAnnouncedIsNotUsed) {
  Sample with;
  with.valid_bits = kAngleValid | kTorqueBarValid;
  const Frame column = pack(with, 2)[3];
  for (const std::size_t before : {0U, 2U, 3U}) {
    SampleAssembly assembly;
    Sample read;
    int delivered = 0;
    const auto frames = pack(Sample{}, 2);
    for (std::size_t i = 0; i <= frames.size(); ++i) {
      if (i == before) delivered += assembly.take(column, read) == Status::kOk ? 10 : 0;
      if (i < frames.size()) delivered += assembly.take(frames[i], read) == Status::kOk ? 1 : 0;
    }
    EXPECT_EQ(delivered, before == 3 ? 1 : 0) << before;
    EXPECT_FALSE(assembly.accepts()) << before;
    EXPECT_EQ(read.torque_bar_mnm, 0);
  }
}

TEST(SampleMessages, ALostFrameLosesItsSampleAndNoOther) {
  std::mt19937_64 random(test::seed(12));
  SampleAssembly assembly;
  std::uint8_t alive = 0;
  int delivered = 0;
  int lost = 0;
  for (int i = 0; i < 300; ++i) {
    const auto frames = pack(any_sample(random, i), alive);
    const std::size_t drop = random() % 30;  // seven lost samples in a row, which end in a trial, do not come about
    Sample read;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      if (k != drop) delivered += assembly.take(frames[k], read) == Status::kOk ? 1 : 0;
    }
    lost += drop < frames.size() ? 1 : 0;
    alive = next_alive(alive);
  }
  EXPECT_EQ(delivered, 300 - lost);
  EXPECT_NEAR(assembly.counters().incomplete, lost, 1);  // the last one may still be waited for
}

TEST(SampleMessages, NeverJoinsFramesOfTwoSamples) {
  SampleAssembly assembly;
  Sample first;
  first.angle_urad = 1;
  Sample second;
  second.angle_urad = 2;
  second.stamp_us = kTickPeriodUs;
  const auto old_frames = pack(first, 4);
  const auto new_frames = pack(second, 5);
  Sample read;
  EXPECT_EQ(assembly.take(old_frames[0], read), Status::kNoData);
  EXPECT_EQ(assembly.take(new_frames[1], read), Status::kNoData);
  EXPECT_EQ(assembly.take(new_frames[2], read), Status::kNoData);
  EXPECT_EQ(assembly.take(new_frames[0], read), Status::kOk);
  EXPECT_EQ(read.angle_urad, 2);
  EXPECT_EQ(assembly.counters().incomplete, 1);
}

TEST(SampleMessages, ASenderThatHangsIsNotNewDataAndNoContradiction) {
  SampleAssembly assembly;
  Sample read;
  const auto frames = pack(Sample{}, 3);
  for (const Frame& frame : frames) static_cast<void>(assembly.take(frame, read));
  for (int i = 0; i < 5; ++i) {
    for (const Frame& frame : frames) EXPECT_EQ(assembly.take(frame, read), Status::kOutOfRange);
  }
  EXPECT_EQ(assembly.counters().repeated, 15);
  EXPECT_TRUE(assembly.accepts());
}

TEST(SampleMessages, ADamagedFrameIsDroppedAndAForeignOnePassedOver) {
  SampleAssembly assembly;
  Sample read;
  auto frames = pack(Sample{}, 3);
  frames[1].data[4] = static_cast<std::uint8_t>(frames[1].data[4] ^ 0x10U);
  EXPECT_EQ(assembly.take(frames[1], read), Status::kCorrupt);
  EXPECT_EQ(assembly.counters().corrupt, 1);
  EXPECT_EQ(assembly.take(Frame{.id = 0x7DF, .length = 3, .data = {}}, read), Status::kNoData);
  EXPECT_EQ(assembly.counters().corrupt, 1);
}

Estimate some_estimate() {
  Estimate estimate;
  estimate.stamp_us = 123'456'789'012;
  estimate.inertia = {110'000, 1'001, ParameterState::kValid};
  estimate.damping = {1'500'000, 100, ParameterState::kValid};
  estimate.stiffness = {22'700'000, INT32_MAX, ParameterState::kValid};
  estimate.driver = DriverState::kBraced;
  estimate.hands = HandCount::kTwo;
  estimate.counters = {1, 2, 3, 4, 5, 6, 7, 65535};
  return estimate;
}

TEST(EstimateMessages, CarryValuesStatesAndDeviationsRoundedUp) {
  EstimateMessages messages;
  const auto frames = messages.next(some_estimate(), {});
  ASSERT_EQ(frames.size(), 9U);
  EXPECT_EQ(get(frames[0], kValue), 110'000);
  EXPECT_EQ(get(frames[0], kDeviation), 501);  // 1001 in steps of 2
  EXPECT_EQ(get(frames[1], kDeviation), 2);
  EXPECT_EQ(get(frames[2], kDeviation), 65535);  // more than the signal holds
  EXPECT_EQ(get(frames[3], kStamp), 123'456'789'012);
  EXPECT_EQ(get(frames[3], kValidBit), 1);
  EXPECT_EQ(get(frames[3], kFaultBit), 0);
  EXPECT_EQ(get(frames[4], kDriverState), 3);
  EXPECT_EQ(get(frames[4], kHandCount), 3);
  for (const Frame& frame : frames) EXPECT_TRUE(intact(frame)) << frame.id;
}

TEST(EstimateMessages, TellWhatTheBusHasTurnedDownUpToTheEndOfTheSignal) {
  EstimateMessages messages;
  const Frame bus =
      messages.next(some_estimate(), {.corrupt = 1, .repeated = 4095, .incomplete = 4096, .refused = 65535})[8];
  EXPECT_EQ(bus.id, 0x139);
  EXPECT_TRUE(intact(bus));
  EXPECT_EQ(get(bus, kBusCounters[0]), 1);
  EXPECT_EQ(get(bus, kBusCounters[1]), 4095);
  EXPECT_EQ(get(bus, kBusCounters[2]), 4095);
  EXPECT_EQ(get(bus, kBusCounters[3]), 4095);
}

TEST(EstimateMessages, OneParameterThatIsNotValidClearsTheBitAndAFaultSetsTheOther) {
  Estimate estimate = some_estimate();
  EstimateMessages messages;
  estimate.damping.state = ParameterState::kHolding;
  EXPECT_EQ(get(messages.next(estimate, {})[3], kValidBit), 0);
  estimate.damping.state = ParameterState::kFault;
  EXPECT_EQ(get(messages.next(estimate, {})[3], kFaultBit), 1);
}

TEST(EstimateMessages, EveryTenthCycleHasTheCountersAndEveryMessageItsOwnCounter) {
  EstimateMessages messages;
  const Estimate estimate = some_estimate();
  for (int cycle = 0; cycle < 160; ++cycle) {
    const auto frames = messages.next(estimate, {});
    ASSERT_EQ(frames.size(), cycle % 10 == 0 ? 9U : 5U) << cycle;
    EXPECT_EQ(get(frames[0], kAliveCounter), cycle % 15);
    if (frames.size() == 5U) continue;
    EXPECT_EQ(get(frames[5], kAliveCounter), cycle / 10 % 15);
  }
}

TEST(ProbeRequest, CarriesTheTorqueWithItsSign) {
  const Frame frame = probe_request(-1'234, 2);
  EXPECT_TRUE(intact(frame));
  EXPECT_EQ(get(frame, kProbeTorque), -1'234);
}

}  // namespace
}  // namespace steerid::can
