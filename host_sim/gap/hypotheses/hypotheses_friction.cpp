// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Friction on the measured motion.
//
// Where the wheel slides, dry friction is its level against the rate. Where it sticks, friction is whatever balances
// the other torques, up to its level; there the measured rate is noise and says nothing. The two are blended by the
// rate over kStick_rad_s, a few times what noise leaves in a smoothed rate.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "gap/hypotheses/hypotheses.hpp"
#include "gap/hypotheses/hysteresis_loop.hpp"
#include "gap/hypotheses/slow_share.hpp"
#include "plant/effects/sliding_springs.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

constexpr double kStick_rad_s = 0.015;

class Dry : public Hypothesis {
 public:
  /// What holds it at rest is the torque that the spring leaves. Its last value, the bristles' bend, does not
  /// show on the measured motion, and starts at zero: ideal.
  Dry(const EffectType& effect, Starts starts)
      : Hypothesis(effect, {.family = Family::kFriction,
                            .sticks = true,
                            .knows = {.stiffness = true},
                            .unshown = 1,
                            .starts = std::move(starts)}) {}
  void torque(const WheelArm& wheel, const double* values, const Record& record, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const final {
    std::vector<double> ideal(values, values + shown());
    ideal.push_back(0);
    const auto friction = type().in_plant(ideal, {}, {.wheel = wheel, .replay = true});
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double rate = motion.rate_rad_s[i];
      const int way = rate < 0 ? -1 : 1;
      const double sliding = way * friction->dry_friction_nm(way, std::abs(rate));
      const double x = rate / kStick_rad_s;
      const double weight = std::abs(x) < 4 ? std::exp(-x * x) : 0.0;
      torque_nm[i] = -sliding;
      if (weight > 0) {
        const double drive = record.net_torque_nm(i) - wheel.stiffness_nm_per_rad * motion.angle_rad[i];
        const double holding = std::clamp(drive, -friction->dry_friction_nm(-1, 0), friction->dry_friction_nm(1, 0));
        torque_nm[i] = -(weight * holding + (1 - weight) * sliding);
      }
    }
  }
  /// A level that is bent away from by a wheel's natural frequency of 20 Hz: a fit that begins with ideal friction, or
  /// with bristles that the plant counts as none, does not leave it.
  [[nodiscard]] std::vector<double> to_run(std::vector<double> values, const WheelArm& wheel) const final {
    constexpr double kSwing_hz = 20;
    if (!type().in_plant(values, {}, {.wheel = wheel})->traits().dry) return values;
    const double stiffness = wheel.inertia_kgm2 * std::pow(2 * std::numbers::pi * kSwing_hz, 2);
    values.back() = largest(values.data()) / stiffness;
    return values;
  }
  [[nodiscard]] std::optional<std::vector<double>> in_place_of(const Effect& relative) const final {
    const auto* dry = dynamic_cast<const Dry*>(hypothesis_of(*relative.type));
    if (dry == nullptr) return std::nullopt;
    return of_level(dry->level(relative.values.data()), relative.values.back());
  }

 private:
  /// Of Coulomb's friction that comes nearest, Nm.
  [[nodiscard]] virtual double level(const double* values) const = 0;
  [[nodiscard]] virtual double largest(const double* values) const { return level(values); }
  [[nodiscard]] virtual std::vector<double> of_level(double level_nm, double bristle_rad) const = 0;
};

class Coulomb final : public Dry {
 public:
  Coulomb() : Dry(effect::coulomb_friction, {.values = {{0.05, 0}, {0.3, 0}, {1.0, 0}}, .scaled = 0, .keep = 1}) {}

 private:
  [[nodiscard]] double level(const double* values) const override { return values[0]; }
  [[nodiscard]] std::vector<double> of_level(double level_nm, double bristle_rad) const override {
    return {level_nm, bristle_rad};
  }
};

Hypothesis::Starts stribeck_starts() {
  Hypothesis::Starts starts{.scaled = 0, .keep = 3};
  for (const double friction : {0.1, 0.5}) {
    for (const double rate : {0.05, 0.12, 0.25, 0.5, 1.0}) {
      for (const double ratio : {1.3, 1.8, 2.5}) starts.values.push_back({friction, ratio, rate, 0});
    }
  }
  return starts;
}

