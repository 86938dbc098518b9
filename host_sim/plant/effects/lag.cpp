// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// First-order lag on the angle channel: T y' + y = th, y is written down.
//
// Signature: phase and amplitude of the angle both fall with frequency, -45 degrees at 1/(2 pi T) Hz.
// Between samples the angle is the Hermite cubic on angle and rate, and the lag's answer to that cubic is exact.
#include <cmath>

#include "plant/cubic.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"time_constant_s", 0.03, 0.0, 0.5, 0.002, "T"},
};

class Lag final : public RecordEffect {
 public:
  explicit Lag(std::span<const double> values) : time_constant_s_(values[0]) {}

  void record(Channels& now) override {
    if (time_constant_s_ == 0) return;
    const Channels in = now;
    lagged_rad_ = started_ ? answer(lagged_rad_,
                                    Cubic::hermite(before_.angle_rad, before_.rate_rad_s, in.angle_rad, in.rate_rad_s,
                                                   in.time_s - before_.time_s),
                                    in.time_s - before_.time_s)
                           : settled(in.angle_rad, in.rate_rad_s);
    started_ = true;
    before_ = in;
    now.angle_rad = lagged_rad_;
    now.rate_rad_s = (in.angle_rad - lagged_rad_) / time_constant_s_;
  }

  void record(Trajectory& run) const override {
    if (time_constant_s_ == 0) return;
    double angle = run.angle_rad[0];
    double rate = run.rate_rad_s[0];
    double lagged = settled(angle, rate);
    run.angle_rad[0] = lagged;
    run.rate_rad_s[0] = (angle - lagged) / time_constant_s_;
    for (std::size_t i = 1; i < run.time_s.size(); ++i) {
      const double next_angle = run.angle_rad[i];
      const double next_rate = run.rate_rad_s[i];
      const double h = run.time_s[i] - run.time_s[i - 1];
      lagged = answer(lagged, Cubic::hermite(angle, rate, next_angle, next_rate, h), h);
      run.angle_rad[i] = lagged;
      run.rate_rad_s[i] = (next_angle - lagged) / time_constant_s_;
      angle = next_angle;
      rate = next_rate;
    }
  }

 private:
  /// The lag's output when the angle has been moving at this rate for long.
  [[nodiscard]] double settled(double angle, double rate) const { return angle - time_constant_s_ * rate; }

  /// One interval. The cubic's steady answer is u - T u' + T^2 u'' - T^3 u'''; the rest decays.
  [[nodiscard]] double answer(double lagged, const Cubic& u, double h) const {
    const double tc = time_constant_s_;
    const auto steady = [&](double s) {
      return u.at(s) - tc * u.slope(s) + tc * tc * (2 * u.c2 + 6 * u.c3 * s) - tc * tc * tc * 6 * u.c3;
    };
    // Far below the sampling interval the powers of T vanish and the lag is the shift that `steady` already is.
    return steady(h) + (lagged - steady(0)) * std::exp(-h / tc);
  }

  double time_constant_s_;
  bool started_ = false;
  double lagged_rad_ = 0;
  Channels before_;
};

}  // namespace

constinit const EffectType lag{
    .id = "lag",
    .says = "first-order lag on the angle channel",
    .parameters = kParameters,
    .on_record = record_effect<Lag>,
};

}  // namespace steerid::effect
