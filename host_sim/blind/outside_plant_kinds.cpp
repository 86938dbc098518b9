// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Effects that are none of the vocabulary, in wheel and arm: what a diagnosis should call `unknown`.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "blind/dry_friction.hpp"
#include "blind/kind.hpp"

namespace steerid::blind {
namespace {

constexpr double kPi = std::numbers::pi;

/// K D^a th, 0 < a < 1, by relaxing branches: t^-a is the integral of s^a e^(-s t) over ln s, over Gamma(a). What
/// relaxes faster than the fastest branch is left as plain damping.
class FractionalDamping final : public Element {
 public:
  FractionalDamping(const Numbers& n, const Setting&) {
    const double order = n["order"];
    const double whole = n["coefficient_nms_a_per_rad"] / (std::tgamma(order) * std::tgamma(1 - order));
    const double spread = std::log(kFastest / kSlowest) / (kBranches - 1);
    for (int i = 0; i < kBranches; ++i) {
      rate_[i] = kSlowest * std::exp(spread * i);
      stiffness_[i] = whole * spread * std::pow(rate_[i], order);
    }
    rest_ = whole * std::pow(kFastest * std::exp(spread / 2), order - 1) / (1 - order);
  }
  [[nodiscard]] std::size_t states() const override { return kBranches; }
  void act(const Instant& now, std::span<const double> own, std::span<double> slope, Balance& balance) const override {
    balance.torque_nm -= rest_ * now.rate_rad_s;
    for (std::size_t i = 0; i < kBranches; ++i) {
      const double stretch = now.angle_rad - own[i];
      slope[i] = rate_[i] * stretch;
      balance.torque_nm -= stiffness_[i] * stretch;
    }
  }

 private:
  static constexpr int kBranches = 20;
  static constexpr double kSlowest = 1e-4;
  static constexpr double kFastest = 400;
  std::array<double, kBranches> rate_{};
  std::array<double, kBranches> stiffness_{};
  double rest_ = 0;
};

/// B (1 + k (th/scale)^2)
class PositionDependentDamping final : public Element {
 public:
  PositionDependentDamping(const Numbers& n, const Setting&) : added_(n["added_share"]), scale_(n["scale_rad"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    const double turned = now.angle_rad / scale_;
    balance.damping_nms_per_rad *= 1 + added_ * turned * turned;
  }

 private:
  double added_, scale_;
};

/// Another stiffness to the left than to the right.
class OneSidedStiffness final : public Element {
 public:
  OneSidedStiffness(const Numbers& n, const Setting&) : added_(n["added_share"]) {}
  void act(const Instant&, std::span<const double>, std::span<double>, Balance& balance) const override {
    if (side_ > 0) balance.stiffness_nm_per_rad *= 1 + added_;
  }
  [[nodiscard]] double guard(const Instant& now, std::span<const double>) const override {
    return side_ * now.angle_rad;
  }
  void cross(const Instant&, std::span<double>) override { side_ = -side_; }

