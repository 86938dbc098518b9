// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Torques that depend on the angle.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/hypotheses/hypotheses.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

double largest(const std::vector<double>& x) {
  double most = 0;
  for (const double value : x) most = std::max(most, std::abs(value));
  return most;
}

class Backlash final : public Hypothesis {
 public:
  /// An arm that nothing touches remembers, but not for long.
  Backlash()
      : Hypothesis(effect::backlash,
                   {.momentary = true, .knows = {.inertia = true, .damping = true, .stiffness = true}, .sizes = 1}) {}
  /// Of a gap whose ends the wheel never reaches nothing is seen but another J, B and C.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    return values[0] > 0 && 2 * values[0] < usual.swing_rad;
  }
  [[nodiscard]] Starts starts(const WheelArm&, const Record&, const MeasuredMotion& motion) const override {
    Starts starts{.keep = 3};
    const double reach = largest(motion.angle_rad);
    for (const double part : {0.003, 0.01, 0.02, 0.04, 0.08, 0.15, 0.3, 0.5}) {
      starts.values.push_back({part * reach, 0.05, 0.5, 0});                                          // a dead zone
      for (const double share : {0.3, 0.9}) starts.values.push_back({part * reach, 0.05, share, 1});  // a contact
    }
    return starts;
  }
};

class CubicStiffness final : public Hypothesis {
 public:
  CubicStiffness()
      : Hypothesis(effect::cubic_stiffness,
                   {.momentary = true, .linear = {.scale = 0}, .starts = {.values = {{1.0}}, .scaled = 0, .keep = 1}}) {
  }
  [[nodiscard]] WheelArm felt_by_noise(const double* values, const MeasuredMotion& motion) const override {
    double sum = 0;
    for (const double angle : motion.angle_rad) sum += angle * angle;
    return {0, 0, 3 * values[0] * sum / static_cast<double>(motion.angle_rad.size())};
  }
};

class Ripple final : public Hypothesis {
 public:
  Ripple() : Hypothesis(effect::torque_ripple, {.momentary = true, .linear = {.scale = 0, .phase = 2}}) {}
  /// One of which the wheel never sees a whole cycle is a bent spring, and one as fine as the steps of a rounded angle
  /// is the rounding, which is just such a saw-tooth.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    const double cycle_rad = 2 * std::numbers::pi / values[1];
    return usual.swing_rad > cycle_rad && cycle_rad > 2 * usual.step_rad;
  }
  /// Half a cycle over the whole range of angles is one step: no peak lies between two of them.
  [[nodiscard]] Starts starts(const WheelArm&, const Record&, const MeasuredMotion& motion) const override {
    Starts starts{.scaled = 0, .keep = 3};
    const double step = std::clamp(0.4 * 3.14 / largest(motion.angle_rad), 0.5, 20.0);
    for (double n = 1.5; n < 70 && starts.values.size() < 150; n += std::max(step, 0.015 * n)) {
      starts.values.push_back({1.0, n, 0.0});
    }
    return starts;
  }
};

class Gravity final : public Hypothesis {
 public:
  Gravity()
      : Hypothesis(effect::gravity_imbalance, {.momentary = true,
                                               .linear = {.scale = 0, .phase = 1},
                                               .starts = {.values = {{1.0, 0.0}}, .scaled = 0, .keep = 1}}) {}
};

}  // namespace

void add_spring_hypotheses(Hypotheses& all) { add<Backlash, CubicStiffness, Ripple, Gravity>(all); }

}  // namespace steerid::gap
