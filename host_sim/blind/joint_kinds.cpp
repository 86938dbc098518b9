// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How the arm joins the wheel: backlash, compliance, a hand that leaves, a reflex, a stiffness that changes.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>

#include "blind/kind.hpp"

namespace steerid::blind {
namespace {

/// Stiffness and the arm's damping outside a gap only.
class Backlash final : public Element {
 public:
  Backlash(const Numbers& n, const Setting&) : half_gap_(n["half_gap_rad"]), wheel_share_(n["wheel_damping_share"]) {}
  void act(const Instant&, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.spring_angle_rad -= side_ * half_gap_;
    if (side_ != 0) return;
    balance.stiffness_nm_per_rad = 0;
    balance.damping_nms_per_rad *= wheel_share_;
  }
  [[nodiscard]] double guard(const Instant& now, std::span<const double>) const override {
    return side_ == 0 ? half_gap_ - std::abs(now.angle_rad) : side_ * now.angle_rad - half_gap_;
  }
  void cross(const Instant& now, std::span<double>) override { side_ = side_ != 0 ? 0 : now.angle_rad > 0 ? 1 : -1; }

 private:
  double half_gap_;
  double wheel_share_;
  int side_ = 0;  // 0 in the gap
};

/// Wheel and arm as two masses; the arm's angle and rate are the element's states.
class Compliance final : public Element {
 public:
  Compliance(const Numbers& n, const Setting& s)
      : k_(n["grip_stiffness_nm_per_rad"]),
        b_(n["grip_damping_nms_per_rad"]),
        wheel_inertia_(n["wheel_inertia_share"] * s.arm.inertia_kgm2),
        wheel_damping_(n["wheel_damping_share"] * s.arm.damping_nms_per_rad),
        arm_inertia_(s.arm.inertia_kgm2 - wheel_inertia_),
        arm_damping_(s.arm.damping_nms_per_rad - wheel_damping_),
        stiffness_(s.arm.stiffness_nm_per_rad) {}
  [[nodiscard]] std::size_t states() const override { return 2; }
  void act(const Instant& now, std::span<const double> own, std::span<double> slope, Balance& balance) const override {
    const double grip_nm = k_ * (now.angle_rad - own[0]) + b_ * (now.rate_rad_s - own[1]);
    slope[0] = own[1];
    slope[1] = (grip_nm - arm_damping_ * own[1] - stiffness_ * own[0]) / arm_inertia_;
    balance.inertia_kgm2 = wheel_inertia_;
    balance.damping_nms_per_rad = wheel_damping_;
    balance.stiffness_nm_per_rad = 0;
    balance.torque_nm -= grip_nm;
  }

 private:
  double k_, b_, wheel_inertia_, wheel_damping_, arm_inertia_, arm_damping_, stiffness_;
};

/// The hand is away now and then: no stiffness, damping, inertia or torque of its own; the torque sensor sees that. It
/// follows what it wants to do as a lag of fade_s, which is the element's state; without one at once.
class HandsOff final : public Element {
 public:
  HandsOff(const Numbers& n, const Setting&)
      : period_(n["period_s"]),
        away_(n["away_s"]),
        first_(n["first_s"]),
        fade_(n["fade_s"]),
        inertia_share_(n["wheel_inertia_share"]),
        damping_share_(n["wheel_damping_share"]) {}
  [[nodiscard]] std::size_t states() const override { return 1; }
  void act(const Instant&, std::span<const double> own, std::span<double> slope, Balance& balance) const override {
    slope[0] = fade_ > 0 ? ((on_ ? 0 : 1) - own[0]) / fade_ : 0;
    const double held = this->held(own);
    balance.inertia_kgm2 *= inertia_share_ + held * (1 - inertia_share_);
    balance.damping_nms_per_rad *= damping_share_ + held * (1 - damping_share_);
    balance.stiffness_nm_per_rad *= held;
    balance.driver_nm *= held;
  }
  void show(const Instant&, std::span<const double> own, std::span<double>, Shown& shown) const override {
    shown.driver_nm *= held(own);
  }
  [[nodiscard]] double next_time_s(double time_s) const override {
    const double leave = first_ + period_ * std::ceil((time_s - first_) / period_);
    const double back = leave - period_ + away_;
    double next = leave + away_;
    for (const double edge : {back, leave}) {
      if (edge > time_s) next = std::min(next, edge);
    }
    return next;
  }
  void at_time(double time_s) override {
    const double turns = (time_s - first_) / period_;
    const double since = (turns - std::floor(turns)) * period_;
    // Rounding may put an edge just before itself.
    on_ = since > away_ - 1e-9 && since < period_ - 1e-9;
  }

 private:
  [[nodiscard]] double held(std::span<const double> own) const { return fade_ > 0 ? 1 - own[0] : on_ ? 1 : 0; }
  double period_, away_, first_, fade_, inertia_share_, damping_share_;
  bool on_ = true;
};

/// K y, T y' + y = th(t - d), the past joined by quintics on angle, rate and acceleration.
class Reflex final : public Element {
 public:
  Reflex(const Numbers& n, const Setting&)
      : stiffness_(n["reflex_stiffness_nm_per_rad"]), delay_(n["delay_s"]), time_constant_(n["time_constant_s"]) {}
  [[nodiscard]] std::size_t states() const override { return 1; }
  void act(const Instant& now, std::span<const double> own, std::span<double> slope, Balance& balance) const override {
    slope[0] = (past(now.time_s - delay_) - own[0]) / time_constant_;
    balance.torque_nm -= stiffness_ * own[0];
  }
  void passed(const Instant& now, double acceleration) override {
    if (!past_.empty() && now.time_s - past_.back().time <= 0) past_.pop_back();
    past_.push_back({now.time_s, now.angle_rad, now.rate_rad_s, acceleration});
    while (past_.size() > 2 && past_[1].time < now.time_s - delay_ - 0.02) past_.pop_front();
  }

