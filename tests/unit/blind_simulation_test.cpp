// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The blind generator's wheel against closed forms: responses to a tone, free decays, periods.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "blind_bench.hpp"

namespace steerid::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTone = 2.5;      // 25 whole cycles in 10 s
constexpr double kTorqueNm = 0.5;  // of the tone

double tone(double t) { return kTorqueNm * std::sin(2 * kPi * kTone * t); }

Complex linear(const blind::Arm& arm, double frequency_hz = kTone) {
  const Complex s = s_of(frequency_hz);
  return 1.0 / (arm.inertia_kgm2 * s * s + arm.damping_nms_per_rad * s + arm.stiffness_nm_per_rad);
}

/// The angle's complex amplitude per torque, both as recorded; equal filters cancel.
Complex recorded_response(const BlindBench& bench) {
  const Record record = bench.drive(tone);
  return amplitude(record.time_s, record.angle_rad, kTone) / amplitude(record.time_s, record.torque_driver_nm, kTone);
}

/// The tabulated torque and the integrator's tolerance leave some 1e-7; what is checked is off by 1e-2 if it is wrong.
void expect_close(Complex found, Complex expected, double relative = 2e-6) {
  EXPECT_LT(std::abs(found - expected) / std::abs(expected), relative) << found << " instead of " << expected;
}

TEST(BlindSimulation, AnswersAToneAsTheLinearWheelDoes) {
  const BlindBench bench;
  expect_close(recorded_response(bench), linear(bench.arm));
}

TEST(BlindSimulation, FiltersTheTorqueAtFortyHertz) {
  const Record record = BlindBench{}.drive(tone);
  expect_close(amplitude(record.time_s, record.torque_driver_nm, kTone), kTorqueNm * butterworth(kTone, 40));
}

TEST(BlindSimulation, AnswersTheMotorWithTheOtherSign) {
  const BlindBench bench;
  const Record record =
      blind::simulate(bench.arm, {.driver = {}, .motor = bench.signal(tone), .unseen = {}}, {}, {}, bench.run, 1)
          .record;
  expect_close(amplitude(record.time_s, record.angle_rad, kTone),
               -linear(bench.arm) * amplitude(record.time_s, record.torque_motor_nm, kTone));
}

TEST(BlindSimulation, UnseenTorqueMovesTheWheelOnly) {
  const BlindBench bench;
  const Record record =
      blind::simulate(bench.arm, {.driver = {}, .motor = {}, .unseen = bench.signal(tone)}, {}, {}, bench.run, 1)
          .record;
  expect_close(amplitude(record.time_s, record.angle_rad, kTone),
               kTorqueNm * linear(bench.arm) * butterworth(kTone, 40));
  for (const double torque : record.torque_driver_nm) ASSERT_EQ(torque, 0);
}

TEST(BlindSimulation, ReflexAsItsTransferFunction) {
  BlindBench bench;
  bench.with("reflex", {{"reflex_stiffness_nm_per_rad", 5}, {"delay_s", 0.053}, {"time_constant_s", 0.03}});
  const Complex s = s_of(kTone);
  expect_close(recorded_response(bench),
               1.0 / (1.0 / linear(bench.arm) + 5.0 * std::exp(-0.053 * s) / (0.03 * s + 1.0)),
               1e-5);  // the past is kept as quintics
}

TEST(BlindSimulation, ComplianceAsItsTransferFunction) {
  BlindBench bench;
  bench.with("compliance", {{"grip_stiffness_nm_per_rad", 200},
                            {"grip_damping_nms_per_rad", 0.4},
                            {"wheel_inertia_share", 0.3},
                            {"wheel_damping_share", 0.05}});
  const Complex s = s_of(kTone);
  const Complex grip = 200.0 + 0.4 * s;
  const Complex arm = 0.07 * s * s + 0.95 * 1.2 * s + 25.0;
  expect_close(recorded_response(bench), 1.0 / (0.03 * s * s + 0.05 * 1.2 * s + grip * arm / (grip + arm)));
}

