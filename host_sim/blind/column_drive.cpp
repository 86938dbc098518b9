// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/column_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "blind/column_arm.hpp"
#include "blind/dormand_prince.hpp"
#include "blind/draw.hpp"
#include "blind/signal.hpp"

namespace steerid::blind {
namespace {

using std::numbers::pi;

enum Stream : std::uint64_t { kColumn = 1, kArm, kDriver, kRoad, kProbe, kSensors, kReadings, kBearing };

constexpr double kStrongest_nm = 4;  // of a driver, rms
constexpr double kLead_s = 1;        // before the first row, and after the last

// ---- what is drawn ----

struct Below {
  double wheel_inertia, wheel_damping;
  double bar_stiffness, bar_damping;
  double inertia, damping, aligning;
  double friction, bend_rad;
  double gain, knee_nm, lag_s, limit_nm;
  double probe_gain, probe_late_s;

  explicit Below(Draw draw)
      : wheel_inertia(draw.between(0.02, 0.05)),
        wheel_damping(draw.between(0.02, 0.1)),
        bar_stiffness(draw.log_between(80, 250)),
        bar_damping(draw.log_between(0.02, 0.3)),
        inertia(draw.log_between(0.05, 0.16)),
        damping(draw.between(0.3, 1.5)),
        aligning(draw.between(2, 25)),
        friction(draw.log_between(0.2, 1.5)),
        bend_rad(draw.log_between(0.001, 0.006)),
        gain(draw.between(0.5, 3.5)),
        knee_nm(draw.between(0.2, 1)),
        // No lag that takes more than a third of the column's damping from it: an EPS is made stable.
        lag_s(std::min(0.004, (damping + bar_damping * (1 + gain)) / (3 * bar_stiffness * gain))),
        limit_nm(draw.between(12, 40)),
        probe_gain(draw.between(0.8, 1.05)),
        probe_late_s(draw.between(0.005, 0.04)) {}
};

/// The driver's pulses a (t/tau) exp(1 - t/tau) at random instants.
struct Intent {
  double tau_s, per_s, mean_square;
  Signal angle_rad;

  Intent(double rms_rad, const ColumnRequest& request, Draw draw)
      : tau_s(draw.between(0.35, 0.8)),
        per_s(draw.between(0.6, 1.5)),
        // Campbell: rms^2 = rate E[a^2] integral of the pulse's square, e^2 tau / 4.
        mean_square(4 * rms_rad * rms_rad / (per_s * std::exp(2.0) * tau_s)) {
    if (rms_rad <= 0) return;
    std::vector<std::pair<double, double>> pulses;
    const double memory_s = 12 * tau_s;
    double at = -kLead_s - memory_s;
    while (at < request.duration_s + kLead_s) {
      at += -std::log(1 - draw.share()) / per_s;
      pulses.emplace_back(at, std::sqrt(mean_square) * draw.normal());
    }
    angle_rad = Signal(
        [&, first = std::size_t{0}](double t) mutable {
          if (t < pulses[first].first) first = 0;
          while (pulses[first].first < t - memory_s - 1) ++first;
          double sum = 0;
          for (std::size_t i = first; i < pulses.size() && pulses[i].first < t; ++i) {
            const double x = (t - pulses[i].first) / tau_s;
            sum += pulses[i].second * x * std::exp(1 - x);
          }
          return sum;
        },
        -kLead_s, request.duration_s + kLead_s);
  }

