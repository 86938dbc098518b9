// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Angle and torque records shifted against each other: the angle written down at t is that of t - d. d < 0 shifts the
// torques instead.
//
// Signature: phase error that grows in proportion to frequency, no amplitude error.
// Forward the late channel is interpolated in a short memory, the angle by a Hermite cubic on angle and rate, the
// torques by a one-sided quintic through six samples (error (2 pi f/fs)^6/43 relative at worst, 2e-5 at 5 Hz and 100
// Hz). In a replay the plant simply starts earlier or runs longer; torques beyond the record hold its end values.
#include <cmath>
#include <cstddef>

#include "plant/cubic.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"delay_s", 0.03, -0.25, 0.25, 0.002, "by how much the angle is late against the torques"},
};

class Delay final : public RecordEffect {
 public:
  explicit Delay(std::span<const double> values) : delay_s_(values[0]) {}

  void record(Channels& now) override {
    if (delay_s_ == 0) return;
    remember(now);
    const double at_s = now.time_s - std::abs(delay_s_);
    if (delay_s_ > 0) {
      late_angle(at_s, now);
    } else {
      late_torques(at_s, now);
    }
  }

  [[nodiscard]] double reach_s() const override { return std::abs(delay_s_); }

  void record(Trajectory& run) const override {
    if (delay_s_ == 0) return;
    const std::size_t count = run.time_s.size();
    // In place: walk away from where the values come from.
    if (delay_s_ > 0) {
      std::size_t k = count - 1;
      for (std::size_t i = count; i-- > 0;) shift(run, i, k);
    } else {
      std::size_t k = 0;
      for (std::size_t i = 0; i < count; ++i) shift(run, i, k);
    }
  }

 private:
  static constexpr std::size_t kMemory = 4096;  // 0.25 s at 16 kHz
  static constexpr std::size_t kPoints = 6;

  void shift(Trajectory& run, std::size_t i, std::size_t& k) const {
    const double at_s = run.time_s[i] - delay_s_;
    const std::size_t last = run.time_s.size() - 2;
    if (k > last) k = last;
    while (k > 0 && run.time_s[k] > at_s) --k;
    while (k < last && run.time_s[k + 1] <= at_s) ++k;
    const Cubic angle = Cubic::hermite(run.angle_rad[k], run.rate_rad_s[k], run.angle_rad[k + 1], run.rate_rad_s[k + 1],
                                       run.time_s[k + 1] - run.time_s[k]);
    run.angle_rad[i] = angle.at(at_s - run.time_s[k]);
    run.rate_rad_s[i] = angle.slope(at_s - run.time_s[k]);
  }

  void remember(const Channels& now) {
    if (kept_.empty()) kept_.reserve(kMemory);
    if (kept_.size() < kMemory) {
      kept_.push_back(now);
    } else {
      kept_[next_] = now;
    }
    next_ = (next_ + 1) % kMemory;
  }

  /// The sample `back` before the newest.
  [[nodiscard]] const Channels& kept(std::size_t back) const { return kept_[(next_ + kMemory - 1 - back) % kMemory]; }

  /// How many samples back the newest one not after `at_s` lies; the oldest when all are after it.
  [[nodiscard]] std::size_t back_to(double at_s) const {
    std::size_t back = 0;
    while (back + 1 < kept_.size() && kept(back).time_s > at_s) ++back;
    return back;
  }

  void late_angle(double at_s, Channels& now) const {
    const std::size_t back = back_to(at_s);
    const Channels& a = kept(back);
    if (back == 0 || a.time_s > at_s) {  // nothing is known before the first sample: it counts as the wheel's rest
      now.angle_rad = a.angle_rad;
      now.rate_rad_s = a.rate_rad_s;
      return;
    }
    const Channels& b = kept(back - 1);
    const Cubic angle = Cubic::hermite(a.angle_rad, a.rate_rad_s, b.angle_rad, b.rate_rad_s, b.time_s - a.time_s);
    now.angle_rad = angle.at(at_s - a.time_s);
    now.rate_rad_s = angle.slope(at_s - a.time_s);
  }

  void late_torques(double at_s, Channels& now) const {
    const std::size_t back = back_to(at_s);
    if (kept(back).time_s > at_s) {
      now.torque_driver_nm = kept(back).torque_driver_nm;
      now.torque_motor_nm = kept(back).torque_motor_nm;
      return;
    }
    // Six samples around at_s, as far as the present allows: Lagrange's polynomial.
    const std::size_t points = std::min(kPoints, kept_.size());
    std::size_t newest = back >= points / 2 ? back - points / 2 : 0;
    newest = std::min(newest, kept_.size() - points);
    double driver = 0;
    double motor = 0;
    for (std::size_t i = 0; i < points; ++i) {
      const Channels& own = kept(newest + i);
      double weight = 1;
      for (std::size_t j = 0; j < points; ++j) {
        const double other_s = kept(newest + j).time_s;
        if (j != i) weight *= (at_s - other_s) / (own.time_s - other_s);
      }
      driver += weight * own.torque_driver_nm;
      motor += weight * own.torque_motor_nm;
    }
    now.torque_driver_nm = driver;
    now.torque_motor_nm = motor;
  }

  double delay_s_;
  std::vector<Channels> kept_;
  std::size_t next_ = 0;
};

}  // namespace

constinit const EffectType delay{
    .id = "delay",
    .says = "angle and torque records shifted against each other by a pure delay",
    .parameters = kParameters,
    .on_record = record_effect<Delay>,
};

}  // namespace steerid::effect
