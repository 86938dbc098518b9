// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/slow_torque.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "blind/draw.hpp"

namespace steerid::blind {

Signal slow_torque(double rms_nm, double from_s, double to_s, std::uint64_t seed) {
  constexpr int kTones = 60;
  constexpr double kHighestHz = 0.95;
  constexpr std::uint64_t kStream = 700;
  Draw draw(seed, kStream);
  const double corner_hz = draw.log_between(0.08, 0.4);
  std::vector<Tone> tones;
  for (int i = 0; i < kTones; ++i) {
    const double f = kHighestHz * (i + draw.share()) / kTones;
    const double amplitude = std::hypot(draw.normal(), draw.normal()) / std::hypot(1, f / corner_hz);
    tones.push_back({amplitude, f, draw.between(0, 2 * std::numbers::pi)});
  }
  Signal signal(tones, from_s, to_s);
  signal *= rms_nm / signal.rms();
  return signal;
}

}  // namespace steerid::blind
