// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Drives and tolerances shared by the plant's tests.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "log/record.hpp"
#include "plant/effects/vocabulary.hpp"
#include "plant/plant.hpp"
#include "plant/recorder.hpp"

namespace steerid::test {

/// The sensor floor is 0.03 degree; integration may cost a tenth of it.
inline constexpr double kTenthOfFloorRad = 0.003 * std::numbers::pi / 180;
inline constexpr double kTickS = 0.01;
inline constexpr double kTwoPi = 2 * std::numbers::pi;

struct Sine {
  double amplitude, hz, phase;
};

/// A sum of sines with its slope: torque of a drive in closed form.
struct Torque {
  std::vector<Sine> sines;
  [[nodiscard]] double at(double t) const {
    double sum = 0;
    for (const Sine& s : sines) sum += s.amplitude * std::sin(kTwoPi * s.hz * t + s.phase);
    return sum;
  }
  [[nodiscard]] double slope(double t) const {
    double sum = 0;
    for (const Sine& s : sines) sum += s.amplitude * kTwoPi * s.hz * std::cos(kTwoPi * s.hz * t + s.phase);
    return sum;
  }
  [[nodiscard]] Cubic piece(double t, double h) const {
    return Cubic::hermite(at(t), slope(t), at(t + h), slope(t + h), h);
  }
};

/// Steering at 0.25 Hz while the motor probes up to 5 Hz: 1.9 Nm rms of probe, as in the gap records.
inline Torque steering(double amplitude_nm = 3) { return {{{amplitude_nm, 0.25, 0}}}; }
inline Torque probe(double amplitude_nm = 0.9) {
  Torque torque;
  constexpr std::array<double, 9> kHz = {0.31, 0.73, 1.13, 1.91, 2.39, 2.97, 3.61, 4.33, 4.97};
  for (std::size_t i = 0; i < kHz.size(); ++i) {
    torque.sines.push_back({amplitude_nm, kHz[i], 1.7 * static_cast<double>(i * i)});
  }
  return torque;
}

inline Record record_of(const Torque& driver, const Torque& motor, double duration_s) {
  Record record;
  const auto ticks = static_cast<int>(std::lround(duration_s / kTickS));
  for (int i = 0; i <= ticks; ++i) {
    const double t = i * kTickS;
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(driver.at(t));
    record.torque_motor_nm.push_back(motor.at(t));
    record.angle_rad.push_back(0);
  }
  return record;
}

inline Effect with(const EffectType& type, std::initializer_list<std::pair<std::string_view, double>> values = {}) {
  Effect effect(type);
  for (const auto& [name, value] : values) effect.at(name) = value;
  return effect;
}

/// A streaming simulation, tick by tick, as a simulated back end does it: plant, then the record effects.
inline Record stream(const WheelArm& wheel, std::span<const Effect> effects, const Torque& driver, const Torque& motor,
                     double duration_s, const WheelState& initial = {}, std::uint64_t seed = 1) {
  const RunSetting setting{.wheel = wheel, .seed = seed};
  Plant plant(effects, setting);
  Recorder recorder(effects, setting);
  plant.start(0, initial);
  Record record;
  const auto ticks = static_cast<int>(std::lround(duration_s / kTickS));
  for (int i = 0; i <= ticks; ++i) {
    const double t = i * kTickS;
    Channels now{t, driver.at(t), motor.at(t), plant.state().angle_rad, plant.state().rate_rad_s};
    recorder.before_noise(now);
    recorder.after_noise(now);
    record.time_s.push_back(now.time_s);
    record.torque_driver_nm.push_back(now.torque_driver_nm);
    record.torque_motor_nm.push_back(now.torque_motor_nm);
    record.angle_rad.push_back(now.angle_rad);
    plant.advance(driver.piece(t, kTickS), motor.piece(t, kTickS), kTickS);
  }
  return record;
}

/// The plant's angle and rate at every tick of a free motion (no torque).
struct Motion {
  std::vector<double> time_s, angle_rad, rate_rad_s;
};
inline Motion free_motion(const WheelArm& wheel, std::span<const Effect> effects, const WheelState& initial,
                          double duration_s, double step_s = kTickS) {
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, initial);
  Motion motion;
  const auto steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i <= steps; ++i) {
    motion.time_s.push_back(plant.time_s());
    motion.angle_rad.push_back(plant.state().angle_rad);
    motion.rate_rad_s.push_back(plant.state().rate_rad_s);
    plant.advance({}, {}, step_s);
  }
  return motion;
}

inline double worst_difference(std::span<const double> a, std::span<const double> b) {
  double worst = a.size() == b.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= worst)) worst = difference;  // keeps a NaN
  }
  return worst;
}

inline double rms(std::span<const double> x) {
  double sum = 0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

/// The turning points of the motion, from its rate: Hermite between samples, so not off by half a sample.
inline std::vector<double> turning_angles(const Motion& motion) {
  std::vector<double> angles;
  for (std::size_t i = 1; i < motion.time_s.size(); ++i) {
    const double a = motion.rate_rad_s[i - 1];
    const double b = motion.rate_rad_s[i];
    if (a * b >= 0) continue;
    const double h = motion.time_s[i] - motion.time_s[i - 1];
    const double s = h * a / (a - b);
    angles.push_back(Cubic::hermite(motion.angle_rad[i - 1], a, motion.angle_rad[i], b, h).at(s));
  }
  return angles;
}

}  // namespace steerid::test
