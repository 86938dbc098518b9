// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Torques with a course in time.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "gap/hypotheses/hypotheses.hpp"
#include "gap/hypotheses/slow_share.hpp"
#include "plant/effects/vocabulary.hpp"
#include "plant/free_run.hpp"

namespace steerid::gap {
namespace {

class Bias final : public Hypothesis {
 public:
  Bias()
      : Hypothesis(effect::torque_bias, {.family = Family::kOffset,
                                         .knows_no_motion = true,
                                         .momentary = true,
                                         .linear = {.scale = 0},
                                         .starts = {.values = {{1.0}}, .scaled = 0, .keep = 1}}) {}
  [[nodiscard]] std::optional<std::vector<double>> in_place_of(const Effect& relative) const override {
    return std::vector{relative.values[0]};  // as far off in the end
  }
};

class Drift final : public Hypothesis {
 public:
  Drift()
      : Hypothesis(effect::torque_drift,
                   {.family = Family::kOffset,
                    .knows_no_motion = true,
                    .momentary = true,
                    .linear = {.scale = 0},
                    .starts = {.values = {{1.0, 3.0}, {1.0, 8.0}, {1.0, 20.0}, {1.0, 45.0}, {1.0, 150.0}},
                               .scaled = 0,
                               .keep = 2}}) {}
  [[nodiscard]] std::optional<std::vector<double>> in_place_of(const Effect& relative) const override {
    constexpr double kSoon_s = 8;  // so that most of a record shows what it creeps to
    return std::vector{relative.values[0], kSoon_s};
  }
};

class Periodic final : public Hypothesis {
 public:
  Periodic()
      : Hypothesis(effect::periodic_disturbance,
                   {.knows_no_motion = true,
                    .momentary = true,
                    .linear = {.scale = 0, .phase = 2},
                    .starts = {.values = {{1.0, 1.0, 0.0}}, .scaled = 0, .by_line = true, .keep = 3}}) {}
  /// A slow one that is no larger than every driver's own torque is no cause.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    return values[1] > kSlowToneEnd_hz || values[0] / std::numbers::sqrt2 > kSlowToneShare * usual.applied_rms_nm;
  }
};

/// Ramps and swings are the plant's; a step is soft.
class TimeVaryingStiffness final : public Hypothesis {
 public:
  TimeVaryingStiffness()
      : Hypothesis(effect::time_varying_stiffness,
                   {.momentary = true, .timed = true, .knows = {.damping = true, .stiffness = true}}) {}
  /// A ramp from before the record on is one from its beginning on, of another C and B; one to beyond its end is one to
  /// its end, of a smaller change.
  void restate(const Span& record, double* values, WheelArm* wheel) const override {
    if (!is_ramp(values)) return;
    const double first_s = wheel != nullptr ? std::max(values[2], record.begin_s) : values[2];
    set_between(first_s, std::min(values[2] + values[3], record.end_s), values, wheel);
  }
  bool go_on_to_end(const Span& record, double* values, WheelArm* wheel, std::size_t number) const override {
    if (!is_ramp(values) || number < 2 || number > 3 || (number == 2 && wheel == nullptr)) return false;
    if (cut_off_by(record, values, number)) return false;
    const double first_s = number == 2 ? record.begin_s : values[2];
    return set_between(first_s, number == 3 ? record.end_s : values[2] + values[3], values, wheel);
  }
  [[nodiscard]] bool cut_off_by(const Span& record, const double* values, std::size_t number) const override {
    if (!is_ramp(values)) return false;
    constexpr double kInstant_s = 1e-6;
    if (number == 2) return std::abs(values[2] - record.begin_s) < kInstant_s;
    return number == 3 && std::abs(values[2] + values[3] - record.end_s) < kInstant_s;
  }
  /// Before and after are both seen, for longer than a run's beginning is estimated from: of a change within that an
  /// initial state may make up for all. Of a ramp that has all but ended by then nothing is seen but another C and B.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    const double side_s = FreeRun::Options{}.stretch_s;
    const double change_s = is_step(values) ? 0 : values[3];
    return values[0] >= 2 ||
           (values[2] > usual.record.begin_s - side_s && values[2] + change_s > usual.record.begin_s + side_s &&
            values[2] < usual.record.end_s - side_s);
  }
  void torque(const WheelArm& wheel, const double* values, const Record& record, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const override {
    if (!is_step(values)) return Hypothesis::torque(wheel, values, record, motion, torque_nm);
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double part = std::clamp((motion.time_s[i] - values[2]) / kSoftEdge_s + 0.5, 0.0, 1.0);
      const double rise = (values[1] - 1) * part;
      torque_nm[i] = -wheel.stiffness_nm_per_rad * rise * motion.angle_rad[i] -
                     wheel.damping_nms_per_rad * (std::pow(1 + rise, values[4]) - 1) * motion.rate_rad_s[i];
    }
  }
  [[nodiscard]] Starts starts(const WheelArm&, const Record&, const MeasuredMotion& motion) const override {
    Starts starts{.scaled = kScalesRatio, .keep = 4};
    // Between a spring, whose B stays, and an arm.
    const double exponent = std::midpoint(type().parameters[4].preset, type().parameters[4].prior.mean);
    const double first_s = motion.time_s.front();
    const double length_s = motion.length_s();
    for (int i = 1; i < 40; ++i) starts.values.push_back({0, 2.0, first_s + length_s * i / 40, 10, exponent});
    for (int from = 0; from < 8; ++from) {
      for (const double share : {0.12, 0.25, 0.5, 0.8}) {
        starts.values.push_back({1, 2.0, first_s + length_s * from / 8, length_s * share, exponent});
      }
    }
    // Swings in steps that keep the phase over the whole record; of either sign, so that half a period is both.
    constexpr double kSlowest_hz = 1.0 / 90;
    constexpr double kFastest_hz = 1.0 / 3;
    const double step_hz = 0.4 / std::clamp(length_s, 4.0, 120.0);
    for (double f = kSlowest_hz; f < kFastest_hz; f += step_hz) {
      for (const double phase : {0.0, 0.25}) starts.values.push_back({2, 2.0, phase / f, 1 / f, exponent});
    }
    return starts;
  }