  [[nodiscard]] std::function<double(double)> density() const {
    return [*this](double hz) {
      const double x = 2 * pi * hz * tau_s;
      const double low = std::exp(1.0) * tau_s / (1 + x * x);
      return 2 * per_s * mean_square * low * low;
    };
  }
};

Signal tones(double rms, double low_hz, double high_hz, std::size_t count, double slope, Draw& draw,
             const ColumnRequest& request) {
  std::vector<Tone> all;
  double power = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double share = (static_cast<double>(k) + draw.share()) / static_cast<double>(count);
    const double hz = low_hz + (high_hz - low_hz) * share;
    const double amplitude = std::pow(hz, -slope);
    power += amplitude * amplitude / 2;
    all.push_back({amplitude, hz, draw.between(0, 2 * pi)});
  }
  for (Tone& tone : all) tone.amplitude *= rms / std::sqrt(power);
  return {all, -kLead_s, request.duration_s + kLead_s};
}

/// Noise behind one low pass, by tones whose amplitudes are its density's, and bumps of 60 ms.
Signal road(const ColumnRequest& request, Draw draw) {
  const double rms = draw.log_between(0.02, 0.4);
  const double corner_hz = draw.log_between(1, 8);
  constexpr std::size_t kTones = 60;
  std::vector<Tone> all;
  double power = 0;
  for (std::size_t k = 0; k < kTones; ++k) {
    const double hz = 0.05 + 20.0 * (static_cast<double>(k) + draw.share()) / kTones;
    const double amplitude = 1 / std::sqrt(1 + hz * hz / (corner_hz * corner_hz));
    power += amplitude * amplitude / 2;
    all.push_back({amplitude, hz, draw.between(0, 2 * pi)});
  }
  for (Tone& tone : all) tone.amplitude *= rms / std::sqrt(power);
  Signal sum(all, -kLead_s, request.duration_s + kLead_s);
  std::vector<std::pair<double, double>> bumps;
  double at = 0;
  while (at < request.duration_s) {
    bumps.emplace_back(at, draw.sign() * draw.between(0.5, 3));
    at += -20 * std::log(1 - draw.share());
  }
  constexpr double kBump_s = 0.06;
  sum += Signal(
      [&](double t) {
        double torque = 0;
        for (const auto& [begins, size] : bumps) {
          const double share = (t - begins) / kBump_s;
          if (share > 0 && share < 1) torque += size * std::sin(pi * share) * std::sin(pi * share);
        }
        return torque;
      },
      -kLead_s, request.duration_s + kLead_s);
  return sum;
}

// ---- the column ----

/// th, th', ph, ph', bend of the bristles over bend_rad, the motor's assist; where there is friction above the bar, the
/// bend of its own bristles.
enum State : std::size_t { kAngle, kRate, kLowerAngle, kLowerRate, kBend, kAssist, kUpperBend, kStates };

/// Bristles of one length: Dahl 1968.
double bending(double rate, double bend, double bend_rad) { return (rate - std::abs(rate) * bend) / bend_rad; }

/// Above the bar.
struct Bearing {
  double friction_nm = 0;
  double bend_rad = 0;
};

struct Drive {
  const Below& below;
  const ColumnArm& above;
  const Signal& intent;
  const Signal& road;
  const Signal& probe;
  Bearing bearing{};
  double probe_sign = 1;

  [[nodiscard]] std::size_t states() const { return bearing.friction_nm > 0 ? kStates : kUpperBend; }

  [[nodiscard]] double voluntary_nm(double t) const { return above.stiffness.at(t) * intent.at(t); }
  [[nodiscard]] double bar_nm(std::span<const double> x) const {
    return below.bar_stiffness * (x[kAngle] - x[kLowerAngle]) + below.bar_damping * (x[kRate] - x[kLowerRate]);
  }
  [[nodiscard]] double motor_nm(double t, std::span<const double> x) const {
    const double asked = x[kAssist] + probe_sign * below.probe_gain * probe.at(t - below.probe_late_s);
    return below.limit_nm * std::tanh(asked / below.limit_nm);
  }
  [[nodiscard]] double bearing_nm(std::span<const double> x) const {
    return bearing.friction_nm > 0 ? bearing.friction_nm * x[kUpperBend] : 0;
  }
  [[nodiscard]] double turning(double t, std::span<const double> x) const {
    return (voluntary_nm(t) - bar_nm(x) - bearing_nm(x) - above.damping.at(t) * x[kRate] -
            above.stiffness.at(t) * x[kAngle]) /
           above.inertia.at(t);
  }
  void rates(double t, std::span<const double> x, std::span<double> slope) const {
    const double bar = bar_nm(x);
    slope[kAngle] = x[kRate];
    slope[kRate] = turning(t, x);
    slope[kLowerAngle] = x[kLowerRate];
    slope[kLowerRate] = (bar + motor_nm(t, x) + road.at(t) - below.damping * x[kLowerRate] -
                         below.aligning * x[kLowerAngle] - below.friction * x[kBend]) /
                        below.inertia;
    slope[kBend] = bending(x[kLowerRate], x[kBend], below.bend_rad);
    if (bearing.friction_nm > 0) slope[kUpperBend] = bending(x[kRate], x[kUpperBend], bearing.bend_rad);
    slope[kAssist] =
        (below.gain * bar * bar * bar / (bar * bar + below.knee_nm * below.knee_nm) - x[kAssist]) / below.lag_s;
  }
};

/// Goes through the drive and tells what there is at each of `times`, which rise.
template <class Each>
void go_through(const Drive& drive, const std::vector<double>& times, Each each) {
  DormandPrince method(
      drive.states(), [&](double t, std::span<const double> x, std::span<double> slope) { drive.rates(t, x, slope); },
      1e-6, 1e-8);
  std::vector<double> x(drive.states(), 0.0);
  double t = -kLead_s / 2;
  double step = 1e-3;
  for (const double to : times) {
    while (t < to) {
      const bool last = t + step >= to;
      const double length = last ? to - t : step;
      const double error = method.attempt(t, x, length);
      if (error > 1) {
        step = DormandPrince::better_step(length, error);
        continue;
      }
      std::copy(method.end().begin(), method.end().end(), x.begin());
      method.go_on();
      t = last ? to : t + length;
      const double better = DormandPrince::better_step(length, error);
      step = std::min(5e-3, last ? std::max(step, better) : better);
    }
    each(t, std::span<const double>(x));
  }
}

std::vector<double> angle_under(Drive drive, double sign, const std::vector<double>& times) {
  drive.probe_sign = sign;
  std::vector<double> angle;
  go_through(drive, times, [&](double, std::span<const double> x) { angle.push_back(x[kAngle]); });
  return angle;
}

// ---- the sensors ----

struct Sensor {
  double noise = 0;
  double step = 0;
  double offset = 0;
  double read(double value, Draw& draw) const {
    const double noisy = value + offset + noise * draw.normal();
    return step > 0 ? step * std::round(noisy / step) : noisy;
  }
  [[nodiscard]] double deviation() const { return std::hypot(noise, step / std::sqrt(12.0)); }
};

}  // namespace

