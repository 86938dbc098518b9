// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drive with a known answer that shares no code with the plant: the wheel's equation by the midpoint rule in steps of
// 0.1 ms, dry friction as a stick-slip set, torques as sums of sines, and white noise from a generator of its own.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "log/record.hpp"
#include "plant/simulation.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::test {

/// A simulation whose J, B and C are off by what they usually are.
inline Simulation off_by_five_percent(const WheelArm& wheel) {
  Simulation simulation;
  simulation.wheel = {1.05 * wheel.inertia_kgm2, 0.96 * wheel.damping_nms_per_rad, 1.04 * wheel.stiffness_nm_per_rad};
  return simulation;
}

struct DrawnDrive {
  WheelArm wheel{0.11, 1.5, 22.7};
  double duration_s = 60;
  double probe_rms_nm = 1.8;
  /// The motor's torque of time, in place of a drawn multisine.
  std::function<double(double)> probe_nm{};
  double torque_noise_nm = 0.02;
  double angle_noise_rad = 0.0006;
  /// The effect: a torque of (time, angle, rate); dry friction apart, because it holds.
  std::function<double(double, double, double)> torque = [](double, double, double) { return 0.0; };
  double dry_friction_nm = 0;
  double bristle_rad = 0;                      ///< what the friction bends before it slips
  double clockwise_share = 1;                  ///< of the friction with bristles, what holds as it turns clockwise
  double delay_s = 0;                          ///< of the angle's record
  std::function<double(double)> delay_by_s{};  ///< further, by so much at a time of the drive; 3 s at most
  double lag_s = 0;                            ///< likewise, of first order
  /// Whether the hand is away at a time. It takes the spring with it, and all but these shares of inertia and damping.
  std::function<bool(double)> away = [](double) { return false; };
  double wheel_inertia_share = 0.3;
  double wheel_damping_share = 0.05;
};

/// A torque that no sensor sees: below 0.3 Hz, 2 % of a DrawnDrive's applied one.
inline double unseen_nm(double t) {
  double sum = 0;
  for (int k = 1; k <= 6; ++k) sum += std::cos(0.3 * k * t + k * k);
  return 0.02 * DrawnDrive{}.probe_rms_nm * std::sqrt(2.0 / 6) * sum;
}

/// Sum of 120 uniform numbers, centred: normal enough, and the same everywhere.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  double operator()() {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum - 6;
  }
  double uniform() { return 0x1p-53 * static_cast<double>(engine_() >> 11U); }

 private:
  std::mt19937_64 engine_;
};

inline Record drive(const DrawnDrive& what, std::uint64_t seed) {
  Noise noise(seed);
  constexpr int kTones = 60;
  std::vector<double> phase;
  for (int k = 0; k < kTones; ++k) phase.push_back(2 * std::numbers::pi * noise.uniform());
  const auto motor = [&](double t) {
    if (what.probe_nm) return what.probe_nm(t);
    double sum = 0;
    for (int k = 0; k < kTones; ++k) {
      sum += std::cos(2 * std::numbers::pi * (0.15 + 0.0871 * k) * t + phase[static_cast<std::size_t>(k)]);
    }
    return what.probe_rms_nm * std::sqrt(2.0 / kTones) * sum;
  };
  constexpr double kStep_s = 1e-4;
  double angle = 0;
  double rate = 0;
  double bend = 0;
  double lagging = 0;
  std::vector<double> course;  // of the angle, every step, for the delay
  Record record;
  const auto slope = [&](double t, double x, double v) {
    const double held = what.bristle_rad > 0 ? what.dry_friction_nm * bend / what.bristle_rad : 0;
    const bool away = what.away(t);
    const double damping = (away ? what.wheel_damping_share : 1) * what.wheel.damping_nms_per_rad;
    const double stiffness = away ? 0 : what.wheel.stiffness_nm_per_rad;
    const double inertia = (away ? what.wheel_inertia_share : 1) * what.wheel.inertia_kgm2;
    return (-motor(t) + what.torque(t, x, v) - held - damping * v - stiffness * x) / inertia;
  };
  const double settle_s = 3;
  const auto steps = static_cast<int>((what.duration_s + settle_s) / kStep_s);
  for (int i = 0; i < steps; ++i) {
    const double t = i * kStep_s;
    lagging += what.lag_s > 0 ? (angle - lagging) * -std::expm1(-kStep_s / what.lag_s) : angle - lagging;
    course.push_back(lagging);
    if (t >= settle_s && i % 100 == 0) {
      record.time_s.push_back(std::round((t - settle_s) * 1000) / 1000);
      record.torque_driver_nm.push_back(what.torque_noise_nm * noise());
      record.torque_motor_nm.push_back(motor(t));
      const double late_s = what.delay_s + (what.delay_by_s ? what.delay_by_s(t) : 0.0);
      const double at = i - late_s / kStep_s;
      const auto before = static_cast<std::size_t>(at);
      const double next = course[std::min(before + 1, course.size() - 1)];
      const double read = course[before] + (at - std::floor(at)) * (next - course[before]);
      record.angle_rad.push_back(read + what.angle_noise_rad * noise());
    }
    const double half_rate = rate + kStep_s / 2 * slope(t, angle, rate);
    const double half_angle = angle + kStep_s / 2 * rate;
    const double force = slope(t + kStep_s / 2, half_angle, half_rate);
    const double next = rate + kStep_s * force;
    const bool ideal = what.dry_friction_nm > 0 && !(what.bristle_rad > 0);
    const double friction = ideal ? kStep_s * what.dry_friction_nm / what.wheel.inertia_kgm2 : 0;
    // The implicit step of a set: friction brings the rate to rest if it can, else it takes all it has.
    rate = std::abs(next) <= friction ? 0 : next - std::copysign(friction, next);
    const double turned = kStep_s * (ideal ? rate : half_rate);
    angle += turned;
    bend = std::clamp(bend + turned, -what.clockwise_share * what.bristle_rad, what.bristle_rad);
  }
  return record;
}

}  // namespace steerid::test
