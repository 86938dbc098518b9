// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/drive.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace steerid::blind {
namespace {

constexpr double kPi = std::numbers::pi;

struct Span {
  double from_s;
  double to_s;
};

/// Random tones with equal power from `low_hz` to `high_hz`, of this rms.
Signal noise(double rms, double low_hz, double high_hz, int tones, Span span, Draw& draw) {
  std::vector<Tone> all;
  for (int i = 0; i < tones; ++i) {
    const double f = low_hz + (high_hz - low_hz) * (i + draw.share()) / tones;
    all.push_back({std::hypot(draw.normal(), draw.normal()), f, draw.between(0, 2 * kPi)});
  }
  Signal signal(all, span.from_s, span.to_s);
  signal *= rms / signal.rms();
  return signal;
}

Signal multisine(double rms, Span span, Draw& draw) {
  const double highest_hz = draw.between(4, 7);
  const int tones = draw.whole(18, 40);
  const double lowest_hz = draw.between(0.05, 0.2);
  const bool even_octaves = draw.chance(0.4);
  std::vector<Tone> all;
  for (int i = 0; i < tones; ++i) {
    const double u = (i + 0.3 * draw.between(-1, 1)) / (tones - 1);
    const double f = even_octaves ? lowest_hz * std::pow(highest_hz / lowest_hz, u)
                                  : std::abs(lowest_hz + (highest_hz - lowest_hz) * u);
    all.push_back({1, f, draw.between(0, 2 * kPi)});
  }
  Signal signal(all, span.from_s, span.to_s);
  signal *= rms / signal.rms();
  return signal;
}

/// As far as an EPS motor of some hertz follows it: the triangle's Fourier series up to `kHarmonics`.
Signal triangle(double amplitude, double frequency_hz, Span span, Draw& draw) {
  constexpr int kHarmonics = 99;
  const double phase = draw.between(0, 2 * kPi);
  std::vector<Tone> all;
  for (int n = 1; n <= kHarmonics; n += 2) {
    const double sign = n % 4 == 1 ? 1 : -1;
    all.push_back({sign * amplitude * 8 / (kPi * kPi * n * n), n * frequency_hz, n * phase});
  }
  return {all, span.from_s, span.to_s};
}

Signal hand(Span span, Draw& draw) {
  Signal torque = noise(draw.between(0.08, 0.2), 0.05, draw.between(0.6, 1.5), 40, span, draw);
  torque += noise(draw.between(0.01, 0.03), 7.5, 10, 25, span, draw);
  return torque;
}

/// The torque that turns this arm as the driver means it: J a'' + B a' + C a of an angle whose amplitude, period and
/// centre wander.
Signal steering(const Arm& arm, Span span, Draw& draw) {
  const double amplitude = draw.between(0.8, 1.2);
  const double w = 2 * kPi * draw.between(0.21, 0.29);
  const Signal swell = noise(0.08 * amplitude, 0.01, 0.08, 20, span, draw);
  const Signal wander = noise(0.35, 0.01, 0.06, 20, span, draw);
  const Signal centre = noise(0.06, 0.02, 0.12, 20, span, draw);
  const Signal corrections = noise(0.02, 0.4, 1.5, 30, span, draw);
  const auto angle = [&](double t) {
    return (amplitude + swell.at(t)) * std::sin(w * t + wander.at(t)) + centre.at(t) + corrections.at(t);
  };
  return torque_along(arm, angle, span.from_s, span.to_s);
}

}  // namespace

std::string_view name(Task task) {
  constexpr std::array<std::string_view, 4> kNames = {"passive", "active", "probe", "loop"};
  return kNames[static_cast<std::size_t>(task)];
}

Signal torque_along(const Arm& arm, const std::function<double(double)>& angle, double from_s, double to_s) {
  constexpr double kH = 4e-3;  // fourth-order differences: 1e-9 at the rates of a hand
  const auto torque = [&](double t) {
    const double far = angle(t + 2 * kH), near = angle(t + kH), here = angle(t), back = angle(t - kH),
                 farther = angle(t - 2 * kH);
    const double rate = (8 * (near - back) - (far - farther)) / (12 * kH);
    const double acceleration = (16 * (near + back) - (far + farther) - 30 * here) / (12 * kH * kH);
    return arm.inertia_kgm2 * acceleration + arm.damping_nms_per_rad * rate + arm.stiffness_nm_per_rad * here;
  };
  return {torque, from_s, to_s};
}

Torques draw_torques(Task task, const Arm& arm, const Run& run, Draw& draw) {
  const Span span{-run.lead_in_s - 1, run.duration_s + 1};
  Torques torques;
  torques.driver = hand(span, draw);
  switch (task) {
    case Task::kPassive:
      torques.motor = triangle(draw.between(4, 6), draw.between(0.022, 0.028), span, draw);
      torques.motor += multisine(draw.between(0.7, 2.2), span, draw);
      break;
    case Task::kActive: {
      const Signal needed = steering(arm, span, draw);
      const double assist = draw.between(0, 0.15);
      Signal driver = needed;
      driver *= 1 - assist;
      torques.driver += driver;
      torques.motor = needed;
      torques.motor *= -assist;
      torques.motor += multisine(draw.between(0.6, 1.4), span, draw);
      break;
    }
    case Task::kProbe:
      torques.motor = multisine(draw.between(1.3, 2.5), span, draw);
      break;
    case Task::kLoop:  // the motor's torque is the loop's to make
      break;
  }
  return torques;
}

}  // namespace steerid::blind