 private:
  struct Node {
    double time, angle, rate, acceleration;
  };
  [[nodiscard]] double past(double time) const {
    if (past_.empty() || time <= past_.front().time) return past_.empty() ? 0 : past_.front().angle;
    auto right =
        std::lower_bound(past_.begin(), past_.end(), time, [](const Node& node, double t) { return node.time < t; });
    if (right == past_.end()) return past_.back().angle;
    const Node& b = *right;
    const Node& a = *(right - 1);
    const double h = b.time - a.time;
    const double u = (time - a.time) / h;
    const double v0 = a.rate * h, v1 = b.rate * h, a0 = a.acceleration * h * h, a1 = b.acceleration * h * h;
    const double rise = b.angle - a.angle;
    const double c3 = 10 * rise - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
    const double c4 = -15 * rise + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
    const double c5 = 6 * rise - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
    return a.angle + u * (v0 + u * (a0 / 2 + u * (c3 + u * (c4 + u * c5))));
  }

  double stiffness_, delay_, time_constant_;
  std::deque<Node> past_;
};

/// Shapes 0 step, 1 ramp, 2 swing, as the vocabulary's parameters have it.
class TimeVaryingStiffness final : public Element {
 public:
  TimeVaryingStiffness(const Numbers& n, const Setting&)
      : shape_(static_cast<int>(n["shape"])),
        rise_(n["stiffness_ratio"] - 1),
        time_(n["time_s"]),
        length_(n["length_s"]),
        exponent_(n["damping_exponent"]) {}
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    const double ratio = 1 + rise_ * share(now.time_s);
    balance.stiffness_nm_per_rad *= ratio;
    balance.damping_nms_per_rad *= std::exp(exponent_ * std::log(ratio));
  }
  [[nodiscard]] double next_time_s(double time_s) const override {
    if (shape_ == 2) return std::numeric_limits<double>::infinity();
    if (time_s < time_) return time_;
    return shape_ == 1 && time_s < time_ + length_ ? time_ + length_ : std::numeric_limits<double>::infinity();
  }
  void at_time(double time_s) override { begun_ = begun_ || time_s >= time_; }

 private:
  [[nodiscard]] double share(double time_s) const {
    if (shape_ == 2) return std::sin(2 * std::numbers::pi * (time_s - time_) / length_);
    if (!begun_) return 0;
    return shape_ == 0 ? 1 : std::clamp((time_s - time_) / length_, 0.0, 1.0);
  }
  int shape_;
  double rise_, time_, length_, exponent_;
  bool begun_ = false;
};

constexpr std::array kGap = {Size{"half_gap_rad", 3e-4, 0.2}};
constexpr std::array kGrip = {Size{"grip_stiffness_nm_per_rad", 150.0, 4000.0, 0.0, true}};
constexpr std::array kAway = {Size{"away_s", 0.25, 1.5}};
constexpr std::array kReflex = {Size{"reflex_stiffness_nm_per_rad", 0.2, 15.0}};
constexpr std::array kRatio = {Size{"stiffness_ratio", 0.01, 0.8, 1.0}};

const std::array kKinds = {
    Kind{"backlash", kGap,
         [](Draw& d, const Setting& s) {
           return Numbers{{"half_gap_rad", d.between(0.05, 0.3) * s.angle_rms_rad},
                          {"wheel_damping_share", s.wheel_damping_share}};
         },
         make_element<Backlash>},
    Kind{"compliance", kGrip,
         [](Draw& d, const Setting& s) {
           return Numbers{{"grip_stiffness_nm_per_rad", d.between(4, 12) * s.arm.stiffness_nm_per_rad},
                          {"grip_damping_nms_per_rad", d.between(0.1, 0.6)},
                          {"wheel_inertia_share", s.wheel_inertia_share},
                          {"wheel_damping_share", s.wheel_damping_share}};
         },
         make_element<Compliance>},
    Kind{"reflex", kReflex,
         [](Draw& d, const Setting& s) {
           return Numbers{{"reflex_stiffness_nm_per_rad", d.between(0.08, 0.25) * s.arm.stiffness_nm_per_rad},
                          {"delay_s", d.between(0.04, 0.07)},
                          {"time_constant_s", d.between(0.02, 0.05)}};
         },
         make_element<Reflex>},
    Kind{"time_varying_stiffness", kRatio,
         [](Draw& d, const Setting& s) {
           const int shape = d.whole(0, 2);
           const double rise = d.between(0.1, 0.4) * d.sign();
           return Numbers{{"shape", static_cast<double>(shape)},
                          {"stiffness_ratio", 1 + rise},
                          {"time_s", d.between(0.25, 0.7) * s.duration_s},
                          {"length_s", shape == 2 ? d.between(8, 30) : d.between(0.1, 0.3) * s.duration_s},
                          {"damping_exponent", d.between(0, 1)}};
         },
         make_element<TimeVaryingStiffness>},
    Kind{"hands_off", kAway,
         [](Draw& d, const Setting& s) {
           const double period = d.between(12, 26);
           return Numbers{{"period_s", period},
                          {"away_s", d.between(0.2, 0.6)},
                          {"first_s", d.between(0.05, 0.9) * period},
                          {"fade_s", d.between(0.03, 0.12)},
                          {"wheel_inertia_share", s.wheel_inertia_share},
                          {"wheel_damping_share", s.wheel_damping_share}};
         },
         make_element<HandsOff>},
};

}  // namespace

std::span<const Kind> joint_kinds() { return kKinds; }

}  // namespace steerid::blind