DrawnColumnDrive draw_column_drive(const ColumnRequest& request, std::uint64_t seed, std::uint64_t number) {
  const std::uint64_t own = seed * 0x9e3779b1ULL + number;
  const Below below(Draw(own, kColumn));
  const ColumnArm above(request, {below.wheel_inertia, below.wheel_damping}, kLead_s, Draw(own, kArm));
  const double steering_rad = std::min(request.steering_rad, kStrongest_nm / above.usual_stiffness);
  const Intent intent(steering_rad, request, Draw(own, kDriver));
  const Signal troad = road(request, Draw(own, kRoad));
  Draw probe_draw(own, kProbe);
  const auto count = static_cast<std::size_t>(probe_draw.whole(20, 40));
  const double slope = probe_draw.between(0, 0.5);
  const Signal probe = tones(request.probe_nm, 0.15, 7, count, slope, probe_draw, request);
  const Bearing bearing{request.wheel_friction_nm, Draw(own, kBearing).log_between(1e-4, 1e-3)};
  const Drive drive{below, above, intent.angle_rad, troad, probe, bearing};

  Draw sensors(own, kSensors);
  const Sensor bar{sensors.log_between(0.01, 0.05), sensors.chance(0.5) ? 0.01 : 0.0, sensors.between(-0.05, 0.05)};
  const Sensor rim{0.03, 0.005, sensors.between(-0.1, 0.1)};
  constexpr std::array kSteps_rad = {0.0, 0.0007, 0.00175};
  const Sensor angle{sensors.log_between(0.0002, 0.0012), kSteps_rad[sensors.index(kSteps_rad.size())],
                     sensors.between(-0.02, 0.02)};
  const double late_s = sensors.between(0, 0.0005);  // 1 ms would add a thousandth of C to B: no data can show it
  const double jitter_s = sensors.between(0, 0.0003);

  DrawnColumnDrive drawn;
  drawn.torque_noise_nm = bar.deviation();
  drawn.angle_noise_rad = angle.deviation();
  drawn.intent_rad2_per_hz = intent.density();
  Record& record = drawn.record;
  record.channels = kAngleValid | kTorqueMotorValid | kColumnChannels;
  Draw readings(own, kReadings);
  const auto rows = static_cast<std::size_t>(std::llround(request.duration_s / request.period_s));
  std::vector<double> even;
  std::vector<double> instants;
  for (std::size_t k = 0; k < rows; ++k) {
    even.push_back(static_cast<double>(k) * request.period_s);
    instants.push_back(even.back() + jitter_s * readings.between(-1.7, 1.7));
  }
  go_through(drive, instants, [&](double t, std::span<const double> x) {
    record.time_s.push_back(1e-6 * std::round(1e6 * t));
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(drive.motor_nm(t, x) + 0.01 * readings.normal());
    record.torque_bar_nm.push_back(bar.read(drive.bar_nm(x), readings));
    record.torque_rim_nm.push_back(rim.read(below.wheel_inertia * drive.turning(t, x) + below.wheel_damping * x[kRate] +
                                                drive.bearing_nm(x) + drive.bar_nm(x),
                                            readings));
    record.probe_nm.push_back(1e-3 * std::round(1e3 * probe.at(t)));
    record.angle_rad.push_back(angle.read(x[kAngle] - late_s * x[kRate], readings));
    drawn.truth.push_back({above.inertia.at(t), above.damping.at(t), above.stiffness.at(t), drive.voluntary_nm(t)});
  });
  const double shift_s = record.time_s.front();
  for (double& t : record.time_s) t -= shift_s;
  if (!request.by_probe) return drawn;
  drawn.by_probe_rad = angle_under(drive, 1, even);
  const std::vector<double> other = angle_under(drive, -1, even);
  for (std::size_t k = 0; k < rows; ++k) drawn.by_probe_rad[k] = (drawn.by_probe_rad[k] - other[k]) / 2;
  return drawn;
}

}  // namespace steerid::blind
