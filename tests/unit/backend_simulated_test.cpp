// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The simulated back end: its ticks and statuses, its truth against an integrator of the test's own, and what it lies
// about between samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "backend/simulated.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/independent_wheel.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

Scenario scenario(TaskKind kind, std::uint64_t seed, double duration_s = 20.0) {
  Scenario s;
  s.task = task_settings(kind, HandPosition::kRight3, seed);
  s.wheel = s.task.arm;
  s.duration_s = duration_s;
  return s;
}

SimulatedDrive drive(const Scenario& s) {
  SimulatedDrive result;
  SimulatedHal hal(s, &result);
  Sample sample;
  while (hal.wait_tick() == Status::kOk) static_cast<void>(hal.read_sample(sample));
  return result;
}

/// The signal between samples k and k + 1 by Lagrange's polynomial through the six nearest samples: what anybody would
/// rebuild from the record. Error at 5 Hz: (2 pi 5/100)^6 * 225/(64 * 720) = 5e-6.
double rebuilt(const std::vector<double>& x, std::size_t k, double tau) {
  const auto last = static_cast<std::ptrdiff_t>(x.size()) - 6;
  const auto first = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(k) - 2, 0, last);
  const double at = static_cast<double>(k) + tau / 0.01 - static_cast<double>(first);
  double sum = 0;
  for (int i = 0; i < 6; ++i) {
    double weight = 1;
    for (int j = 0; j < 6; ++j) {
      if (j != i) weight *= (at - j) / (i - j);
    }
    sum += weight * x[static_cast<std::size_t>(first + i)];
  }
  return sum;
}

/// By how much `angle` comes after `reference`, least squares on the reference's slope.
double delay_s(const std::vector<double>& reference, const std::vector<double>& angle) {
  double against = 0;
  double slopes = 0;
  for (std::size_t k = 1; k + 1 < reference.size(); ++k) {
    const double slope = (reference[k + 1] - reference[k - 1]) / 0.02;
    against += (reference[k] - angle[k]) * slope;
    slopes += slope * slope;
  }
  return against / slopes;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
  return worst;
}

TEST(SimulatedHal, TicksEveryTenMillisecondsAndEnds) {
  SimulatedHal hal(scenario(TaskKind::kProbe, 1, 0.5));
  Sample sample;
  for (int k = 0; k < 50; ++k) {
    ASSERT_EQ(hal.wait_tick(), Status::kOk);
    ASSERT_EQ(hal.read_sample(sample), Status::kOk);
    EXPECT_EQ(sample.stamp_us, k * kTickPeriodUs);
    EXPECT_EQ(sample.sequence, k + 1);
    EXPECT_EQ(sample.valid_bits, kAllChannelsValid);
    EXPECT_EQ(hal.read_sample(sample), Status::kNoData);
  }
  EXPECT_EQ(hal.wait_tick(), Status::kEndOfStream);
  EXPECT_EQ(hal.wait_tick(), Status::kEndOfStream);
}

TEST(SimulatedHal, KeepsWhatTheTaskHandsOut) {
  SimulatedDrive result;
  SimulatedHal hal(scenario(TaskKind::kProbe, 1, 0.1), &result);
  ASSERT_EQ(hal.wait_tick(), Status::kOk);
  Estimate estimate;
  estimate.stamp_us = 123;
  EXPECT_EQ(hal.publish(estimate), Status::kOk);
  EXPECT_EQ(hal.estimate().stamp_us, 123);
  ASSERT_EQ(result.estimates.size(), 1U);
  EXPECT_EQ(result.estimates[0].stamp_us, 123);
  EXPECT_FALSE(hal.valid());
  hal.set_valid(true);
  EXPECT_TRUE(hal.valid());
  hal.set_fault(true);
  EXPECT_TRUE(hal.fault());
  hal.kick_watchdog();
  hal.kick_watchdog();
  EXPECT_EQ(hal.watchdog_kicks(), 2U);
}

TEST(SimulatedHal, MovesTheWheelAsAnIndependentIntegratorDoes) {
  for (const TaskKind kind : kAllTasks) {
    for (const EpsTorque eps : {EpsTorque::kSmooth, EpsTorque::kHeld}) {
      Scenario s = scenario(kind, test::seed(60));
      s.task.eps = eps;
      s.task.unmeasured_percent = 10;
      const SimulatedDrive result = drive(s);
      // The torques as the task states them, integrated in 20 steps a tick: wn h = 7e-3, so that the oracle's own
      // error is about (wn h)^4/120 = 2e-11 of the angle a radian of phase.
      Task task(s.task);
      std::vector<TaskTorques> torques;
      for (std::size_t k = 0; k < result.truth.size(); ++k) torques.push_back(task.next());
      const auto oracle = test::independent_angles(s.wheel, torques.size(), 20, [&](std::size_t k, double tau) {
        return torques[k].driver.at(tau) + torques[k].unmeasured.at(tau) - torques[k].motor.at(tau);
      });
      EXPECT_LT(largest_difference(result.truth.angle_rad, oracle), 1e-8) << name(kind);
      EXPECT_GT(largest_difference(result.truth.angle_rad, std::vector<double>(oracle.size(), 0.0)), 0.05);
    }
  }
}

