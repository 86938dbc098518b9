// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Torques that the model does not have: of the angle, of the rate, of time.
#include <array>
#include <cmath>
#include <numbers>

#include "blind/kind.hpp"
#include "blind/slow_torque.hpp"

namespace steerid::blind {
namespace {

class Cubic final : public Element {
 public:
  Cubic(const Numbers& n, const Setting&) : c3_(n["cubic_stiffness_nm_per_rad3"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.torque_nm -= c3_ * now.angle_rad * now.angle_rad * now.angle_rad;
  }

 private:
  double c3_;
};

class QuadraticDamping final : public Element {
 public:
  QuadraticDamping(const Numbers& n, const Setting&) : b2_(n["quadratic_damping_nms2_per_rad2"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.torque_nm -= b2_ * std::abs(now.rate_rad_s) * now.rate_rad_s;
  }

 private:
  double b2_;
};

class Ripple final : public Element {
 public:
  Ripple(const Numbers& n, const Setting&)
      : ripple_nm_(n["ripple_nm"]), cycles_(n["cycles_per_turn"]), phase_(n["phase_rad"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.torque_nm -= ripple_nm_ * std::sin(cycles_ * now.angle_rad + phase_);
  }

 private:
  double ripple_nm_, cycles_, phase_;
};

class Gravity final : public Element {
 public:
  Gravity(const Numbers& n, const Setting&) : weight_nm_(n["weight_torque_nm"]), phase_(n["phase_rad"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.torque_nm -= weight_nm_ * std::sin(now.angle_rad + phase_);
  }

 private:
  double weight_nm_, phase_;
};

class Periodic final : public Element {
 public:
  Periodic(const Numbers& n, const Setting&)
      : amplitude_nm_(n["amplitude_nm"]), w_(2 * std::numbers::pi * n["frequency_hz"]), phase_(n["phase_rad"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.torque_nm += amplitude_nm_ * std::sin(w_ * now.time_s + phase_);
  }

 private:
  double amplitude_nm_, w_, phase_;
};

class Unmeasured final : public Element {
 public:
  Unmeasured(const Numbers& n, const Setting& s) : torque_(slow_torque(n["rms_nm"], -20, s.duration_s + 1, s.seed)) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.torque_nm += torque_.at(now.time_s);
  }

 private:
  Signal torque_;
};

constexpr std::array kCubic = {Size{"cubic_stiffness_nm_per_rad3", 1e-3, 5000.0}};
constexpr std::array kQuadratic = {Size{"quadratic_damping_nms2_per_rad2", 1e-3, 6.0}};
constexpr std::array kRipple = {Size{"ripple_nm", 0.01, 2.0}};
constexpr std::array kWeight = {Size{"weight_torque_nm", 0.02, 4.0}};
constexpr std::array kAmplitude = {Size{"amplitude_nm", 0.01, 3.0}};
// From 5 % of the applied torque on it is a cause; below, it belongs to every driver.
constexpr std::array kUnmeasured = {Size{"rms_nm", 0.02, 3.0}};
constexpr double kPi = std::numbers::pi;

const std::array kKinds = {
    Kind{"cubic_stiffness", kCubic,
         [](Draw& d, const Setting& s) {
           // Softening no further than to half the stiffness at the largest angle, or the wheel would run away.
           const double share = d.chance(0.3) ? -d.between(0.05, 0.25) : d.between(0.05, 0.6);
           return Numbers{{"cubic_stiffness_nm_per_rad3",
                           share * s.arm.stiffness_nm_per_rad / (s.angle_peak_rad * s.angle_peak_rad)}};
         },
         make_element<Cubic>},
    Kind{"quadratic_damping", kQuadratic,
         [](Draw& d, const Setting& s) {
           return Numbers{{"quadratic_damping_nms2_per_rad2",
                           d.between(0.15, 0.8) * s.arm.damping_nms_per_rad / s.rate_rms_rad_s}};
         },
         make_element<QuadraticDamping>},
    Kind{"torque_ripple", kRipple,
         [](Draw& d, const Setting& s) {
           // Some one to five cycles over the swing: fewer look like a stiffness.
           const double most = 5 * kPi / s.angle_peak_rad;
           const double fewest = 1.5 * kPi / s.angle_peak_rad;
           return Numbers{{"ripple_nm", d.between(0.03, 0.15) * s.torque_rms_nm},
                          {"cycles_per_turn", std::round(d.between(fewest, std::min(most, 60.0)))},
                          {"phase_rad", d.between(-kPi, kPi)}};
         },
         make_element<Ripple>},
    Kind{"gravity_imbalance", kWeight,
         [](Draw& d, const Setting& s) {
           return Numbers{{"weight_torque_nm", d.between(0.03, 0.2) * s.torque_rms_nm},
                          {"phase_rad", d.sign() * d.between(0.3, 1.2)}};
         },
         make_element<Gravity>, true},
    Kind{"periodic_disturbance", kAmplitude,
         [](Draw& d, const Setting& s) {
           return Numbers{{"amplitude_nm", d.between(0.05, 0.3) * s.torque_rms_nm},
                          {"frequency_hz", d.log_between(1.2, 9)},
                          {"phase_rad", d.between(-kPi, kPi)}};
         },
         make_element<Periodic>},
    Kind{"unmeasured_torque", kUnmeasured,
         [](Draw& d, const Setting& s) {
           return Numbers{{"rms_nm", d.between(0.055, 0.15) * s.torque_rms_nm}};
         },
         make_element<Unmeasured>, false, true},
};

}  // namespace

std::span<const Kind> torque_kinds() { return kKinds; }

}  // namespace steerid::blind
