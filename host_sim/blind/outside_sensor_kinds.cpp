// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Effects that are none of the vocabulary, in sensors and actuators: what a diagnosis should call `unknown`.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "blind/kind.hpp"

namespace steerid::blind {
namespace {

/// Both torque sensors read less the more there is: T (1 - k |T|/scale).
class TorqueGainCurve final : public Element {
 public:
  TorqueGainCurve(const Numbers& n, const Setting&) : bend_(n["bend_share"]), scale_nm_(n["scale_nm"]) {}
  void show(const Instant&, std::span<const double>, std::span<double>, Shown& shown) const override {
    shown.driver_nm *= 1 - bend_ * std::abs(shown.driver_nm) / scale_nm_;
    shown.motor_nm *= 1 - bend_ * std::abs(shown.motor_nm) / scale_nm_;
  }

 private:
  double bend_, scale_nm_;
};

/// An eccentric encoder: th + a sin(n th + phase).
class AngleHarmonic final : public Element {
 public:
  AngleHarmonic(const Numbers& n, const Setting&)
      : amplitude_(n["amplitude_rad"]), cycles_(n["cycles_per_turn"]), phase_(n["phase_rad"]) {}
  void show(const Instant&, std::span<const double>, std::span<double>, Shown& shown) const override {
    shown.angle_rad += amplitude_ * std::sin(cycles_ * shown.angle_rad + phase_);
  }

 private:
  double amplitude_, cycles_, phase_;
};

/// The angle's gain creeps through the record.
class AngleGainDrift final : public Element {
 public:
  AngleGainDrift(const Numbers& n, const Setting& s) : drift_(n["drift_share"]), duration_s_(s.duration_s) {}
  void show(const Instant& now, std::span<const double>, std::span<double>, Shown& shown) const override {
    shown.angle_rad *= 1 + drift_ * (now.time_s / duration_s_ - 0.5);
  }

 private:
  double drift_, duration_s_;
};

/// The motor does nothing below a threshold of its target, and that much less above it; its target is what is recorded.
class TorqueDeadZone final : public Element {
 public:
  TorqueDeadZone(const Numbers& n, const Setting&) : half_nm_(n["half_width_nm"]) {}
  void act(const Instant&, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.motor_nm -= std::clamp(balance.motor_nm, -half_nm_, half_nm_);
  }

 private:
  double half_nm_;
};

/// The angle sensor hangs behind the wheel by its backlash: it stands until it is met.
class SensorBacklash final : public Element {
 public:
  SensorBacklash(const Numbers& n, const Setting&) : half_(n["half_play_rad"]) {}
  [[nodiscard]] std::size_t states() const override { return 1; }
  void show(const Instant& now, std::span<const double> own, std::span<double> slope, Shown& shown) const override {
    if (pushed_ != 0) slope[0] = now.rate_rad_s;
    shown.angle_rad = own[0];
  }
  [[nodiscard]] double guard(const Instant& now, std::span<const double> own) const override {
    return pushed_ == 0 ? half_ - std::abs(now.angle_rad - own[0]) : pushed_ * now.rate_rad_s;
  }
  void cross(const Instant& now, std::span<double> own) override {
    if (pushed_ != 0) {
      own[0] = now.angle_rad - pushed_ * half_ * (1 - 1e-9);  // rounding must not push again
      pushed_ = 0;
    } else {
      pushed_ = now.angle_rad > own[0] ? 1 : -1;
    }
  }

 private:
  double half_;
  int pushed_ = 0;  // 0 stands
};

/// The driver's torque sensor has another gain than the motor's.
class DriverGain final : public Element {
 public:
  DriverGain(const Numbers& n, const Setting&) : gain_(n["gain"]) {}
  void show(const Instant&, std::span<const double>, std::span<double>, Shown& shown) const override {
    shown.driver_nm *= gain_;
  }

 private:
  double gain_;
};

/// The angle's clock is slow: its stamps come ever later.
class ClockSkew final : public Element {
 public:
  ClockSkew(const Numbers& n, const Setting&) : skew_(n["skew"]) {}
  [[nodiscard]] double late_s(double time_s) const override { return skew_ * time_s; }

 private:
  double skew_;
};

constexpr double kPi = std::numbers::pi;
constexpr std::array kBend = {Size{"bend_share", 0.01, 0.45}};
constexpr std::array kAmplitude = {Size{"amplitude_rad", 5e-4, 0.2}};
constexpr std::array kDrift = {Size{"drift_share", 0.01, 0.5}};
constexpr std::array kHalfWidth = {Size{"half_width_nm", 0.02, 1.5}};
constexpr std::array kPlay = {Size{"half_play_rad", 1e-3, 0.2}};
constexpr std::array kGain = {Size{"gain", 0.02, 0.6, 1.0}};
constexpr std::array kSkew = {Size{"skew", 2e-5, 3e-3}};

const std::array kKinds = {
    Kind{"torque_gain_curve", kBend,
         [](Draw& d, const Setting& s) {
           return Numbers{{"bend_share", d.between(0.1, 0.35)}, {"scale_nm", s.torque_peak_nm}};
         },
         make_element<TorqueGainCurve>},
    Kind{"angle_harmonic", kAmplitude,
         [](Draw& d, const Setting& s) {
           const double least = std::max(1.0, 2 / s.angle_peak_rad);
           return Numbers{{"amplitude_rad", d.between(0.02, 0.08) * s.angle_rms_rad},
                          {"cycles_per_turn", std::round(d.between(least, 3 * least))},
                          {"phase_rad", d.between(-kPi, kPi)}};
         },
         make_element<AngleHarmonic>},
    Kind{"angle_gain_drift", kDrift,
         [](Draw& d, const Setting&) {
           return Numbers{{"drift_share", d.sign() * d.between(0.1, 0.4)}};
         },
         make_element<AngleGainDrift>},
    Kind{"torque_dead_zone", kHalfWidth,
         [](Draw& d, const Setting& s) {
           return Numbers{{"half_width_nm", d.between(0.1, 0.4) * s.torque_rms_nm}};
         },
         make_element<TorqueDeadZone>},
    Kind{"sensor_backlash", kPlay,
         [](Draw& d, const Setting& s) {
           return Numbers{{"half_play_rad", d.between(0.05, 0.2) * s.angle_rms_rad}};
         },
         make_element<SensorBacklash>},
    Kind{"driver_gain", kGain,
         [](Draw& d, const Setting&) {
           return Numbers{{"gain", 1 + d.sign() * d.between(0.1, 0.4)}};
         },
         make_element<DriverGain>, true},
    Kind{"clock_skew", kSkew,
         [](Draw& d, const Setting&) {
           return Numbers{{"skew", d.sign() * d.between(1e-4, 8e-4)}};
         },
         make_element<ClockSkew>},
};

}  // namespace

std::span<const Kind> outside_sensor_kinds() { return kKinds; }

}  // namespace steerid::blind