  /// No slope leads from a step to a ramp, and none from a short ramp back. A swing is like neither.
  [[nodiscard]] std::vector<std::vector<double>> missed(const std::vector<double>& found) const override {
    std::vector<std::vector<double>> others;
    const double middle_s = found[2] + (is_ramp(found.data()) ? found[3] / 2 : 0);
    if (is_ramp(found.data()) && found[3] < kLongest_s) others.push_back({0, found[1], middle_s, found[3], found[4]});
    for (double length_s = kLongest_s; is_step(found.data()) && length_s >= kLongest_s / 8; length_s /= 2) {
      others.push_back({1, found[1], middle_s - length_s / 2, length_s, found[4]});
    }
    return others;
  }
  /// Nor from one instant of a step to another.
  [[nodiscard]] std::vector<std::vector<double>> missed_instants(const std::vector<double>& found) const override {
    std::vector<std::vector<double>> missed;
    const auto steps = [&](double first_s, double last_s, double step_s) {
      for (double t = first_s; t < last_s; t += step_s) missed.push_back({0, found[1], t, found[3], found[4]});
    };
    if (is_step(found.data())) {
      steps(found[2] - 0.1, found[2] + 0.1, 0.01);
    } else if (is_ramp(found.data()) && found[3] < kLongest_s) {
      steps(found[2] - 1, found[2] + found[3] + 1, 0.1);
    }
    return missed;
  }

 private:
  static constexpr double kLongest_s = 8;  // of a ramp that a step is taken for

  static bool is_step(const double* values) { return values[0] < 1; }
  static bool is_ramp(const double* values) { return values[0] >= 1 && values[0] < 2; }

  /// The ramp of the same course between two instants; false where that is none. `wheel` is that before it.
  bool set_between(double first_s, double last_s, double* values, WheelArm* wheel) const {
    const auto ratio_at = [&](double t) { return 1 + (values[1] - 1) * (t - values[2]) / values[3]; };
    const double first = ratio_at(first_s);
    const double ratio = ratio_at(last_s) / first;
    const Parameter& of_ratio = type().parameters[1];
    if (!(last_s - std::max(first_s, values[2]) > type().parameters[3].low && first > 0)) return false;
    if (ratio < of_ratio.low || ratio > of_ratio.high) return false;
    if (wheel != nullptr) {
      wheel->stiffness_nm_per_rad *= first;
      wheel->damping_nms_per_rad *= std::pow(first, values[4]);
    }
    values[1] = ratio;
    values[2] = first_s;
    values[3] = last_s - first_s;
    return true;
  }
};

}  // namespace

void add_time_hypotheses(Hypotheses& all) { add<Bias, Drift, Periodic, TimeVaryingStiffness>(all); }

}  // namespace steerid::gap