TEST(SimulatedHal, ASmoothTorqueIsAllInItsSamplesAndHasNoDelay) {
  Scenario s = scenario(TaskKind::kProbe, test::seed(61));
  s.sensors = SensorDefects::none();
  const SimulatedDrive result = drive(s);
  const Record& record = result.measured;
  const auto rebuilt_run = test::independent_angles(s.wheel, record.size(), 4, [&](std::size_t k, double tau) {
    return rebuilt(record.torque_driver_nm, k, tau) - rebuilt(record.torque_motor_nm, k, tau);
  });
  // A tenth of the angle sensor's noise (0.7 mrad) is what a record may be wrong by; 1 us is a ten-thousandth of a
  // tick.
  EXPECT_LT(largest_difference(record.angle_rad, rebuilt_run), 7e-5);
  EXPECT_LT(std::abs(delay_s(rebuilt_run, record.angle_rad)), 1e-5);
}

TEST(SimulatedHal, AHeldTorqueActsFromItsStampToTheNextAndIsHalfATickLateForWhoTakesItForSmooth) {
  Scenario s = scenario(TaskKind::kProbe, test::seed(62));
  s.sensors = SensorDefects::none();
  s.task.eps = EpsTorque::kHeld;
  const SimulatedDrive result = drive(s);
  const Record& record = result.measured;
  const auto held = test::independent_angles(s.wheel, record.size(), 4, [&](std::size_t k, double tau) {
    return rebuilt(record.torque_driver_nm, k, tau) - record.torque_motor_nm[k];
  });
  EXPECT_LT(largest_difference(record.angle_rad, held), 7e-5);
  EXPECT_LT(std::abs(delay_s(held, record.angle_rad)), 1e-5);
  const auto smooth = test::independent_angles(s.wheel, record.size(), 4, [&](std::size_t k, double tau) {
    return rebuilt(record.torque_driver_nm, k, tau) - rebuilt(record.torque_motor_nm, k, tau);
  });
  // Half a tick; the small part of the angle that the smooth driver's torque moves is not late.
  EXPECT_NEAR(delay_s(smooth, record.angle_rad), 0.005, 0.0005);
}

TEST(SimulatedHal, MeasuresTheTruthWhenTheSensorsArePerfect) {
  Scenario s = scenario(TaskKind::kActive, test::seed(63));
  s.sensors = SensorDefects::none();
  const SimulatedDrive result = drive(s);
  EXPECT_EQ(result.measured.angle_rad, result.truth.angle_rad);
  EXPECT_EQ(result.measured.torque_driver_nm, result.truth.torque_driver_nm);
  EXPECT_EQ(result.measured.torque_motor_nm, result.truth.torque_motor_nm);
}

TEST(SimulatedHal, SensorsDoNotMoveTheWheel) {
  Scenario s = scenario(TaskKind::kActive, test::seed(64));
  const SimulatedDrive noisy = drive(s);
  s.sensors = SensorDefects::none();
  const SimulatedDrive clean = drive(s);
  EXPECT_EQ(noisy.truth.angle_rad, clean.truth.angle_rad);
  EXPECT_NE(noisy.measured.angle_rad, clean.measured.angle_rad);
}

TEST(SimulatedHal, RepeatsBitForBitFromItsSeed) {
  for (const TaskKind kind : kAllTasks) {
    Scenario s = scenario(kind, test::seed(65));
    s.task.unmeasured_percent = 2;
    s.sensors.jitter.spread_us = 500;
    const SimulatedDrive a = drive(s);
    const SimulatedDrive b = drive(s);
    EXPECT_EQ(a.measured.time_s, b.measured.time_s);
    EXPECT_EQ(a.measured.angle_rad, b.measured.angle_rad);
    EXPECT_EQ(a.measured.torque_driver_nm, b.measured.torque_driver_nm);
    EXPECT_EQ(a.measured.torque_motor_nm, b.measured.torque_motor_nm);
    s.task.seed += 1;
    EXPECT_NE(drive(s).measured.angle_rad, a.measured.angle_rad);
  }
}