 private:
  double added_;
  int side_ = 1;
};

/// A spring that is met beyond an angle, on one side.
class EndStop final : public Element {
 public:
  EndStop(const Numbers& n, const Setting&) : at_(n["stop_rad"]), stiffness_(n["stop_stiffness_nm_per_rad"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    if (touches_) balance.torque_nm -= stiffness_ * (now.angle_rad - at_);
  }
  [[nodiscard]] double guard(const Instant& now, std::span<const double>) const override {
    const double beyond = at_ > 0 ? now.angle_rad - at_ : at_ - now.angle_rad;
    return touches_ ? beyond : -beyond;
  }
  void cross(const Instant&, std::span<double>) override { touches_ = !touches_; }

 private:
  double at_, stiffness_;
  bool touches_ = false;
};

/// Short unmeasured half-sine torques at random times.
class RandomJerks final : public Element {
 public:
  RandomJerks(const Numbers& n, const Setting& s) : peak_nm_(n["peak_nm"]), width_s_(n["width_s"]) {
    Draw draw(s.seed, 720);
    for (double t = -10; t < s.duration_s;) {
      t += width_s_ - std::log1p(-draw.share()) / n["rate_per_s"];
      begins_s_.push_back(t);
      share_.push_back(draw.normal());
    }
  }
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    const auto after = std::upper_bound(begins_s_.begin(), begins_s_.end(), now.time_s);
    if (after == begins_s_.begin()) return;
    const auto k = static_cast<std::size_t>(after - begins_s_.begin()) - 1;
    const double u = (now.time_s - begins_s_[k]) / width_s_;
    if (u < 1) balance.torque_nm += peak_nm_ * share_[k] * std::sin(kPi * u);
  }
  [[nodiscard]] double next_time_s(double time_s) const override {
    for (const double t : begins_s_) {
      if (t > time_s) return t;
      if (t + width_s_ > time_s) return t + width_s_;
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  double peak_nm_, width_s_;
  std::vector<double> begins_s_;
  std::vector<double> share_;
};

/// B or J becomes another one at a time.
class StepInTime : public Element {
 public:
  StepInTime(const Numbers& n, double Balance::*what) : what_(what), ratio_(n["ratio"]), time_s_(n["time_s"]) {}
  void act(const Instant&, std::span<const double>, std::span<double>, Balance& balance) const override {
    if (begun_) balance.*what_ *= ratio_;
  }
  [[nodiscard]] double next_time_s(double time_s) const override {
    return time_s < time_s_ ? time_s_ : std::numeric_limits<double>::infinity();
  }
  void at_time(double time_s) override { begun_ = begun_ || time_s >= time_s_; }

 private:
  double Balance::*what_;
  double ratio_, time_s_;
  bool begun_ = false;
};
class DampingStep final : public StepInTime {
 public:
  DampingStep(const Numbers& n, const Setting&) : StepInTime(n, &Balance::damping_nms_per_rad) {}
};
class InertiaStep final : public StepInTime {
 public:
  InertiaStep(const Numbers& n, const Setting&) : StepInTime(n, &Balance::inertia_kgm2) {}
};

/// Dry friction that fades as it warms.
class FadingFriction final : public DryFriction {
 public:
  FadingFriction(const Numbers& n, const Setting&)
      : DryFriction({.forward_nm = n["friction_nm"],
                     .backward_nm = n["friction_nm"],
                     .lasting_share = n["lasting_share"],
                     .fading_s = n["fading_s"]}) {}
};

constexpr std::array kFractional = {Size{"coefficient_nms_a_per_rad", 0.05, 60.0}};
constexpr std::array kAddedShare = {Size{"added_share", 0.02, 4.0}};
constexpr std::array kOneSided = {Size{"added_share", 0.01, 0.8}};
constexpr std::array kStop = {Size{"stop_stiffness_nm_per_rad", 0.5, 400.0}};
constexpr std::array kPeak = {Size{"peak_nm", 0.05, 6.0}};
constexpr std::array kRatio = {Size{"ratio", 0.03, 2.0, 1.0}};
constexpr std::array kFriction = {Size{"friction_nm", 0.02, 2.5}};

Numbers step_numbers(Draw& d, const Setting& s) {
  const double ratio = d.chance(0.5) ? d.between(1.3, 2.0) : d.between(0.5, 0.75);
  return {{"ratio", ratio}, {"time_s", d.between(0.3, 0.7) * s.duration_s}};
}

const std::array kKinds = {
    Kind{"fractional_damping", kFractional,
         [](Draw& d, const Setting& s) {
           const double order = d.between(0.35, 0.65);
           return Numbers{
               {"coefficient_nms_a_per_rad", d.between(0.3, 1.2) * std::pow(s.arm.stiffness_nm_per_rad, 1 - order) *
                                                 std::pow(s.arm.damping_nms_per_rad, order)},
               {"order", order}};
         },
         make_element<FractionalDamping>},
    Kind{"position_dependent_damping", kAddedShare,
         [](Draw& d, const Setting& s) {
           return Numbers{{"added_share", d.between(0.3, 1.2)}, {"scale_rad", s.angle_rms_rad}};
         },
         make_element<PositionDependentDamping>},
    Kind{"one_sided_stiffness", kOneSided,
         [](Draw& d, const Setting&) {
           return Numbers{{"added_share", d.between(0.1, 0.5)}};
         },
         make_element<OneSidedStiffness>},
    Kind{"end_stop", kStop,
         [](Draw& d, const Setting& s) {
           return Numbers{{"stop_rad", d.sign() * d.between(0.5, 0.75) * s.angle_peak_rad},
                          {"stop_stiffness_nm_per_rad", d.between(1, 5) * s.arm.stiffness_nm_per_rad}};
         },
         make_element<EndStop>},
    Kind{"random_jerks", kPeak,
         [](Draw& d, const Setting& s) {
           return Numbers{{"peak_nm", d.between(0.2, 0.7) * s.torque_rms_nm},
                          {"width_s", d.between(0.08, 0.3)},
                          {"rate_per_s", d.between(0.15, 0.5)}};
         },
         make_element<RandomJerks>},
    Kind{"damping_step", kRatio, step_numbers, make_element<DampingStep>},
    Kind{"inertia_step", kRatio, step_numbers, make_element<InertiaStep>},
    Kind{"fading_friction", kFriction,
         [](Draw& d, const Setting& s) {
           return Numbers{{"friction_nm", d.between(0.15, 0.4) * s.torque_rms_nm},
                          {"lasting_share", d.between(0.05, 0.35)},
                          {"fading_s", d.between(0.15, 0.4) * s.duration_s}};
         },
         make_element<FadingFriction>},
};

}  // namespace

std::span<const Kind> outside_plant_kinds() { return kKinds; }

}  // namespace steerid::blind
