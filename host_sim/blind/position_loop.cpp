// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/position_loop.hpp"

#include <cmath>
#include <deque>
#include <numbers>
#include <vector>

#include "blind/drive.hpp"

namespace steerid::blind {
namespace {

constexpr double kTick_s = 1e-3;
constexpr std::uint64_t kAngleNoise = 930;

class HeldWheel final : public Element {
 public:
  HeldWheel(const PositionLoop& loop, const Run& run)
      : loop_(loop), from_s_(-run.lead_in_s), draw_(loop.seed, kAngleNoise), commands_(loop.late_ms, 0.0) {}

  [[nodiscard]] double next_time_s(double /*time_s*/) const override { return tick_s(); }

  void at_time(double time_s) override {
    ++tick_;
    noise_rad_ = loop_.noise_rad * draw_.normal();
    const double error = loop_.reference_rad.at(time_s) - angle_rad_ - noise_rad_;
    error_rate_ += ((error - error_) / kTick_s - error_rate_) * -std::expm1(-kTick_s / loop_.low_pass_s);
    error_ = error;
    commands_.push_back(loop_.stiffness_nm_per_rad * error + loop_.damping_nms_per_rad * error_rate_);
    push_nm_ = commands_.front();
    commands_.pop_front();
  }

  void passed(const Instant& now, double /*acceleration_rad_s2*/) override { angle_rad_ = now.angle_rad; }

  void act(const Instant&, std::span<const double>, std::span<double>, Balance& balance) const override {
    balance.motor_nm -= push_nm_;
  }
  void show(const Instant&, std::span<const double>, std::span<double>, Shown& shown) const override {
    shown.motor_nm -= push_nm_;
    shown.angle_rad += noise_rad_;
  }

 private:
  [[nodiscard]] double tick_s() const { return from_s_ + kTick_s * static_cast<double>(tick_); }

  const PositionLoop& loop_;
  double from_s_;
  Draw draw_;
  std::deque<double> commands_;
  std::size_t tick_ = 1;
  double angle_rad_ = 0;
  double noise_rad_ = 0;
  double error_ = 0;
  double error_rate_ = 0;
  double push_nm_ = 0;
};

}  // namespace

PositionLoop draw_position_loop(const Arm& arm, const Run& run, std::uint64_t seed, Draw& draw) {
  PositionLoop loop;
  const double highest_hz = draw.between(3, 6);
  const int tones = draw.whole(20, 40);
  std::vector<Tone> all;
  for (int i = 0; i < tones; ++i) {
    const double f = 0.05 + (highest_hz - 0.05) * (i + 0.5 * draw.share()) / tones;
    all.push_back({1 / (1 + 4 * f * f), f, draw.between(0, 2 * std::numbers::pi)});
  }
  loop.reference_rad = Signal(all, -run.lead_in_s - 2, run.duration_s + 2);
  loop.reference_rad *= draw.between(0.15, 0.4) / loop.reference_rad.rms();
  loop.damping_nms_per_rad = draw.between(25, 60) * arm.inertia_kgm2;
  loop.stiffness_nm_per_rad = draw.between(15, 35) * loop.damping_nms_per_rad;
  loop.noise_rad = draw.log_between(1e-4, 6e-4);
  loop.late_ms = static_cast<std::size_t>(draw.whole(2, 5));
  loop.seed = seed;
  return loop;
}

Signal torque_along(const PositionLoop& loop, const Arm& arm, const Run& run) {
  const auto angle = [&](double t) { return loop.reference_rad.at(t); };
  return torque_along(arm, angle, -run.lead_in_s - 1, run.duration_s + 1);
}

std::unique_ptr<Element> held_by(const PositionLoop& loop, const Run& run) {
  return std::make_unique<HeldWheel>(loop, run);
}

}  // namespace steerid::blind
