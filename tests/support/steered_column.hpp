// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A driver on a steering column, for tests of the firmware: two masses and a torsion bar, Coulomb friction below it, a
// voluntary torque that no sensor sees. Integrated here and nowhere else, so that it shares no code with the plant.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "port/sample.hpp"

namespace steerid::test {

struct SteeredColumn {
  double inertia_kgm2 = 0.105, damping_nms_per_rad = 1.5, stiffness_nm_per_rad = 22;  // arm and wheel, above the bar
  double intent_rad = 0;         // rms of the angle that the driver wants
  double probe_nm = 0;           // rms, 0.2 to 6 Hz
  double probe_late_s = 0;       // how late the motor delivers it
  double friction_nm = 0.6;      // dry, below the bar
  double column_kgm2 = 0.1;      // the mass below the bar
  double assist = 0;             // of the bar's torque, added by the motor
  double wheel_friction_nm = 0;  // dry, above it
  double stiffer_by = 1;         // factor of the stiffness, and its root of the damping, ...
  double stiffer_from_s = 1e9, stiffer_within_s = 2;
  double let_go_from_s = 1e9, let_go_for_s = 0;  // nobody holds the wheel of 0.035 kg m2 and 0.06 Nms/rad
};

struct ColumnRow {
  double bar_nm, probe_nm, angle_rad, stiffness_nm_per_rad;
};

/// A rate that dry friction takes `by` off, as far as there is one.
inline double braked(double rate, double by) { return std::abs(rate) < by ? 0 : rate - std::copysign(by, rate); }

/// Semi-implicit Euler at 4 kHz; sensors of 0.02 Nm and 0.5 mrad. At every sample `probe` says what is asked for
/// (asked(t), Nm) and what the motor makes of it (delivered(t)), and sees the row (see(row)). `draw` makes it, before
/// anything else is drawn.
template <class DrawProbe>
std::vector<ColumnRow> drive_with(const SteeredColumn& c, double duration_s, std::mt19937_64& random, DrawProbe draw) {
  constexpr double kPeriod_s = 0.01;
  constexpr int kSteps = 40;
  constexpr double h = kPeriod_s / kSteps;
  constexpr double kBar = 150, kBarDamping = 0.05, kColumnDamping = 0.8, kRack = 15;
  std::normal_distribution<double> normal;
  auto probe_way = draw();
  // The intended angle: white noise behind two second-order low-passes of 0.4 Hz, scaled to the rms that is asked.
  const double w = 2 * std::numbers::pi * 0.4;
  double x1 = 0, v1 = 0, x2 = 0, v2 = 0, power = 0;
  const auto wanted_step = [&] {
    v1 += h * (w * w * (normal(random) / std::sqrt(h) - x1) - 1.4 * w * v1);
    x1 += h * v1;
    v2 += h * (w * w * (x1 - x2) - 1.4 * w * v2);
    x2 += h * v2;
    return x2;
  };
  std::vector<double> wanted(static_cast<std::size_t>(duration_s / h));
  for (int i = 0; i < 40000; ++i) wanted_step();
  for (double& x : wanted) {
    x = wanted_step();
    power += x * x;
  }
  const double scale = c.intent_rad / std::sqrt(power / static_cast<double>(wanted.size()));

  std::vector<ColumnRow> rows;
  double th = 0, om = 0, ph = 0, pw = 0, probe = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const double t = static_cast<double>(k) * h;
    const double on_the_way = std::clamp((t - c.stiffer_from_s) / c.stiffer_within_s, 0.0, 1.0);
    const double factor = 1 + (c.stiffer_by - 1) * on_the_way;
    const bool held_by_hands = t < c.let_go_from_s || t >= c.let_go_from_s + c.let_go_for_s;
    const double stiffness = held_by_hands ? c.stiffness_nm_per_rad * factor : 0;
    const double damping = held_by_hands ? c.damping_nms_per_rad * std::sqrt(factor) : 0.06;
    const double inertia = held_by_hands ? c.inertia_kgm2 : 0.035;
    const double bar = kBar * (th - ph) + kBarDamping * (om - pw);
    if (k % kSteps == 0) {
      probe = probe_way.delivered(t);
      rows.push_back({bar + 0.02 * normal(random), probe_way.asked(t), th + 5e-4 * normal(random), stiffness});
      probe_way.see(rows.back());
    }
    om = braked(om + h * (stiffness * scale * wanted[k] - bar - damping * om - stiffness * th) / inertia,
                h * c.wheel_friction_nm / inertia);
    pw = braked(pw + h * ((1 + c.assist) * bar + probe - kColumnDamping * pw - kRack * ph) / c.column_kgm2,
                h * c.friction_nm / c.column_kgm2);
    th += h * om;
    ph += h * pw;
  }
  return rows;
}

/// A flat multisine of 0.2 to 6 Hz, which nobody asked the motor for in a loop.
struct FlatProbe {
  static constexpr int kLines = 59;
  const SteeredColumn& column;
  std::vector<double> phases;

  FlatProbe(const SteeredColumn& c, std::mt19937_64& random) : column(c), phases(kLines) {
    std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
    for (double& p : phases) p = phase(random);
  }
  [[nodiscard]] double asked(double t) const {
    double sum = 0;
    for (int i = 0; i < kLines; ++i)
      sum += std::cos(2 * std::numbers::pi * (0.2 + 0.1 * i) * t + phases[static_cast<std::size_t>(i)]);
    return column.probe_nm * std::sqrt(2.0 / kLines) * sum;
  }
  [[nodiscard]] double delivered(double t) const { return asked(t - column.probe_late_s); }
  void see(const ColumnRow& /*row*/) {}
};

inline std::vector<ColumnRow> drive(const SteeredColumn& c, double duration_s, std::mt19937_64& random) {
  return drive_with(c, duration_s, random, [&] { return FlatProbe(c, random); });
}

/// As the port delivers row `tick` of a drive: angle, torsion bar and probe.
inline Sample sample_of(const ColumnRow& row, std::int64_t tick) {
  const auto integer = [](double x) { return static_cast<std::int32_t>(std::lround(x)); };
  Sample sample;
  sample.stamp_us = tick * kTickPeriodUs;
  sample.sequence = static_cast<std::uint16_t>(tick);
  sample.angle_urad = integer(1e6 * row.angle_rad);
  sample.torque_bar_mnm = integer(1e3 * row.bar_nm);
  sample.probe_mnm = integer(1e3 * row.probe_nm);
  sample.valid_bits = kAngleValid | kTorqueBarValid | kProbeValid;
  return sample;
}

}  // namespace steerid::test