TEST(BlindSimulation, DelayEitherWay) {
  for (const double delay_s : {0.0137, -0.0213}) {
    BlindBench bench;
    bench.with("delay", {{"delay_s", delay_s}});
    expect_close(recorded_response(bench), linear(bench.arm) * std::exp(-s_of(kTone) * delay_s));
  }
}

TEST(BlindSimulation, LagOnTheAngle) {
  BlindBench bench;
  bench.with("lag", {{"time_constant_s", 0.025}});
  expect_close(recorded_response(bench), linear(bench.arm) / (0.025 * s_of(kTone) + 1.0));
}

TEST(BlindSimulation, FractionalDampingAsAPowerOfFrequency) {
  BlindBench bench;
  bench.run.lead_in_s = 60;
  bench.with("fractional_damping", {{"coefficient_nms_a_per_rad", 4}, {"order", 0.5}});
  // Eighteen branches stand for a continuum: within 1 % of the fractional torque, a fifth of that in the answer.
  expect_close(recorded_response(bench), 1.0 / (1.0 / linear(bench.arm) + 4.0 * std::pow(s_of(kTone), 0.5)), 2e-3);
}

TEST(BlindSimulation, BiasAndDriftAreOnTheTorqueOnly) {
  BlindBench bench;
  bench.with("torque_bias", {{"bias_nm", 0.2}}).with("torque_drift", {{"drift_nm", 0.7}, {"time_constant_s", 4}});
  const Record record = bench.drive([](double) { return 1.0; });
  // At 8 s the filter lags by sqrt(2)/(2 pi 40) s behind a slope of 0.7/4 exp(-2) Nm/s.
  EXPECT_NEAR(record.torque_driver_nm[800], 1.2 + 0.7 * (1 - std::exp(-2)), 2e-4);
  EXPECT_NEAR(record.angle_rad[800], 1.0 / 25, 1e-9);
}

// ---- corners ----

/// Set free from rest at `from_rad` by a torque that vanishes at time 0 within a millisecond.
Record let_go(BlindBench& bench, double from_rad) {
  bench.sensors.corner_hz = 500;  // its delay of 0.5 ms is the same at every peak
  bench.run.rate_hz = 1000;
  const double torque = bench.arm.stiffness_nm_per_rad * from_rad;
  return bench.drive([torque](double t) { return t < 0 ? torque : 0.0; });
}

/// Heights of the turning points after the start, by the parabola through the three samples there.
std::vector<double> turning_points(const Record& record) {
  std::vector<double> peaks;
  const std::vector<double>& y = record.angle_rad;
  for (std::size_t i = 20; i + 1 < y.size(); ++i) {
    if ((y[i] - y[i - 1]) * (y[i + 1] - y[i]) >= 0) continue;
    const double slope = (y[i + 1] - y[i - 1]) / 2;
    peaks.push_back(y[i] - slope * slope / (2 * (y[i + 1] - 2 * y[i] + y[i - 1])));
  }
  return peaks;
}

