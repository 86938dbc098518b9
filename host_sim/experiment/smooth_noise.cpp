// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/smooth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steerid {

SmoothNoise::SmoothNoise(const SmoothNoiseSettings& settings, std::uint64_t seed, std::uint64_t stream)
    : rms_(settings.rms), random_(seed, stream), rate_rad_s_(2.0 * std::numbers::pi * settings.corner_hz) {
  constexpr double kKnotRad = 0.2;
  ticks_between_knots_ = std::max(1, static_cast<int>(kKnotRad / (rate_rad_s_ * kTickS)));
  if (rms_ == 0.0) return;

  // Exact transition over one knot of the process in units where both standard deviations are 1 (time in 1/w0).
  const double h = rate_rad_s_ * kTickS * ticks_between_knots_;
  const double zeta = settings.damping_ratio;
  const double damped = std::sqrt(std::max(0.0, 1.0 - zeta * zeta));
  const double fading = std::exp(-zeta * h);
  const double c = std::cos(damped * h);
  const double s = damped > 1e-6 ? std::sin(damped * h) / damped : h;
  transition_[0][0] = fading * (c + zeta * s);
  transition_[0][1] = fading * s;
  transition_[1][0] = -fading * s;
  transition_[1][1] = fading * (c - zeta * s);
  // Stationary covariance I = F I F' + Q.
  const auto& f = transition_;
  const double q00 = 1.0 - f[0][0] * f[0][0] - f[0][1] * f[0][1];
  const double q10 = -f[1][0] * f[0][0] - f[1][1] * f[0][1];
  const double q11 = 1.0 - f[1][0] * f[1][0] - f[1][1] * f[1][1];
  innovation_[0][0] = std::sqrt(q00);
  innovation_[1][0] = q10 / innovation_[0][0];
  innovation_[1][1] = std::sqrt(std::max(0.0, q11 - innovation_[1][0] * innovation_[1][0]));

  x_ = random_.normal();
  v_ = random_.normal();
  draw_knot();
}

void SmoothNoise::draw_knot() {
  const double x = x_;
  const double v = v_;
  const double e0 = random_.normal();
  const double e1 = random_.normal();
  x_ = transition_[0][0] * x + transition_[0][1] * v + innovation_[0][0] * e0;
  v_ = transition_[1][0] * x + transition_[1][1] * v + innovation_[1][0] * e0 + innovation_[1][1] * e1;
  piece_ =
      between({rms_ * x, rms_ * rate_rad_s_ * v}, {rms_ * x_, rms_ * rate_rad_s_ * v_}, kTickS * ticks_between_knots_);
}

SignalPoint SmoothNoise::next() {
  if (rms_ == 0.0) return {};
  if (ticks_since_knot_ == ticks_between_knots_) {
    ticks_since_knot_ = 0;
    draw_knot();
  }
  const double tau_s = kTickS * ticks_since_knot_;
  ++ticks_since_knot_;
  return {piece_.at(tau_s), piece_.slope(tau_s)};
}

}  // namespace steerid
