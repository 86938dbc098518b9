// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The plant against integrators that share no code with it:
//   smooth effects   Dormand and Prince's adaptive pair of order 5(4), written here, on equations written here
//   dry friction     Moreau's time stepping, an implicit projection with very small steps: first order, but it knows
//                    nothing of events
//   bristles         the same steps with the spring's torque, clipped where it slips
//   an arm behind a gap that is only pushed   Moreau's steps of two bodies (support/pushed_arm.hpp)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "plant_drive.hpp"
#include "support/pushed_arm.hpp"

namespace steerid::test {
namespace {

using Vector = std::array<double, 4>;
using Rates = std::function<Vector(double, const Vector&)>;

/// y(t1) from y(t0), local error below `tolerance` in every component. J. Comp. Appl. Math. 6 (1980).
Vector dormand_prince(const Rates& f, double t, double t1, Vector y, double tolerance) {
  const auto plus = [](const Vector& a, double h, std::initializer_list<std::pair<double, const Vector*>> terms) {
    Vector sum = a;
    for (const auto& [weight, k] : terms) {
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += h * weight * (*k)[i];
    }
    return sum;
  };
  double h = 1e-4;
  while (t < t1) {
    h = std::min(h, t1 - t);
    const Vector k1 = f(t, y);
    const Vector k2 = f(t + h / 5, plus(y, h, {{1.0 / 5, &k1}}));
    const Vector k3 = f(t + h * 3 / 10, plus(y, h, {{3.0 / 40, &k1}, {9.0 / 40, &k2}}));
    const Vector k4 = f(t + h * 4 / 5, plus(y, h, {{44.0 / 45, &k1}, {-56.0 / 15, &k2}, {32.0 / 9, &k3}}));
    const Vector k5 =
        f(t + h * 8 / 9,
          plus(y, h, {{19372.0 / 6561, &k1}, {-25360.0 / 2187, &k2}, {64448.0 / 6561, &k3}, {-212.0 / 729, &k4}}));
    const Vector k6 = f(t + h, plus(y, h,
                                    {{9017.0 / 3168, &k1},
                                     {-355.0 / 33, &k2},
                                     {46732.0 / 5247, &k3},
                                     {49.0 / 176, &k4},
                                     {-5103.0 / 18656, &k5}}));
    const Vector next = plus(
        y, h, {{35.0 / 384, &k1}, {500.0 / 1113, &k3}, {125.0 / 192, &k4}, {-2187.0 / 6784, &k5}, {11.0 / 84, &k6}});
    const Vector k7 = f(t + h, next);
    const Vector error = plus(Vector{}, h,
                              {{71.0 / 57600, &k1},
                               {-71.0 / 16695, &k3},
                               {71.0 / 1920, &k4},
                               {-17253.0 / 339200, &k5},
                               {22.0 / 525, &k6},
                               {-1.0 / 40, &k7}});
    double worst = 1e-30;
    for (const double e : error) worst = std::max(worst, std::abs(e));
    if (worst <= tolerance) {
      t += h;
      y = next;
    }
    h *= std::clamp(0.9 * std::pow(tolerance / worst, 0.2), 0.2, 5.0);
  }
  return y;
}

constexpr WheelArm kWheel{0.11, 1.5, 22.7};
const Torque kDriver = steering(4);
const Torque kMotor = probe();

/// Compares the stream at every half second with the reference, over 10 s.
void compare(const Effect& effect, const Rates& rates, Vector y) {
  const Record record = stream(kWheel, std::span(&effect, 1), kDriver, kMotor, 10, {y[0], y[1]});
  for (int i = 50; i <= 1000; i += 50) {
    y = dormand_prince(rates, (i - 50) * kTickS, i * kTickS, y, 1e-11);
    ASSERT_NEAR(record.angle_rad[static_cast<std::size_t>(i)], y[0], kTenthOfFloorRad) << i * kTickS << " s";
  }
  EXPECT_GT(rms(record.angle_rad), 0.05);
}

/// The right side with `extra(t, th, w)` added to the torque.
Rates wheel_with(const std::function<double(double, double, double)>& extra) {
  return [extra](double t, const Vector& y) -> Vector {
    const double torque = kDriver.at(t) - kMotor.at(t) + extra(t, y[0], y[1]);
    return {y[1], (torque - 1.5 * y[1] - 22.7 * y[0]) / 0.11, 0, 0};
  };
}

constexpr Vector kStart{0.05, 0.2, 0, 0};

TEST(Independent, CubicStiffness) {
  compare(with(effect::cubic_stiffness, {{"cubic_stiffness_nm_per_rad3", 60}}),
          wheel_with([](double, double th, double) { return -60 * th * th * th; }), kStart);
}
TEST(Independent, QuadraticDamping) {
  compare(with(effect::quadratic_damping, {{"quadratic_damping_nms2_per_rad2", 2}}),
          wheel_with([](double, double, double w) { return -2 * w * std::abs(w); }), kStart);
}
TEST(Independent, TorqueRipple) {
  compare(with(effect::torque_ripple, {{"ripple_nm", 0.6}, {"cycles_per_turn", 22}, {"phase_rad", 1}}),
          wheel_with([](double, double th, double) { return -0.6 * std::sin(22 * th + 1); }), kStart);
}
TEST(Independent, GravityImbalance) {
  compare(with(effect::gravity_imbalance, {{"weight_torque_nm", 5}, {"phase_rad", 0.6}}),
          wheel_with([](double, double th, double) { return -5 * std::sin(th + 0.6); }), kStart);
}
TEST(Independent, PeriodicDisturbance) {
  compare(with(effect::periodic_disturbance, {{"amplitude_nm", 1.5}, {"frequency_hz", 4.1}, {"phase_rad", 2}}),
          wheel_with([](double t, double, double) { return 1.5 * std::sin(kTwoPi * 4.1 * t + 2); }), kStart);
}
TEST(Independent, Swing) {
  for (const double exponent : {0.0, 0.5, 1.0}) {
    compare(
        with(effect::time_varying_stiffness,
             {{"shape", 2}, {"stiffness_ratio", 1.6}, {"time_s", 1}, {"length_s", 3}, {"damping_exponent", exponent}}),
        wheel_with([exponent](double t, double th, double w) {
          const double swing = 0.6 * std::sin(kTwoPi * (t - 1) / 3);
          const double damping = exponent == 0 ? 0 : (exponent == 1 ? swing : std::sqrt(1 + swing) - 1);
          return -22.7 * swing * th - 1.5 * damping * w;
        }),
        kStart);
  }
}
TEST(Independent, Backlash) {
  compare(with(effect::backlash, {{"half_gap_rad", 0.04}, {"wheel_damping_share", 0.2}}),
          wheel_with([](double, double th, double w) {
            const double inside = std::clamp(th, -0.04, 0.04);
            return 22.7 * inside + (std::abs(th) < 0.04 ? 0.8 * 1.5 * w : 0);
          }),
          kStart);
}
TEST(Independent, BacklashOfAnArmThatIsOnlyPushed) {
  constexpr double kStep_s = 2e-6;
  constexpr int kEvery = 5000;
  constexpr double kGap_rad = 0.04;
  PushedArm reference{.wheel = {0.033, 0.15, 0},
                      .arm = {0.077, 1.35, 22.7},
                      .half_gap_rad = kGap_rad,
                      .step_s = kStep_s,
                      .angle_rad = 0.05,
                      .rate_rad_s = 0.2,
                      .arm_angle_rad = 0.05 - kGap_rad,
                      .arm_rate_rad_s = 0.2};
  std::vector<double> angles{reference.angle_rad};
  int apart = 0;
  for (int i = 0; i < 4000000; ++i) {
    const double t = (i + 0.5) * kStep_s;
    reference.step(kDriver.at(t) - kMotor.at(t));
    apart += reference.touches ? 0 : 1;
    if ((i + 1) % kEvery == 0) angles.push_back(reference.angle_rad);
  }
  const auto streamed = [kGap_rad](double contact_shape) {
    const Effect effect = with(effect::backlash, {{"half_gap_rad", kGap_rad},
                                                  {"wheel_damping_share", 0.1},
                                                  {"wheel_inertia_share", 0.3},
                                                  {"contact_shape", contact_shape}});
    return stream(kWheel, std::span(&effect, 1), kDriver, kMotor, 8, {0.05, 0.2}).angle_rad;
  };
  EXPECT_GT(apart, 400000) << "they hardly part";
  EXPECT_LT(worst_difference(streamed(1), angles), kTenthOfFloorRad);
  EXPECT_GT(worst_difference(streamed(0), angles), 20 * kTenthOfFloorRad) << "the two laws are alike";
}
TEST(Independent, PreslidingHysteresis) {
  const Rates rates = [](double t, const Vector& y) -> Vector {
    const double z = y[2];
    const double towards = y[1] * z > 0 ? 1 : -1;
    const double torque = kDriver.at(t) - kMotor.at(t) - 0.9 * z;
    return {y[1], (torque - 1.5 * y[1] - 22.7 * y[0]) / 0.11, y[1] * (1 - towards * z * z) / 0.08, 0};
  };
  // |z|^n with the sign of th' z is z^2 with that sign for n = 2.
  compare(with(effect::presliding_hysteresis, {{"friction_nm", 0.9}, {"presliding_rad", 0.08}, {"sharpness", 2}}),
          rates, {kStart[0], kStart[1], std::tanh(kStart[0] / 0.08), 0});
}
TEST(Independent, SlidingSprings) {
  // Springs with sliders by the score, leapfrog steps: dz/ds = 1 - z loaded first, so exp(-s) ds of them slip at s.
  constexpr double kStep = 1e-5;
  constexpr int kEvery = 1000;
  constexpr double kFriction_nm = 0.9;
  constexpr double kPresliding_rad = 0.08;
  std::array<double, 600> bend{};
  constexpr double kWidth = 12.0 / 600;
  const auto pulls = [&](double turned) {
    double sum = 0;
    for (std::size_t i = 0; i < bend.size(); ++i) {
      const double slips_at = kWidth * (static_cast<double>(i) + 0.5);
      bend[i] = std::clamp(bend[i] + turned, -slips_at, slips_at);
      sum += kWidth * std::exp(-slips_at) * bend[i];
    }
    return sum;
  };
  std::vector<double> reference{0.05};
  double angle = 0.05;
  double rate = 0.2;
  pulls(angle / kPresliding_rad);  // turned there from zero
  for (int i = 0; i < 600000; ++i) {
    const double middle = angle + rate * kStep / 2;
    const double t = (i + 0.5) * kStep;
    const double torque = kDriver.at(t) - kMotor.at(t) - 22.7 * middle;
    const double z = pulls(rate * kStep / kPresliding_rad);
    rate = (0.11 * rate + kStep * (torque - kFriction_nm * z)) / (0.11 + kStep * 1.5);
    angle = middle + rate * kStep / 2;
    if ((i + 1) % kEvery == 0) reference.push_back(angle);
  }
  const Effect effect = with(effect::presliding_hysteresis,
                             {{"friction_nm", kFriction_nm}, {"presliding_rad", kPresliding_rad}, {"loop_shape", 1}});
  const Record record = stream(kWheel, std::span(&effect, 1), kDriver, kMotor, 6, {0.05, 0.2});
  EXPECT_LT(worst_difference(record.angle_rad, reference), kTenthOfFloorRad);
  const Effect one = with(effect::presliding_hysteresis,
                          {{"friction_nm", kFriction_nm}, {"presliding_rad", kPresliding_rad}, {"loop_shape", 0}});
  const Record other = stream(kWheel, std::span(&one, 1), kDriver, kMotor, 6, {0.05, 0.2});
  EXPECT_GT(worst_difference(other.angle_rad, reference), 20 * kTenthOfFloorRad) << "the two are alike";
}
TEST(Independent, Compliance) {
  const Rates rates = [](double t, const Vector& y) -> Vector {
    const double grip = 120 * (y[0] - y[2]) + 0.3 * (y[1] - y[3]);
    return {y[1], (kDriver.at(t) - kMotor.at(t) - grip - 0.15 * y[1]) / 0.033, y[3],
            (grip - 1.35 * y[3] - 22.7 * y[2]) / 0.077};
  };
  const double ratio = 120 / 142.7;
  compare(with(effect::compliance, {{"grip_stiffness_nm_per_rad", 120},
                                    {"grip_damping_nms_per_rad", 0.3},
                                    {"wheel_inertia_share", 0.3},
                                    {"wheel_damping_share", 0.1}}),
          rates, {0.05, 0.2, 0.05 * ratio, 0.2 * ratio});
}

/// Moreau: rate after the step is the projection of the frictionless one, so rest is exact and nothing is switched.
std::vector<double> moreau(const std::function<double(double)>& forward, const std::function<double(double)>& backward,
                           double angle, double rate, double duration) {
  constexpr double kStep = 2e-6;
  constexpr int kEvery = 5000;
  std::vector<double> angles{angle};
  const auto steps = static_cast<int>(std::lround(duration / kStep));
  for (int i = 0; i < steps; ++i) {
    const double middle = angle + rate * kStep / 2;
    const double t = (i + 0.5) * kStep;
    const double speed = std::abs(rate);
    const double free = (0.11 * rate + kStep * (kDriver.at(t) - kMotor.at(t) - 22.7 * middle)) / (0.11 + kStep * 1.5);
    const double up = kStep * forward(speed) / (0.11 + kStep * 1.5);
    const double down = kStep * backward(speed) / (0.11 + kStep * 1.5);
    rate = free > up ? free - up : free < -down ? free + down : 0;
    angle = middle + rate * kStep / 2;
    if ((i + 1) % kEvery == 0) angles.push_back(angle);
  }
  return angles;
}

void compare_friction(const Effect& effect, const std::function<double(double)>& forward,
                      const std::function<double(double)>& backward) {
  const Record record = stream(kWheel, std::span(&effect, 1), kDriver, kMotor, 8, {0.05, 0.2});
  const auto reference = moreau(forward, backward, 0.05, 0.2, 8);
  EXPECT_LT(worst_difference(record.angle_rad, reference), kTenthOfFloorRad);
  EXPECT_GT(rms(record.angle_rad), 0.02);
}

/// A spring of so many Nm/rad that slips at `level(direction, speed)`: leapfrog steps, the bend carried along.
std::vector<double> bristles(const std::function<double(int, double)>& level, double stiffness, double angle,
                             double rate, double duration) {
  constexpr double kStep = 2e-6;
  constexpr int kEvery = 5000;
  std::vector<double> angles{angle};
  double bend = 0;
  const auto steps = static_cast<int>(std::lround(duration / kStep));
  for (int i = 0; i < steps; ++i) {
    const double middle = angle + rate * kStep / 2;
    bend += rate * kStep;
    const int way = bend > 0 ? 1 : -1;
    bend = way * std::min(way * bend, level(way, std::max(0.0, way * rate)) / stiffness);
    const double t = (i + 0.5) * kStep;
    const double torque = kDriver.at(t) - kMotor.at(t) - 22.7 * middle - stiffness * bend;
    rate = (0.11 * rate + kStep * torque) / (0.11 + kStep * 1.5);
    angle = middle + rate * kStep / 2;
    if ((i + 1) % kEvery == 0) angles.push_back(angle);
  }
  return angles;
}

void compare_bristles(const Effect& effect, const std::function<double(int, double)>& level, double stiffness) {
  const Record record = stream(kWheel, std::span(&effect, 1), kDriver, kMotor, 8, {0.05, 0.2});
  EXPECT_LT(worst_difference(record.angle_rad, bristles(level, stiffness, 0.05, 0.2, 8)), kTenthOfFloorRad);
  EXPECT_GT(rms(record.angle_rad), 0.02);
}

TEST(Independent, CoulombFrictionWithBristles) {
  for (const double bend : {2e-4, 4e-4, 2e-3}) {
    SCOPED_TRACE(bend);
    compare_bristles(
        with(effect::coulomb_friction, {{"friction_nm", 1.5}, {"bristle_rad", bend}}), [](int, double) { return 1.5; },
        1.5 / bend);
  }
}
TEST(Independent, AsymmetricFrictionWithBristles) {
  compare_bristles(
      with(effect::asymmetric_friction,
           {{"friction_forward_nm", 0.4}, {"friction_backward_nm", 1.9}, {"bristle_rad", 5e-4}}),
      [](int way, double) { return way > 0 ? 0.4 : 1.9; }, 1.9 / 5e-4);
}
TEST(Independent, StribeckFrictionWithBristles) {
  compare_bristles(
      with(effect::stribeck_friction,
           {{"friction_nm", 0.8}, {"breakaway_ratio", 1.7}, {"stribeck_rate_rad_s", 0.3}, {"bristle_rad", 4e-4}}),
      [](int, double speed) { return 0.8 + 0.56 * std::exp(-speed * speed / 0.09); }, 1.36 / 4e-4);
}

TEST(Independent, CoulombFriction) {
  for (const double level : {0.3, 1.5, 4.0}) {
    SCOPED_TRACE(level);
    const auto friction = [level](double) { return level; };
    compare_friction(with(effect::coulomb_friction, {{"friction_nm", level}}), friction, friction);
  }
}
TEST(Independent, AsymmetricFriction) {
  compare_friction(
      with(effect::asymmetric_friction, {{"friction_forward_nm", 0.4}, {"friction_backward_nm", 1.9}}),
      [](double) { return 0.4; }, [](double) { return 1.9; });
}
TEST(Independent, StribeckFriction) {
  const auto friction = [](double speed) { return 0.8 + 0.56 * std::exp(-speed * speed / 0.09); };
  compare_friction(
      with(effect::stribeck_friction, {{"friction_nm", 0.8}, {"breakaway_ratio", 1.7}, {"stribeck_rate_rad_s", 0.3}}),
      friction, friction);
}

}  // namespace
}  // namespace steerid::test