/// Mean time between upward crossings of `level`.
double period(const Record& record, double level) {
  std::vector<double> crossings;
  for (std::size_t i = 20; i + 1 < record.size(); ++i) {
    const double a = record.angle_rad[i] - level;
    const double b = record.angle_rad[i + 1] - level;
    if (a < 0 && b >= 0)
      crossings.push_back(record.time_s[i] + (record.time_s[i + 1] - record.time_s[i]) * a / (a - b));
  }
  return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

TEST(BlindSimulation, DryFrictionTakesTheSameOffEveryHalfCycle) {
  BlindBench bench;
  bench.arm.damping_nms_per_rad = 0;
  bench.run.duration_s = 2;
  bench.with("coulomb_friction", {{"friction_nm", 0.25}});
  // It is held by its friction at first: the turning points count from the first one on.
  const std::vector<double> peaks = turning_points(let_go(bench, 0.2));
  ASSERT_GE(peaks.size(), 6U);
  for (std::size_t i = 1; i < 6; ++i) {
    const double span = std::abs(peaks[i] - peaks[i - 1]);
    const double loss = std::abs(peaks[i - 1]) - std::abs(peaks[i]);
    // Coulomb's 2 F/C, less what the bristles give back: over the first 2 x of the way back the friction's work is nil.
    EXPECT_NEAR(loss, 2 * 0.25 / 25 * (1 - 2 * 4e-4 / span), 1e-5);
  }
}

TEST(BlindSimulation, DryFrictionHoldsAWheelThatIsPushedLess) {
  BlindBench bench;
  bench.with("coulomb_friction", {{"friction_nm", 0.6}});
  const Record record = bench.drive(tone);
  for (const double angle : record.angle_rad) ASSERT_LT(std::abs(angle), 4e-4 * kTorqueNm / 0.6 * 1.1);
}

TEST(BlindSimulation, BreakawayIsHigherThanFrictionAtSpeed) {
  BlindBench bench;
  bench.arm = {0.1, 0.5, 1e-6};
  bench.run = {.lead_in_s = 1, .duration_s = 10};
  bench.with("stribeck_friction", {{"friction_nm", 0.4}, {"breakaway_ratio", 2}, {"stribeck_rate_rad_s", 0.3}});
  // A torque that rises by 0.1 Nm/s: it holds to 0.8 Nm, at 8 s, less the time that the bristles take to let go.
  const Record record = bench.drive([](double t) { return 0.1 * t; });
  EXPECT_LT(std::abs(record.angle_rad[790]), 1e-3);
  // From then on at least J th'' = 0.1 Nm/s t less the damping: more than half of t^3/6 after 0.8 s.
  EXPECT_GT(record.angle_rad[880], 0.04);
}

TEST(BlindSimulation, BacklashStretchesThePeriod) {
  BlindBench bench;
  bench.arm.damping_nms_per_rad = 0;
  bench.run.duration_s = 20;
  constexpr double kGap = 0.02;
  bench.with("backlash", {{"half_gap_rad", kGap}, {"wheel_damping_share", 1}});
  const Record record = let_go(bench, 0.1);
  // Half a swing of the spring on either side, and the gap crossed four times at the full speed.
  const double w = std::sqrt(25 / 0.1);
  const double stretch = std::abs(turning_points(record).front()) - kGap;
  EXPECT_NEAR(period(record, 0), 2 * kPi / w + 4 * kGap / (w * stretch), 2e-5);
}

TEST(BlindSimulation, OneSidedStiffnessJoinsTwoHalfPeriods) {
  BlindBench bench;
  bench.arm.damping_nms_per_rad = 0;
  bench.run.duration_s = 20;
  bench.with("one_sided_stiffness", {{"added_share", 0.44}});
  const Record record = let_go(bench, 0.1);
  const double w = std::sqrt(25 / 0.1);
  EXPECT_NEAR(period(record, 0), kPi / w + kPi / (1.2 * w), 1e-5);
}

TEST(BlindSimulation, EndStopThrowsTheWheelBack) {
  BlindBench bench;
  bench.arm.damping_nms_per_rad = 0;
  bench.run.duration_s = 20;
  bench.with("end_stop", {{"stop_rad", -0.05}, {"stop_stiffness_nm_per_rad", 75}});
  const Record record = let_go(bench, 0.1);
  const std::vector<double> peaks = turning_points(record);
  ASSERT_GE(peaks.size(), 4U);
  const double free_side = std::max(peaks[1], peaks[2]);
  // Energy: C a^2 = C x^2 + K (x - s)^2 at the turning point in the stop, C = 25, K = 75, s = 0.05.
  const double a2 = free_side * free_side;
  const double far = (75 * 0.05 + std::sqrt(75 * 75 * 0.0025 - 100 * (75 * 0.0025 - 25 * a2))) / 100;
  EXPECT_NEAR(std::min(peaks[1], peaks[2]), -far, 2e-5);
  EXPECT_NEAR(std::max(peaks[3], peaks[2]), free_side, 2e-5);
}

TEST(BlindSimulation, SensorBacklashStandsAtTheTurns) {
  BlindBench bench;
  bench.sensors.corner_hz = 400;
  bench.with("sensor_backlash", {{"half_play_rad", 0.002}});
  const Record record = bench.drive(tone);
  // The play operator takes its half width off either peak.
  const double swing = kTorqueNm * std::abs(linear(bench.arm));
  double most = 0;
  for (const double angle : record.angle_rad) most = std::max(most, angle);
  EXPECT_NEAR(most, swing - 0.002, 2e-5);
}

TEST(BlindSimulation, AWheelLeftAloneRunsAway) {
  BlindBench bench;
  bench.sensors.corner_hz = 400;
  bench.with("hands_off", {{"period_s", 20},
                           {"away_s", 0.5},
                           {"first_s", 4},
                           {"fade_s", 0},
                           {"wheel_inertia_share", 0.3},
                           {"wheel_damping_share", 0.05}});
  constexpr double kMotorNm = 1;
  const Record record = blind::simulate(bench.arm,
                                        {.driver = bench.signal([](double) { return 0.4; }),
                                         .motor = bench.signal([](double) { return kMotorNm; }),
                                         .unseen = {}},
                                        bench.elements, bench.sensors, bench.run, 1)
                            .record;
  // J_w th'' + B_w th' = -T_motor from rest: a fall that settles at its final speed.
  const double time_constant = 0.3 * 0.1 / (0.05 * 1.2);
  const double speed = -kMotorNm / (0.05 * 1.2);
  const double since = 0.3 - std::numbers::sqrt2 / (2 * kPi * 400);  // the filter's delay
  const double fallen = speed * (since - time_constant * (1 - std::exp(-since / time_constant)));
  EXPECT_NEAR(record.angle_rad[399], (0.4 - kMotorNm) / 25, 1e-6);
  EXPECT_NEAR(record.angle_rad[430], (0.4 - kMotorNm) / 25 + fallen, 1e-4);
  EXPECT_NEAR(record.torque_driver_nm[399], 0.4, 1e-6);
  EXPECT_NEAR(record.torque_driver_nm[430], 0, 1e-6);
  EXPECT_NEAR(record.torque_driver_nm[999], 0.4, 1e-6);
}

// ---- what is written down ----

TEST(BlindSimulation, WritesNoiseAndResolutionAsAsked) {
  BlindBench bench;
  bench.sensors = {.driver_noise_nm = 0.02, .angle_noise_rad = 0.001, .driver_step_nm = 0.005, .angle_step_rad = 5e-4};
  bench.run = {.lead_in_s = 1, .duration_s = 100};
  const Record record = bench.drive([](double) { return 0.0; });
  double angle = 0, torque = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    angle += record.angle_rad[i] * record.angle_rad[i] / static_cast<double>(record.size());
    torque += record.torque_driver_nm[i] * record.torque_driver_nm[i] / static_cast<double>(record.size());
    ASSERT_NEAR(record.angle_rad[i] / 5e-4, std::round(record.angle_rad[i] / 5e-4), 1e-9);
  }
  // Rounding adds a twelfth of the step's square. 10,000 samples know a deviation to 0.7 %: five of those.
  EXPECT_NEAR(std::sqrt(angle), std::hypot(0.001, 5e-4 / std::sqrt(12)), 0.035 * 0.001);
  EXPECT_NEAR(std::sqrt(torque), std::hypot(0.02, 0.005 / std::sqrt(12)), 0.035 * 0.02);
}

TEST(BlindSimulation, LosesSamplesClipsAndCoarsens) {
  BlindBench bench;
  bench.run = {.lead_in_s = 1, .duration_s = 100};
  bench.with("torque_saturation", {{"limit_nm", 0.3}}).with("sample_loss", {{"loss_probability", 0.2}});
  const Record record = bench.drive(tone);
  double repeats = 0, most = 0;
  for (std::size_t i = 1; i < record.size(); ++i) {
    repeats += record.angle_rad[i] == record.angle_rad[i - 1] ? 1 : 0;
    most = std::max(most, std::abs(record.torque_driver_nm[i]));
  }
  EXPECT_NEAR(repeats / static_cast<double>(record.size()), 0.2, 5 * 0.004);  // binomial, 10,000 draws
  EXPECT_EQ(most, 0.3);

  BlindBench coarse;
  coarse.with("coarse_quantization", {{"step_rad", 0.004}});
  for (const double angle : coarse.drive(tone).angle_rad) {
    ASSERT_NEAR(angle / 0.004, std::round(angle / 0.004), 1e-9);
  }
}

}  // namespace
}  // namespace steerid::test