class Stribeck final : public Dry {
 public:
  Stribeck() : Dry(effect::stribeck_friction, stribeck_starts()) {}
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    return values[0] * (values[1] - 1) > kMeanSlowShare * usual.applied_rms_nm;
  }

 private:
  [[nodiscard]] double level(const double* values) const override { return values[0]; }
  [[nodiscard]] std::vector<double> of_level(double level_nm, double bristle_rad) const override {
    std::vector<double> values = Effect(type()).values;
    values[0] = level_nm;
    values[1] = 1;
    values.back() = bristle_rad;
    return values;
  }
};

Hypothesis::Starts asymmetric_starts() {
  Hypothesis::Starts starts{.scaled = 0, .keep = 2};
  for (const double size : {0.1, 0.5}) {
    for (const double ratio : {0.1, 0.3, 0.6, 1.0, 1.7, 3.0, 10.0}) {
      starts.values.push_back({size, size * ratio, 0});
    }
  }
  return starts;
}

class Asymmetric final : public Dry {
 public:
  Asymmetric() : Dry(effect::asymmetric_friction, asymmetric_starts()) {}
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    return std::abs(values[0] - values[1]) / 2 > kMeanSlowShare * usual.applied_rms_nm;
  }

 private:
  [[nodiscard]] double level(const double* values) const override { return (values[0] + values[1]) / 2; }
  [[nodiscard]] double largest(const double* values) const override { return std::max(values[0], values[1]); }
  [[nodiscard]] std::vector<double> of_level(double level_nm, double bristle_rad) const override {
    return {level_nm, level_nm, bristle_rad};
  }
};

Hypothesis::Starts hysteresis_starts() {
  Hypothesis::Starts starts{.scaled = 0, .keep = 3};
  for (const double x : {0.01, 0.03, 0.07, 0.15, 0.3, 0.6}) {
    for (const double sharpness : {1.0, 2.5}) {
      for (const double loop_shape : {0.0, 1.0}) starts.values.push_back({1.0, x, sharpness, loop_shape});
    }
  }
  return starts;
}

class Hysteresis final : public Hypothesis {
 public:
  Hysteresis()
      : Hypothesis(effect::presliding_hysteresis,
                   {.family = Family::kFriction, .linear = {.scale = 0}, .starts = hysteresis_starts()}) {}
  /// One that never slides is a bent spring.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    return values[1] < usual.swing_rad;
  }
  void torque(const WheelArm&, const double* values, const Record& record, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const override {
    const std::vector<double>& angle_rad = motion.angle_rad;
    torque_nm[0] = 0;
    if (values[3] > 0) {
      effect::SlidingSprings springs(values[2]);
      for (std::size_t i = 1; i < record.size(); ++i) {
        const int way = angle_rad[i] < angle_rad[i - 1] ? -1 : 1;
        torque_nm[i] = -values[0] * springs.go((angle_rad[i] - angle_rad[0]) / values[1], way);
      }
    } else {
      HysteresisLoop loop(values[2]);
      for (std::size_t i = 1; i < record.size(); ++i) {
        torque_nm[i] = -values[0] * loop.advance((angle_rad[i] - angle_rad[i - 1]) / values[1]);
      }
    }
  }
};

class QuadraticDamping final : public Hypothesis {
 public:
  QuadraticDamping()
      : Hypothesis(effect::quadratic_damping,
                   {.momentary = true, .linear = {.scale = 0}, .starts = {.values = {{1.0}}, .scaled = 0, .keep = 1}}) {
  }
  [[nodiscard]] WheelArm felt_by_noise(const double* values, const MeasuredMotion& motion) const override {
    double sum = 0;
    for (const double rate : motion.rate_rad_s) sum += std::abs(rate);
    return {0, 2 * values[0] * sum / static_cast<double>(motion.rate_rad_s.size()), 0};
  }
};

}  // namespace

void add_friction_hypotheses(Hypotheses& all) { add<Coulomb, Stribeck, Asymmetric, Hysteresis, QuadraticDamping>(all); }

}  // namespace steerid::gap
