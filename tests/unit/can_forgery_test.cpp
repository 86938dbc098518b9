// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Someone else on the bus sends frames with a right checksum and a right counter: what gets through, what it does to
// the estimate, and how soon samples are accepted again when it has ended.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "app/task.hpp"
#include "can/sample_messages.hpp"
#include "support/seed.hpp"
#include "support/steady_wheel.hpp"

namespace steerid::can {
namespace {

using Frames = std::vector<Frame>;

/// An EPS that counts, and the receiver behind the bus.
class Bus {
 public:
  static constexpr std::int64_t kFirstStampUs = 5'000'000;

  /// The next sample's frames in their order, as the sender has them.
  Frames next(std::int32_t angle_urad = 0, std::int32_t torque_mnm = 0) {
    sent_ = Sample{};
    sent_.stamp_us = kFirstStampUs + count_ * kTickPeriodUs;
    sent_.angle_urad = angle_urad;
    sent_.torque_driver_mnm = torque_mnm;
    alive_ = static_cast<std::uint8_t>(count_++ % kAliveCycle);
    const auto frames = pack(sent_, alive_);
    return {frames.begin(), frames.end()};
  }
  void lose(int samples) { count_ += samples; }
  /// The samples that come out of `frames`.
  std::vector<Sample> take(const Frames& frames) {
    std::vector<Sample> out;
    for (const Frame& frame : frames) {
      Sample sample;
      if (assembly.take(frame, sample) == Status::kOk) out.push_back(sample);
    }
    return out;
  }
  [[nodiscard]] const Sample& sent() const { return sent_; }
  [[nodiscard]] std::uint8_t alive() const { return alive_; }

  SampleAssembly assembly;

 private:
  Sample sent_;
  std::int64_t count_ = 0;
  std::uint8_t alive_ = 0;
};

/// The rest of a drive of `seconds` that begins at `from`: truth is relaxed, and the forger, from `forged_from` on,
/// sends one frame a sample with the angle of a stiff arm, right after the EPS's own.
struct Drive {
  test::SteadyWheel truth{
      .inertia_kgm2 = 0.1, .damping_nms_per_rad = 1.5, .stiffness_nm_per_rad = 8, .tones = test::SteadyWheel::probe()};
  test::SteadyWheel forged{
      .inertia_kgm2 = 0.1, .damping_nms_per_rad = 1.5, .stiffness_nm_per_rad = 50, .tones = test::SteadyWheel::probe()};
  Bus bus;
  IdentificationTask<float> task;
  int ticks = 0;
  int taken = 0;

