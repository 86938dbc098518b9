// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/column_arm.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace steerid::blind {
namespace {

using std::numbers::pi;

double approach(double lags) { return lags <= 0 ? 0 : 1 - std::exp(-lags); }
double rise(double share) {
  const double x = std::clamp(share, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

std::function<double(double)> wandering(Draw& draw) {
  constexpr std::size_t kTones = 5;
  std::vector<Tone> tones;
  tones.reserve(kTones);
  for (std::size_t i = 0; i < kTones; ++i) {
    tones.push_back({0.15 * std::sqrt(2.0 / kTones), 1 / draw.log_between(15, 120), draw.between(0, 2 * pi)});
  }
  return [=](double t) {
    double sum = 0;
    for (const Tone& tone : tones) sum += tone.amplitude * std::sin(2 * pi * tone.frequency_hz * t + tone.phase_rad);
    return std::exp(sum);
  };
}

/// Every 95 s, each time otherwise.
std::function<double(double)> bracing(Draw& draw) {
  struct Brace {
    double at, factor, within, lasts, back;
  };
  std::vector<Brace> braces;
  constexpr int kBraces = 38;  // an hour
  const double first = draw.between(20, 95);
  braces.reserve(kBraces);
  for (int i = 0; i < kBraces; ++i) {
    const double at = first + 95.0 * i;
    braces.push_back(
        {at, draw.log_between(1.5, 4), draw.log_between(0.3, 3), draw.between(10, 25), draw.log_between(1, 5)});
  }
  return [=](double t) {
    double factor = 1;
    for (const Brace& one : braces) {
      if (t < one.at || t > one.at + 95) continue;
      factor *= 1 + (one.factor - 1) * (rise((t - one.at) / one.within) - rise((t - one.at - one.lasts) / one.back));
    }
    return factor;
  };
}

}  // namespace

ColumnArm::ColumnArm(const ColumnRequest& request, const Wheel& wheel, double lead_s, Draw draw) {
  const double arm_inertia = draw.log_between(0.03, 0.14);
  const double arm_damping = draw.log_between(0.3, 3.5);
  const double arm_stiffness = draw.log_between(4.5, 75);
  const double at = request.duration_s * draw.between(0.25, 0.4);
  const double follows = draw.between(0.2, 0.8);
  std::function<double(double)> stiffer = [](double) { return 1.0; };  // over the usual C
  std::function<double(double)> second = [](double) { return 0.0; };   // share of a second hand
  std::function<double(double)> held = [](double) { return 1.0; };
  std::function<double(double)> warm = [](double) { return 1.0; };
  double more_inertia = 0;
  double more_damping = 0;
  switch (request.course) {
    case ArmCourse::kStays:
      break;
    case ArmCourse::kChanges: {
      const double factor = std::pow(draw.log_between(1.3, 4), draw.sign());
      const double lag = draw.log_between(2, 20) / 3;  // 95 % of the way after three of them
      const double back = draw.chance(0.5) ? at + 3 * lag + draw.between(3, 12) : 1e9;
      stiffer = [=](double t) {
        const double gone = approach((t - at) / lag) - approach((t - back) / lag);
        return 1 + gone * (factor - 1);
      };
      break;
    }
    case ArmCourse::kSwings: {
      const double slow = 2 * pi / draw.log_between(8, 40);
      const double fast = slow * draw.between(1.3, 2.3);
      const double depth = draw.between(0.15, 0.5);
      const double phase = draw.between(0, 2 * pi);
      stiffer = [=](double t) {
        return std::exp(depth * (0.7 * std::sin(slow * t + phase) + 0.5 * std::sin(fast * t)));
      };
      break;
    }
    case ArmCourse::kWanders:
      stiffer = wandering(draw);
      break;
    case ArmCourse::kBraces:
      stiffer = bracing(draw);
      break;
    case ArmCourse::kWarmsUp:
      warm = [](double t) { return 0.6 + 0.4 * std::exp(-std::max(t, 0.0) / 200); };
      break;
    case ArmCourse::kHandsCome:
    case ArmCourse::kOrdinary: {
      more_inertia = draw.between(0.1, 0.3);
      more_damping = draw.between(0.15, 0.6);
      const double first = draw.between(0, 150);
      second = [=](double t) {
        const double since = std::fmod(t + first + 300, 150.0);
        return rise(since / 0.5) - rise((since - 75) / 0.5);
      };
      const double more_stiffness = draw.between(0.15, 0.6);
      stiffer = [=](double t) { return 1 + more_stiffness * second(t); };
      if (request.course == ArmCourse::kHandsCome) break;
      stiffer = [hands = stiffer, wanders = wandering(draw), braces = bracing(draw)](double t) {
        return hands(t) * wanders(t) * braces(t);
      };
      held = [](double t) {
        const double since = std::fmod(t + 200, 200.0) - 100;
        return 1 - rise(since / 0.3) + rise((since - 8) / 0.5);
      };
      break;
    }
    case ArmCourse::kSecondHand: {
      more_inertia = draw.between(0.1, 0.3);
      more_damping = draw.between(0.15, 0.6);
      const double more_stiffness = draw.between(0.15, 0.6);
      const double lag = draw.between(0.05, 0.3);
      second = [=](double t) { return approach((t - at) / lag); };
      stiffer = [=](double t) { return 1 + more_stiffness * approach((t - at) / lag); };
      break;
    }
    case ArmCourse::kHandsLeave: {
      const double back = at + draw.between(8, 15);
      const double leaving = draw.between(0.1, 0.4);
      held = [=](double t) { return 1 - rise((t - at) / leaving) + rise((t - back) / (2 * leaving)); };
      break;
    }
  }
  const auto over = [&](auto f) { return Signal(f, -lead_s, request.duration_s + lead_s); };
  usual_stiffness = arm_stiffness;
  inertia = over([=](double t) { return wheel.inertia + held(t) * arm_inertia * (1 + more_inertia * second(t)); });
  damping = over([=](double t) {
    const double answered = more_damping > 0 ? 1 + more_damping * second(t) : std::pow(stiffer(t), follows);
    return wheel.damping + held(t) * arm_damping * answered * warm(t);
  });
  stiffness = over([=](double t) { return held(t) * arm_stiffness * stiffer(t); });
}

}  // namespace steerid::blind
