// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Linear effects: the response of the recorded angle to torque is another one than the wheel's.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "gap/hypotheses/hypotheses.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

class Delay final : public Hypothesis {
 public:
  Delay()
      : Hypothesis(effect::delay,
                   {.family = Family::kLateness, .acts = false, .starts = {.values = {{0.0}, {0.05}, {-0.05}}}}) {}
  [[nodiscard]] double delay_s(const double* values) const override { return values[0]; }
  [[nodiscard]] std::optional<std::vector<double>> in_place_of(const Effect& relative) const override {
    return std::vector{relative.values[0]};  // as late
  }
};

class Lag final : public Hypothesis {
 public:
  Lag()
      : Hypothesis(
            effect::lag,
            {.family = Family::kLateness, .acts = false, .on_channel = true, .starts = {.values = {{0.01}, {0.06}}}}) {}
  [[nodiscard]] std::optional<std::vector<double>> in_place_of(const Effect& relative) const override {
    return std::vector{relative.values[0]};  // as late
  }
  [[nodiscard]] Complex response(const WheelArm& wheel, const double* values, double w) const override {
    return wheel_response(wheel, w) / Complex(1, w * values[0]);
  }
};

/// One lag, and a muscle of zeta 0.9.
Hypothesis::Starts reflex_starts() {
  Hypothesis::Starts starts{.scaled = 0, .keep = 3};
  for (const double delay_s : {0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09}) {
    for (const double time_constant_s : {0.01, 0.02, 0.03, 0.05}) {
      starts.values.push_back({1.0, delay_s, time_constant_s, 0.0});
    }
    for (const double time_constant_s : {0.05, 0.09}) {
      starts.values.push_back({1.0, delay_s, time_constant_s, 0.3});
    }
  }
  return starts;
}

class Reflex final : public Hypothesis {
 public:
  Reflex() : Hypothesis(effect::reflex, {.acts = false, .tried_as_torque = true, .starts = reflex_starts()}) {}
  [[nodiscard]] Complex response(const WheelArm& wheel, const double* values, double w) const override {
    const Complex late = values[0] * std::polar(1.0, -w * values[1]) / low_pass(values, w);
    return 1.0 / (1.0 / wheel_response(wheel, w) + late);
  }
  [[nodiscard]] Complex ends(const WheelArm& wheel, const double* values, double w) const override {
    return response(wheel, values, w) / low_pass(values, w);
  }
  void torque(const WheelArm&, const double* values, const Record& record, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const override {
    const double step_s = record.size() > 1 ? motion.time_s[1] - motion.time_s[0] : 1;
    const auto late = static_cast<std::size_t>(std::lround(values[1] / step_s));
    // The low pass by Tustin's rule, s = 2/h (z - 1)/(z + 1).
    const double first = 2 * values[2] / step_s;
    const double second = values[3] * first * first;
    const double begin = motion.angle_rad[0];
    std::array<double, 3> in = {begin, begin, begin};
    std::array<double, 3> out = in;
    for (std::size_t i = 0; i < record.size(); ++i) {
      in = {motion.angle_rad[i > late ? i - late : 0], in[0], in[1]};
      const double now = in[0] + 2 * in[1] + in[2] - (2 - 2 * second) * out[0] - (1 - first + second) * out[1];
      out = {now / (1 + first + second), out[0], out[1]};
      torque_nm[i] = -values[0] * out[0];
    }
  }

 private:
  /// 1 + i w T - q (w T)^2.
  static Complex low_pass(const double* values, double w) {
    const double wt = w * values[2];
    return {1 - values[3] * wt * wt, wt};
  }
};

class Compliance final : public Hypothesis {
 public:
  Compliance() : Hypothesis(effect::compliance, {.acts = false}) {}
  /// One that leaves the wheel no inertia only filters the torque, and stands in for a lag.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual&) const override {
    return keeps_inertia(values[2], type().parameters[2]);
  }
  [[nodiscard]] Complex response(const WheelArm& wheel, const double* values, double w) const override {
    const double wheel_inertia = values[2] * wheel.inertia_kgm2;
    const double wheel_damping = values[3] * wheel.damping_nms_per_rad;
    const Complex grip(values[0], w * values[1]);
    const Complex arm(wheel.stiffness_nm_per_rad - (wheel.inertia_kgm2 - wheel_inertia) * w * w,
                      w * (wheel.damping_nms_per_rad - wheel_damping));
    // Grip and arm in series, the wheel beside them.
    return 1.0 / (Complex(-wheel_inertia * w * w, w * wheel_damping) + grip * arm / (grip + arm));
  }
  [[nodiscard]] Complex ends(const WheelArm& wheel, const double* values, double w) const override {
    const Complex grip(values[0], w * values[1]);
    const Complex arm(wheel.stiffness_nm_per_rad - (1 - values[2]) * wheel.inertia_kgm2 * w * w,
                      (1 - values[3]) * wheel.damping_nms_per_rad * w);
    return response(wheel, values, w) * wheel.stiffness_nm_per_rad / (grip + arm);
  }
  [[nodiscard]] Starts starts(const WheelArm& wheel, const Record&, const MeasuredMotion&) const override {
    Starts starts;
    for (const double ratio : {1.0, 2.0, 4.0, 8.0, 16.0}) {
      starts.values.push_back(
          {std::max(type().parameters[0].low, ratio * wheel.stiffness_nm_per_rad), 0.4, 0.28, 0.06});
    }
    return starts;
  }
};

}  // namespace

void add_response_hypotheses(Hypotheses& all) { add<Delay, Lag, Reflex, Compliance>(all); }

}  // namespace steerid::gap
