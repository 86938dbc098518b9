// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Between what happened and what was written down: effects of the vocabulary on sensors and recorder.
#include <algorithm>
#include <array>
#include <cmath>

#include "blind/kind.hpp"

namespace steerid::blind {
namespace {

class Delay final : public Element {
 public:
  Delay(const Numbers& n, const Setting&) : delay_s_(n["delay_s"]) {}
  [[nodiscard]] double late_s(double) const override { return delay_s_; }

 private:
  double delay_s_;
};

class Lag final : public Element {
 public:
  Lag(const Numbers& n, const Setting&) : time_constant_s_(n["time_constant_s"]) {}
  [[nodiscard]] std::size_t states() const override { return 1; }
  void show(const Instant&, std::span<const double> own, std::span<double> slope, Shown& shown) const override {
    slope[0] = (shown.angle_rad - own[0]) / time_constant_s_;
    shown.angle_rad = own[0];
  }

 private:
  double time_constant_s_;
};

class Bias final : public Element {
 public:
  Bias(const Numbers& n, const Setting&) : bias_nm_(n["bias_nm"]) {}
  void show(const Instant&, std::span<const double>, std::span<double>, Shown& shown) const override {
    shown.driver_nm += bias_nm_;
  }

 private:
  double bias_nm_;
};

class Drift final : public Element {
 public:
  Drift(const Numbers& n, const Setting&) : drift_nm_(n["drift_nm"]), time_constant_s_(n["time_constant_s"]) {}
  void show(const Instant& now, std::span<const double>, std::span<double>, Shown& shown) const override {
    if (now.time_s > 0) shown.driver_nm -= drift_nm_ * std::expm1(-now.time_s / time_constant_s_);
  }

 private:
  double drift_nm_, time_constant_s_;
};

class CoarseQuantization final : public Element {
 public:
  CoarseQuantization(const Numbers& n, const Setting&) : step_rad_(n["step_rad"]) {}
  void convert(Columns& columns, Draw&) const override {
    for (double& angle : columns.angle_rad) angle = step_rad_ * std::round(angle / step_rad_);
  }

 private:
  double step_rad_;
};

class Saturation final : public Element {
 public:
  Saturation(const Numbers& n, const Setting&) : limit_nm_(n["limit_nm"]) {}
  void write(Columns& columns) const override {
    for (double& torque : columns.driver_nm) torque = std::clamp(torque, -limit_nm_, limit_nm_);
    for (double& torque : columns.motor_nm) torque = std::clamp(torque, -limit_nm_, limit_nm_);
  }

 private:
  double limit_nm_;
};

class SampleLoss final : public Element {
 public:
  SampleLoss(const Numbers& n, const Setting&) : probability_(n["loss_probability"]) {}
  void convert(Columns& columns, Draw& draw) const override {
    for (std::size_t i = 1; i < columns.angle_rad.size(); ++i) {
      if (draw.chance(probability_)) columns.angle_rad[i] = columns.angle_rad[i - 1];
    }
  }

 private:
  double probability_;
};

constexpr std::array kDelay = {Size{"delay_s", 0.001, 0.07}};
constexpr std::array kLag = {Size{"time_constant_s", 0.001, 0.06}};
constexpr std::array kBias = {Size{"bias_nm", 0.01, 5.0}};
constexpr std::array kDrift = {Size{"drift_nm", 0.02, 8.0}};
constexpr std::array kStep = {Size{"step_rad", 0.004, 0.4}};
constexpr std::array kLimit = {Size{"limit_nm", 0.5, 30.0, 0.0, true}};
constexpr std::array kLoss = {Size{"loss_probability", 0.02, 0.3}};

const std::array kKinds = {
    Kind{"delay", kDelay,
         [](Draw& d, const Setting&) {
           return Numbers{{"delay_s", d.sign() * d.between(0.004, 0.03)}};
         },
         make_element<Delay>},
    Kind{"lag", kLag,
         [](Draw& d, const Setting&) {
           return Numbers{{"time_constant_s", d.between(0.005, 0.03)}};
         },
         make_element<Lag>},
    Kind{"torque_bias", kBias,
         [](Draw& d, const Setting& s) {
           return Numbers{{"bias_nm", d.sign() * d.between(0.03, 0.2) * s.torque_rms_nm}};
         },
         make_element<Bias>},
    Kind{"torque_drift", kDrift,
         [](Draw& d, const Setting& s) {
           return Numbers{{"drift_nm", d.sign() * d.between(0.1, 0.5) * s.torque_rms_nm},
                          {"time_constant_s", d.between(0.2, 0.6) * s.duration_s}};
         },
         make_element<Drift>},
    Kind{"coarse_quantization", kStep,
         [](Draw& d, const Setting& s) {
           return Numbers{{"step_rad", d.between(0.1, 0.5) * s.angle_rms_rad}};
         },
         make_element<CoarseQuantization>},
    Kind{"torque_saturation", kLimit,
         [](Draw& d, const Setting& s) {
           return Numbers{{"limit_nm", d.between(0.55, 0.85) * s.torque_peak_nm}};
         },
         make_element<Saturation>},
    Kind{"sample_loss", kLoss,
         [](Draw& d, const Setting&) {
           return Numbers{{"loss_probability", d.between(0.05, 0.2)}};
         },
         make_element<SampleLoss>},
};

}  // namespace

std::span<const Kind> record_kinds() { return kKinds; }

}  // namespace steerid::blind
