// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The loop's calls in their order, on a back end that writes them down; and what it makes of every status.
#include <gtest/gtest.h>

#include <deque>
#include <string>
#include <vector>

#include "app/run_loop.hpp"
#include "app/task.hpp"

namespace steerid {
namespace {

struct Tick {
  Status wait = Status::kOk;
  Status read = Status::kOk;
  Status publish = Status::kOk;
  Status probe = Status::kOk;
};

class RecordingHal {
 public:
  explicit RecordingHal(std::deque<Tick> ticks) : ticks_(std::move(ticks)) {}

  Status wait_tick() {
    calls.emplace_back("wait");
    if (ticks_.empty()) return Status::kEndOfStream;
    now_ = ticks_.front();
    ticks_.pop_front();
    return now_.wait;
  }
  Status read_sample(Sample& sample) {
    calls.emplace_back("read");
    sample = {};
    sample.stamp_us = ++reads_ * kTickPeriodUs;
    sample.angle_urad = static_cast<std::int32_t>(1000 * (reads_ % 7));
    sample.torque_bar_mnm = static_cast<std::int32_t>(reads_ % 2);
    sample.valid_bits = kAngleValid | kTorqueBarValid;
    return now_.read;
  }
  Status publish(const Estimate& estimate) {
    calls.emplace_back("publish");
    published.push_back(estimate);
    return now_.publish;
  }
  Status request_probe_torque(std::int32_t) {
    calls.emplace_back("probe");
    return now_.probe;
  }
  void set_valid(bool level) {
    calls.emplace_back("valid");
    valid.push_back(level);
  }
  void set_fault(bool level) {
    calls.emplace_back("fault");
    fault.push_back(level);
  }
  void kick_watchdog() { calls.emplace_back("kick"); }

  std::vector<std::string> calls;
  std::vector<Estimate> published;
  std::vector<bool> valid;
  std::vector<bool> fault;

 private:
  std::deque<Tick> ticks_;
  Tick now_;
  std::int64_t reads_ = 0;
};
static_assert(Hal<RecordingHal>);

RecordingHal run(std::deque<Tick> ticks, Status expected = Status::kOk) {
  RecordingHal hal(std::move(ticks));
  IdentificationTask<float> task;
  EXPECT_EQ(run_loop(hal, task), expected);
  return hal;
}

// The order of docs/hal_contract.md. The probe's request is left out: the task has none.
TEST(RunLoop, CallsInTheOrderOfTheContract) {
  const std::vector<std::string> tick{"wait", "read", "publish", "valid", "fault", "kick"};
  std::vector<std::string> calls;
  for (const std::string& call : run({Tick{}, Tick{}}).calls) {
    if (call != "probe") calls.push_back(call);
  }
  std::vector<std::string> expected = tick;
  expected.insert(expected.end(), tick.begin(), tick.end());
  expected.emplace_back("wait");
  EXPECT_EQ(calls, expected);
}

TEST(RunLoop, AnEndAtOnceIsAnEnd) { EXPECT_EQ(run({}).calls, std::vector<std::string>{"wait"}); }

TEST(RunLoop, ALateTickCountsAndIsDoneAllTheSame) {
  const RecordingHal hal = run({Tick{}, Tick{.wait = Status::kLate}, Tick{.wait = Status::kLate}});
  ASSERT_EQ(hal.published.size(), 3U);
  EXPECT_EQ(hal.published[0].counters.late_tick, 0);
  EXPECT_EQ(hal.published[2].counters.late_tick, 2);
  EXPECT_EQ(hal.published[2].stamp_us, 3 * kTickPeriodUs);
}

TEST(RunLoop, TicksWithoutDataAreBornForATenthOfASecond) {
  for (const Status nothing : {Status::kNoData, Status::kIoError}) {
    std::deque<Tick> ticks{Tick{}};
    for (int k = 0; k < 10; ++k) ticks.push_back({.read = nothing});
    ticks.emplace_back();
    const RecordingHal hal = run(ticks);
    ASSERT_EQ(hal.fault.size(), 12U);
    for (std::size_t k = 0; k < 12; ++k) EXPECT_EQ(hal.fault[k], k == 10) << k;
    // What the back end left in the sample of a failed read is not examined.
    EXPECT_EQ(hal.published[10].stamp_us, kTickPeriodUs);
    EXPECT_EQ(hal.published[10].inertia.state, ParameterState::kFault);
    EXPECT_NE(hal.published[11].inertia.state, ParameterState::kFault);
  }
}

TEST(RunLoop, AFailingPublishShowsOnTheFaultLineOnly) {
  const RecordingHal hal = run({Tick{}, Tick{.publish = Status::kIoError}, Tick{}});
  EXPECT_EQ(hal.fault, (std::vector<bool>{false, true, false}));
  EXPECT_EQ(hal.published.size(), 3U);
}

TEST(RunLoop, AFailingWaitEndsItWithItsStatus) {
  const RecordingHal hal = run({Tick{}, Tick{.wait = Status::kIoError}, Tick{}}, Status::kIoError);
  EXPECT_EQ(hal.published.size(), 1U);
  EXPECT_FALSE(hal.valid.back());
  EXPECT_TRUE(hal.fault.back());
}

/// Where the samples do not say what was added, what was asked for stands for it; not where it was refused.
TEST(RunLoop, ARefusedProbeStandsForNone) {
  for (const Status answer : {Status::kOk, Status::kOutOfRange}) {
    RecordingHal hal(std::deque<Tick>(1500, Tick{.probe = answer}));
    IdentificationTask<float> task;
    task.permit_probe(true);
    EXPECT_EQ(run_loop(hal, task), Status::kOk);
    EXPECT_EQ(task.identifier().follower().by_probe(), answer == Status::kOk);
  }
}

}  // namespace
}  // namespace steerid