TEST(SimulatedHal, RowsAndSamplesAreTheSameMeasurement) {
  SimulatedDrive result;
  SimulatedHal hal(scenario(TaskKind::kActive, test::seed(66), 2.0), &result);
  Sample sample;
  for (std::size_t k = 0; hal.wait_tick() == Status::kOk; ++k) {
    ASSERT_EQ(hal.read_sample(sample), Status::kOk);
    ASSERT_NEAR(sample.angle_urad * 1e-6, result.measured.angle_rad[k], 0.5e-6 * (1 + 1e-6));
    ASSERT_NEAR(sample.torque_driver_mnm * 1e-3, result.measured.torque_driver_nm[k], 0.5e-3 * (1 + 1e-6));
    ASSERT_NEAR(sample.torque_motor_mnm * 1e-3, result.measured.torque_motor_nm[k], 0.5e-3 * (1 + 1e-6));
  }
}

TEST(SimulatedHal, ALostMessageIsNoDataAndAGapInTheSequence) {
  Scenario s = scenario(TaskKind::kProbe, test::seed(67), 10.0);
  s.sensors.message_loss.fraction = 0.2;
  SimulatedDrive result;
  SimulatedHal hal(s, &result);
  Sample sample;
  std::size_t received = 0;
  std::size_t lost = 0;
  for (int k = 0; hal.wait_tick() == Status::kOk; ++k) {
    if (hal.read_sample(sample) == Status::kOk) {
      ++received;
      ASSERT_EQ(sample.sequence, k + 1);
      ASSERT_EQ(sample.stamp_us, k * kTickPeriodUs);
    } else {
      ++lost;
    }
  }
  EXPECT_EQ(received, result.measured.size());
  EXPECT_EQ(received, result.truth.size());
  EXPECT_EQ(received + lost, 1000U);
  EXPECT_NEAR(static_cast<double>(lost), 200.0, 4.5 * std::sqrt(1000 * 0.2 * 0.8));
}

TEST(SimulatedHal, AppliesGrantedProbeRequests) {
  for (const EpsTorque eps : {EpsTorque::kHeld, EpsTorque::kSmooth}) {
    Scenario s = scenario(TaskKind::kProbe, 1, 1.0);
    s.task.probe.rms_nm = 0.0;
    s.task.eps = eps;
    s.sensors = SensorDefects::none();
    s.grant_probe_requests = true;
    SimulatedDrive result;
    SimulatedHal hal(s, &result);
    std::vector<double> requested_nm;
    for (int k = 0; hal.wait_tick() == Status::kOk; ++k) {
      const int mnm = static_cast<int>(std::lround(1000 * std::sin(0.2 * k)));
      ASSERT_EQ(hal.request_probe_torque(mnm), Status::kOk);
      requested_nm.push_back(mnm * 1e-3);
    }
    const std::size_t way = eps == EpsTorque::kHeld ? 1 : 3;
    for (std::size_t k = way; k < requested_nm.size(); ++k) {
      ASSERT_DOUBLE_EQ(result.truth.torque_motor_nm[k], requested_nm[k - way]);
    }
  }
}

TEST(SimulatedHal, RefusesProbesThatAreTooStrongAndIgnoresThoseNotGranted) {
  Scenario s = scenario(TaskKind::kProbe, 1, 0.2);
  s.task.probe.rms_nm = 0.0;
  s.sensors = SensorDefects::none();
  SimulatedDrive result;
  SimulatedHal hal(s, &result);
  while (hal.wait_tick() == Status::kOk) {
    ASSERT_EQ(hal.request_probe_torque(kLargestProbeMnm), Status::kOk);
    ASSERT_EQ(hal.request_probe_torque(-kLargestProbeMnm - 1), Status::kOutOfRange);
  }
  for (const double torque : result.truth.torque_motor_nm) ASSERT_EQ(torque, 0.0);
}

TEST(SimulatedHal, EveryEffectChangesTheRecordAndRepeats) {
  for (const EffectType* type : effects()) {
    // An active drive moves far enough for all of them.
    Scenario s = scenario(TaskKind::kActive, test::seed(68), 40.0);
    s.sensors = SensorDefects::none();
    const SimulatedDrive without = drive(s);
    s.effects.emplace_back(*type);
    const SimulatedDrive with = drive(s);
    const bool changed = with.measured.angle_rad != without.measured.angle_rad ||
                         with.measured.torque_driver_nm != without.measured.torque_driver_nm;
    EXPECT_TRUE(changed) << type->id;
    EXPECT_TRUE(std::ranges::all_of(with.measured.angle_rad, [](double a) { return std::abs(a) < 10.0; })) << type->id;
    EXPECT_EQ(with.measured.angle_rad, drive(s).measured.angle_rad) << type->id;
  }
}

}  // namespace
}  // namespace steerid
