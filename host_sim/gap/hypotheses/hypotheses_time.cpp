// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Torques with a course in time.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/hypotheses/hypotheses.hpp"
#include "gap/hypotheses/slow_share.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// sin(rate t + phase) at every sample. A record's samples are equally spaced but for gaps: within kTurns of them the
/// angle is turned on, 1e-15 a turn, in place of a sine for every sample.
template <class Take>
void for_each_sine(double rate_rad_s, double phase_rad, const std::vector<double>& time_s, Take&& take) {
  constexpr std::size_t kTurns = 64;
  constexpr double kSameStep_s = 1e-7;
  const double step_s = time_s.size() > 1 ? time_s[1] - time_s[0] : 0;
  const Complex turn = std::polar(1.0, rate_rad_s * step_s);
  Complex now;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const bool follows = i % kTurns != 0 && std::abs(time_s[i] - time_s[i - 1] - step_s) < kSameStep_s;
    now = follows ? now * turn : std::polar(1.0, rate_rad_s * time_s[i] + phase_rad);
    take(i, now.imag());
  }
}

class Bias final : public Hypothesis {
 public:
  Bias() : Hypothesis(effect::torque_bias) {}
  [[nodiscard]] bool exact_at_once() const override { return true; }
  [[nodiscard]] Family family() const override { return Family::kOffset; }
  [[nodiscard]] bool momentary() const override { return true; }
  [[nodiscard]] Linear linear() const override { return {.scale = 0}; }
  void torque(const WheelArm&, const double* values, const Record&, const MeasuredMotion&,
              std::vector<double>& torque_nm) const override {
    std::ranges::fill(torque_nm, -values[0]);
  }
  [[nodiscard]] Starts starts(const WheelArm&, const Record&, const MeasuredMotion&) const override {
    return {.values = {{1.0}}, .scaled = 0, .keep = 1};
  }
};

class Drift final : public Hypothesis {
 public:
  Drift() : Hypothesis(effect::torque_drift) {}
  [[nodiscard]] bool exact_at_once() const override { return true; }
  [[nodiscard]] Family family() const override { return Family::kOffset; }
  [[nodiscard]] bool momentary() const override { return true; }
  [[nodiscard]] Linear linear() const override { return {.scale = 0}; }
  void torque(const WheelArm&, const double* values, const Record& record, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const override {
    for (std::size_t i = 0; i < record.size(); ++i)
      torque_nm[i] = values[0] * std::expm1(-motion.time_s[i] / values[1]);
  }
  [[nodiscard]] Starts starts(const WheelArm&, const Record&, const MeasuredMotion&) const override {
    return {.values = {{1.0, 3.0}, {1.0, 8.0}, {1.0, 20.0}, {1.0, 45.0}, {1.0, 150.0}}, .scaled = 0, .keep = 2};
  }
};

class Periodic final : public Hypothesis {
 public:
  Periodic() : Hypothesis(effect::periodic_disturbance) {}
  [[nodiscard]] bool exact_at_once() const override { return true; }
  [[nodiscard]] bool momentary() const override { return true; }
  [[nodiscard]] Linear linear() const override { return {.scale = 0, .phase = 2}; }
  /// A slow one that is no larger than every driver's own torque is no cause.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    return values[1] > kSlowToneEnd_hz || values[0] / std::numbers::sqrt2 > kSlowToneShare * usual.applied_rms_nm;
  }
  void torque(const WheelArm&, const double* values, const Record&, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const override {
    for_each_sine(2 * std::numbers::pi * values[1], values[2], motion.time_s,
                  [&](std::size_t i, double sine) { torque_nm[i] = values[0] * sine; });
  }
  [[nodiscard]] Starts starts(const WheelArm&, const Record&, const MeasuredMotion&) const override {
    return {.values = {{1.0, 1.0, 0.0}}, .scaled = 0, .by_line = true, .keep = 3};
  }
};

/// C changes with time. The change is soft over a sample, so that a fit can move its instant.
class TimeVaryingStiffness final : public Hypothesis {
 public:
  TimeVaryingStiffness() : Hypothesis(effect::time_varying_stiffness) {}
  [[nodiscard]] bool timed() const override { return true; }
  [[nodiscard]] bool momentary() const override { return true; }
  [[nodiscard]] Knows knows() const override { return {.stiffness = true}; }
  void torque(const WheelArm& wheel, const double* values, const Record& record, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const override {
    const double most = -wheel.stiffness_nm_per_rad * (values[1] - 1);
    const auto take = [&](std::size_t i, double part) { torque_nm[i] = most * part * motion.angle_rad[i]; };
    if (values[0] >= 2) {
      const double rate = 2 * std::numbers::pi / values[3];
      for_each_sine(rate, -rate * values[2], motion.time_s, take);
    } else {
      for (std::size_t i = 0; i < record.size(); ++i) take(i, ramp(values, motion.time_s[i]));
    }
  }
  [[nodiscard]] Starts starts(const WheelArm&, const Record&, const MeasuredMotion& motion) const override {
    Starts starts{.values = {}, .scaled = -2, .keep = 4};
    const double end = motion.time_s.back();
    for (int i = 1; i < 40; ++i) starts.values.push_back({0, 2.0, end * i / 40, 10});
    for (int from = 0; from < 8; ++from) {
      for (const double length : {0.12, 0.25, 0.5, 0.8}) {
        starts.values.push_back({1, 2.0, end * from / 8, end * length});
      }
    }
    // Swings in steps that keep the phase over the whole record; of either sign, so that half a period is both.
    constexpr double kSlowest_hz = 1.0 / 90;
    constexpr double kFastest_hz = 1.0 / 3;
    const double step_hz = 0.4 / std::clamp(end, 4.0, 120.0);
    for (double f = kSlowest_hz; f < kFastest_hz; f += step_hz) {
      for (const double phase : {0.0, 0.25}) starts.values.push_back({2, 2.0, phase / f, 1 / f});
    }
    return starts;
  }

  /// No slope leads from one instant of a step to another, nor from a short ramp to a step.
  [[nodiscard]] Missed missed(const std::vector<double>& found, const MeasuredMotion&) const override {
    constexpr double kLongest_s = 8;
    Missed missed;
    const auto steps = [&](double first_s, double last_s, double step_s) {
      for (double t = first_s; t < last_s; t += step_s) missed.values.push_back({0, found[1], t, found[3]});
    };
    if (found[0] < 1) {
      steps(found[2] - 0.1, found[2] + 0.1, 0.01);
    } else if (found[0] < 2 && found[3] < kLongest_s) {
      steps(found[2] - 1, found[2] + found[3] + 1, 0.1);
    }
    return missed;
  }

 private:
  static double ramp(const double* values, double t) {
    if (values[0] >= 1) return std::clamp((t - values[2]) / values[3], 0.0, 1.0);
    return std::clamp((t - values[2]) / 0.02 + 0.5, 0.0, 1.0);
  }
};

}  // namespace

void add_time_hypotheses(Hypotheses& all) {
  all.push_back(std::make_unique<Bias>());
  all.push_back(std::make_unique<Drift>());
  all.push_back(std::make_unique<Periodic>());
  all.push_back(std::make_unique<TimeVaryingStiffness>());
}

}  // namespace steerid::gap
