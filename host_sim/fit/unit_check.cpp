// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/unit_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace steerid {
namespace {

bool has_a_steering_sensor(const Record& record) { return record.has(kTorqueBarValid) || record.has(kTorqueRimValid); }

/// The torque on the wheel alone where both sensors tell it, else on what is identified.
std::vector<double> torque_of(const Record& record) {
  if (!record.has(kTorqueBarValid) || !record.has(kTorqueRimValid)) return record.net_torque_nm();
  std::vector<double> between = record.torque_rim_nm;
  for (std::size_t i = 0; i < between.size(); ++i) between[i] -= record.torque_bar_nm[i];
  return between;
}

/// `values` moved by whole samples towards later times; the ends keep theirs.
std::vector<double> moved(const std::vector<double>& values, std::ptrdiff_t samples) {
  std::vector<double> out(values.size());
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    out[static_cast<std::size_t>(i)] =
        values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i - samples, 0, last))];
  }
  return out;
}

}  // namespace

UnitCheck check_units(const Record& record) {
  UnitCheck check;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double angle : record.angle_rad) {
    if (!std::isfinite(angle)) return check;
    low = std::min(low, angle);
    high = std::max(high, angle);
  }
  check.turned_rad = high - low;
  const MotionFit fit = fit_motion(record, torque_of(record));
  if (fit.samples > 0 && fit.inertia.shown()) check.inertia_kgm2 = std::abs(fit.inertia.value);
  const double sd = fit.inertia.sd;
  if (check.turned_rad > kFarthestTurnRad) {
    check.verdict = UnitCheck::Verdict::kTurnsTooFar;
  } else if (check.inertia_kgm2 > 0 && check.inertia_kgm2 + 4 * sd < kLightestKgm2 &&
             (has_a_steering_sensor(record) || check.turned_rad > 2 * std::numbers::pi)) {
    check.verdict = UnitCheck::Verdict::kTooLight;
  } else if (check.inertia_kgm2 - 4 * sd > kHeaviestKgm2) {
    check.verdict = UnitCheck::Verdict::kTooHeavy;
  }
  return check;
}

TorqueDelay torque_delay(const Record& record) {
  constexpr std::ptrdiff_t kMost = 6;  // samples of 10 ms
  constexpr double kPeriodS = 0.01;
  constexpr double kSamplesAlike = 10.6;  // 2 sqrt(pi) times the 3 samples of fit_motion's Gaussian
  constexpr double kFourDeviations = 16;  // of twice a log likelihood's rise
  const std::vector<double> torque_nm = torque_of(record);
  std::vector<double> power;  // that stays unexplained with the torque moved by -kMost .. kMost samples
  std::size_t samples = 0;
  for (std::ptrdiff_t lag = -kMost; lag <= kMost; ++lag) {
    const MotionFit fit = fit_motion(record, moved(torque_nm, -lag));
    if (fit.samples == 0 || !(fit.torque_rms_nm > 0)) return {};
    samples = fit.samples;
    power.push_back(fit.residual_rms_nm * fit.residual_rms_nm);
  }
  const auto least = static_cast<std::ptrdiff_t>(std::ranges::min_element(power) - power.begin());
  if (least == 0 || least == 2 * kMost) return {};
  const auto at = [&](std::ptrdiff_t i) { return power[static_cast<std::size_t>(i)]; };
  const double bend = at(least - 1) - 2 * at(least) + at(least + 1);
  const double off = bend > 0 ? 0.5 * (at(least - 1) - at(least + 1)) / bend : 0;
  const double lowest = std::max(at(least) - 0.5 * bend * off * off, 1e-12 * at(kMost));
  TorqueDelay delay{.late_s = kPeriodS * (static_cast<double>(least - kMost) + off)};
  delay.shown = static_cast<double>(samples) / kSamplesAlike * std::log(at(kMost) / lowest) > kFourDeviations &&
                std::abs(delay.late_s) > 0.5 * kPeriodS;
  return delay;
}

}  // namespace steerid