  void go_on(int seconds, bool with_forger) {
    for (const int end = ticks + 100 * seconds; ticks < end; ++ticks) {
      const double t_s = 0.01 * ticks;
      const auto urad = [t_s](const test::SteadyWheel& wheel) {
        return static_cast<std::int32_t>(std::lround(1e6 * wheel.angle_rad(t_s)));
      };
      Frames frames = bus.next(urad(truth), static_cast<std::int32_t>(std::lround(1e3 * truth.torque_nm(t_s))));
      if (with_forger) {
        Sample false_one = bus.sent();
        false_one.angle_urad = urad(forged);
        frames.insert(frames.begin() + 1, pack(false_one, bus.alive())[0]);
      }
      const std::vector<Sample> samples = bus.take(frames);
      ASSERT_LE(samples.size(), 1U);
      if (samples.empty()) {
        task.idle();
        continue;
      }
      ASSERT_EQ(samples[0].angle_urad, bus.sent().angle_urad);
      task.take(samples[0]);
      ++taken;
    }
  }
};

TEST(ForgedFrames, OneASampleFromTheStartLeavesTheTaskInFaultAndNothingLearned) {
  Drive drive;
  drive.go_on(30, true);
  const Estimate estimate = drive.task.estimate();
  EXPECT_EQ(drive.taken, 0);
  EXPECT_EQ(estimate.stiffness.state, ParameterState::kFault);
  EXPECT_EQ(estimate.driver, DriverState::kUnknown);
  EXPECT_EQ(drive.bus.assembly.counters().repeated, 3000);
  EXPECT_EQ(drive.bus.assembly.counters().refused, 3000);
  EXPECT_FALSE(drive.bus.assembly.accepts());
}

TEST(ForgedFrames, OneASampleInAGoodDriveIsAFaultAndTheTruthAgainWhenItEnds) {
  Drive drive;
  drive.go_on(30, false);
  ASSERT_TRUE(drive.task.valid());
  const double before = drive.task.estimate().stiffness.value_micro * 1e-6;
  EXPECT_NEAR(before, 8, 0.8);
  drive.go_on(10, true);
  EXPECT_TRUE(drive.task.fault());
  EXPECT_EQ(drive.taken, 3000);
  EXPECT_DOUBLE_EQ(drive.task.estimate().stiffness.value_micro * 1e-6, before);
  drive.go_on(30, false);
  EXPECT_EQ(drive.taken, 6000 - (SampleAssembly::kTrialSamples - 1));  // the last forged one was the first on trial
  EXPECT_TRUE(drive.task.valid());
  EXPECT_NEAR(drive.task.estimate().stiffness.value_micro * 1e-6, 8, 0.8);
}

/// Feeds 100 samples with one forged frame of any part, counter and contents among most of them, at `place` or
/// anywhere. Returns how many were delivered that are not the EPS's.
int delivered_forgeries(std::mt19937_64& random, std::optional<std::ptrdiff_t> place) {
  Bus bus;
  int false_ones = 0;
  const bool every_sample = random() % 2 == 0;
  for (int i = 0; i < 100; ++i) {
    Frames frames = bus.next(1'000 * i, 10 * i);
    if (i > 0 && (every_sample || random() % 4 == 0)) {  // the first of all has nothing to be held against
      Sample lie = bus.sent();
      lie.angle_urad += 77'777;
      lie.torque_motor_mnm += 555;
      lie.stamp_us += static_cast<std::int64_t>(random() % 80'000) - 20'000;
      const std::uint64_t which = random() % 4;
      const auto alive = static_cast<std::uint8_t>((bus.alive() + (which < 2    ? 0U
                                                                   : which == 2 ? 1U
                                                                                : random() % kAliveCycle)) %
                                                   kAliveCycle);
      frames.insert(frames.begin() + place.value_or(static_cast<std::ptrdiff_t>(random() % 4)),
                    pack(lie, alive)[random() % 3]);
    }
    for (const Sample& sample : bus.take(frames)) {
      const Sample& sent = bus.sent();
      const bool same = sample.angle_urad == sent.angle_urad && sample.torque_driver_mnm == sent.torque_driver_mnm &&
                        sample.torque_motor_mnm == sent.torque_motor_mnm &&
                        std::abs(sample.stamp_us - sent.stamp_us) <= kTickPeriodUs / 2;
      false_ones += same ? 0 : 1;
    }
  }
  return false_ones;
}

TEST(ForgedFrames, OneASampleAtItsPlaceNeverChangesWhatIsDelivered) {
  // The EPS sends the stamp last (layout.hpp): angle and torques are then contradicted before the sample is whole.
  std::mt19937_64 random(test::seed(21));
  for (int drive = 0; drive < 400; ++drive) EXPECT_EQ(delivered_forgeries(random, drive % 4), 0) << drive;
}

TEST(ForgedFrames, OneASampleAnywhereChangesOneOfElevenAtMost) {
  // Two forged frames that follow each other, one before a sample and one in it, may complete it before the EPS's own.
  std::mt19937_64 random(test::seed(22));
  for (int drive = 0; drive < 400; ++drive) {
    EXPECT_LE(delivered_forgeries(random, std::nullopt), 100 / (SampleAssembly::kTrialSamples + 1) + 1) << drive;
  }
}

TEST(ForgedFrames, WholeForgedSamplesOnceInElevenTeachTheTaskNothing) {
  // As often as they are accepted: each before the EPS's own, which then contradicts it.
  Drive drive;
  int forged = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const double t_s = 0.01 * tick;
    const auto torque_mnm = static_cast<std::int32_t>(std::lround(1e3 * drive.truth.torque_nm(t_s)));
    Frames frames =
        drive.bus.next(static_cast<std::int32_t>(std::lround(1e6 * drive.truth.angle_rad(t_s))), torque_mnm);
    Sample lie = drive.bus.sent();
    lie.angle_urad = static_cast<std::int32_t>(std::lround(1e6 * drive.forged.angle_rad(t_s)));
    const auto lies = pack(lie, drive.bus.alive());
    if (tick % (SampleAssembly::kTrialSamples + 1) == 0) frames.insert(frames.begin(), lies.begin(), lies.end());
    const std::vector<Sample> samples = drive.bus.take(frames);
    if (samples.empty()) {
      drive.task.idle();
    } else {
      drive.task.take(samples[0]);
      ++forged;
    }
    EXPECT_FALSE(drive.task.valid()) << tick;
  }
  EXPECT_EQ(forged, 3000 / (SampleAssembly::kTrialSamples + 1) + 1);
  const Estimate estimate = drive.task.estimate();
  for (const ParameterEstimate& parameter : {estimate.inertia, estimate.damping, estimate.stiffness}) {
    EXPECT_NE(parameter.state, ParameterState::kValid);
    EXPECT_NE(parameter.state, ParameterState::kHolding);
  }
  EXPECT_EQ(estimate.driver, DriverState::kUnknown);
}

TEST(ForgedFrames, AWholeForgedSampleBeforeEachOneGetsThroughOnceAndThenNothingDoes) {
  Bus bus;
  int forged = 0;
  int genuine = 0;
  for (int i = 0; i < 300; ++i) {
    Frames frames = bus.next(1'000);
    Sample lie = bus.sent();
    lie.angle_urad = 2'000;
    const auto lies = pack(lie, bus.alive());
    if (i >= 10) frames.insert(frames.begin(), lies.begin(), lies.end());
    for (const Sample& sample : bus.take(frames)) (sample.angle_urad == 2'000 ? forged : genuine) += 1;
  }
  EXPECT_EQ(genuine, 10);
  EXPECT_EQ(forged, 1);
}

TEST(ForgedFrames, ASecondSenderWithItsOwnCounterAndStampsIsRefusedLikeTheFirst) {
  for (int ahead = 1; ahead < kAliveCycle; ++ahead) {
    Bus bus;
    int forged = 0;
    int genuine = 0;
    for (int i = 0; i < 300; ++i) {
      Frames frames = bus.next(1'000);
      Sample lie = bus.sent();
      lie.angle_urad = 2'000;
      lie.stamp_us += ahead * kTickPeriodUs;
      const auto lies = pack(lie, static_cast<std::uint8_t>((bus.alive() + ahead) % kAliveCycle));
      if (i >= 10) frames.insert(frames.end(), lies.begin(), lies.end());
      for (const Sample& sample : bus.take(frames)) (sample.angle_urad == 2'000 ? forged : genuine) += 1;
    }
    EXPECT_LE(genuine, 11) << ahead;  // the one before the first forged sample
    EXPECT_LE(forged, 1) << ahead;
  }
}

TEST(SampleMessages, UpToSixSamplesInARowMayGetLost) {
  for (int lost = 0; lost <= 13; ++lost) {  // after 14 the counter is where it was
    Bus bus;
    EXPECT_EQ(bus.take(bus.next()).size(), 1U);
    bus.lose(lost);
    int refused = 0;
    while (bus.take(bus.next()).empty()) ++refused;
    EXPECT_EQ(refused, lost <= 6 ? 0 : SampleAssembly::kTrialSamples) << lost;
    EXPECT_EQ(bus.assembly.counters().refused, refused);
  }
}

TEST(SampleMessages, ASenderThatStartsAgainIsAcceptedAfterItsTrial) {
  Bus before;
  SampleAssembly& assembly = before.assembly;
  for (int i = 0; i < 50; ++i) before.take(before.next());
  Sample sample;
  int refused = 0;
  for (std::uint8_t alive = 0;; alive = next_alive(alive)) {
    bool whole = false;
    for (const Frame& frame : pack(sample, alive)) whole = assembly.take(frame, sample) == Status::kOk || whole;
    if (whole) break;
    ++refused;
    sample.stamp_us += kTickPeriodUs;
    ASSERT_LT(refused, 100);
  }
  EXPECT_EQ(refused, SampleAssembly::kTrialSamples);
}

TEST(SampleMessages, AReplayOfTheLastSampleIsNotNewDataWhateverComesBetween) {
  Bus bus;
  bus.take(bus.next());
  const Frames last = bus.next();
  EXPECT_EQ(bus.take(last).size(), 1U);
  EXPECT_TRUE(bus.take({pack(Sample{}, 7)[0]}).empty());
  EXPECT_TRUE(bus.take(last).empty());
  EXPECT_EQ(bus.assembly.counters().refused, 1);
}

TEST(SampleMessages, AStampThatDoesNotGoWithTheCounterIsRefused) {
  for (const std::int64_t wrong_us : {5'000, 10'000, 70'000, 1'000'000'000, -5'001, -10'000, -5'000'000}) {
    Bus bus;
    EXPECT_EQ(bus.take(bus.next()).size(), 1U);
    static_cast<void>(bus.next());
    Sample sample = bus.sent();
    sample.stamp_us += wrong_us;
    const auto frames = pack(sample, bus.alive());
    EXPECT_TRUE(bus.take({frames.begin(), frames.end()}).empty()) << wrong_us;
    EXPECT_EQ(bus.assembly.counters().refused, 1) << wrong_us;
  }
}

}  // namespace
}  // namespace steerid::can
