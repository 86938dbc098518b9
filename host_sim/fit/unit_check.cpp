// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/unit_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "fit/clock_lag.hpp"
#include "fit/instrumental_fit.hpp"
#include "fit/probe_misfit.hpp"

namespace steerid {
namespace {

bool has_a_steering_sensor(const Record& record) { return record.has(kTorqueBarValid) || record.has(kTorqueRimValid); }

constexpr double kEightNats = 8;  // of log likelihood: four deviations

double turned_rad(const Record& record) {
  const auto [low, high] = std::ranges::minmax_element(record.angle_rad);
  return low == record.angle_rad.end() ? 0 : *high - *low;
}

bool too_light(const FittedNumber& inertia) { return std::abs(inertia.value) + 4 * inertia.sd < kLightestKgm2; }
bool too_heavy(const FittedNumber& inertia) { return std::abs(inertia.value) - 4 * inertia.sd > kHeaviestKgm2; }

/// J within what a steering wheel can be, and no damping that drives it. Of a column seen from above both are negative.
bool may_be_a_wheel(const MotionFit& fit) {
  if (fit.samples == 0 || !fit.inertia.shown() || too_light(fit.inertia) || too_heavy(fit.inertia)) return false;
  return !fit.damping.shown() || (fit.damping.value > 0) == (fit.inertia.value > 0);
}

/// Behind a torsion bar least squares finds what lies below it as soon as the driver steers, however strong the probe:
/// about the column's J over 1 + assist, 0.006 kg m2 of a column of 0.03. Where a probe is in the record its motion
/// tells the arm, or nothing does. Between a rim and a bar there is the wheel alone, and no driver.
bool least_squares_finds_the_column(const Record& record) {
  const bool wheel_alone = record.has(kTorqueBarValid) && record.has(kTorqueRimValid);
  return !voluntary_torque_known(record.equation()) && !wheel_alone;
}

/// J, B and C of `fit`, by the probe where one is in the record and least squares would find the column.
MotionFit by_probe_where_there_is_one(const Record& record, MotionFit fit) {
  if (!least_squares_finds_the_column(record)) return fit;
  const InstrumentalFit arm = fit_by_instrument(record);
  if (!arm.by_probe) return fit;
  const bool told = drives(probe_misfit(arm));
  const auto number = [&](const FittedParameter& found) {
    return told ? FittedNumber{found.value, found.sd} : FittedNumber{0, std::numeric_limits<double>::infinity()};
  };
  fit.inertia = number(arm.inertia);
  fit.damping = number(arm.damping);
  fit.stiffness = number(arm.stiffness);
  return fit;
}

double unexplained_share(const MotionFit& fit) {
  return fit.residual_rms_nm * fit.residual_rms_nm / (fit.torque_rms_nm * fit.torque_rms_nm);
}

/// The torque that, exchanged with the angle, makes a wheel of what is none. `as_named` is by least squares in either
/// case, as what is exchanged is.
void find_exchange(const Record& record, const MotionFit& as_named, UnitCheck& check) {
  const bool known = voluntary_torque_known(record.equation());
  const bool signs_agree = as_named.inertia.shown() && as_named.damping.shown() &&
                           (as_named.damping.value > 0) == (as_named.inertia.value > 0);
  if (!known && (!too_light(as_named.inertia) || signs_agree)) return;
  double best_nats = known ? kEightNats : -std::numeric_limits<double>::infinity();
  for (const Channel channel :
       {Channel::kTorqueDriver, Channel::kTorqueMotor, Channel::kTorqueBar, Channel::kTorqueRim}) {
    if (!record.has(valid_bit(channel))) continue;
    Record exchanged = record;
    std::swap(exchanged.angle_rad, values_of(exchanged, channel));
    const double turned = turned_rad(exchanged);
    if (turned == 0 || turned > kFarthestTurnRad) continue;
    const MotionFit fit = fit_motion(exchanged, explained_torque_nm(exchanged));
    if (!may_be_a_wheel(fit) || (known && fit.inertia.value < 0)) continue;
    const double nats = 0.5 * static_cast<double>(fit.samples) / kSamplesAlike *
                        std::log(unexplained_share(as_named) / unexplained_share(fit));
    if (!(nats > best_nats)) continue;
    best_nats = nats;
    check = {.verdict = UnitCheck::Verdict::kExchanged,
             .turned_rad = turned,
             .inertia_kgm2 = std::abs(fit.inertia.value),
             .exchanged = channel};
  }
}

}  // namespace

UnitCheck check_units(const Record& record) {
  UnitCheck check;
  if (!std::ranges::all_of(record.angle_rad, [](double angle) { return std::isfinite(angle); })) return check;
  check.turned_rad = turned_rad(record);
  const MotionFit least_squares = fit_motion(record, explained_torque_nm(record));
  const MotionFit fit = by_probe_where_there_is_one(record, least_squares);
  if (fit.samples > 0 && fit.inertia.shown()) check.inertia_kgm2 = std::abs(fit.inertia.value);
  if (check.turned_rad > kFarthestTurnRad) {
    check.verdict = UnitCheck::Verdict::kTurnsTooFar;
  } else if (check.inertia_kgm2 > 0 && too_light(fit.inertia) &&
             (has_a_steering_sensor(record) || check.turned_rad > 2 * std::numbers::pi)) {
    check.verdict = UnitCheck::Verdict::kTooLight;
  } else if (check.inertia_kgm2 > 0 && too_heavy(fit.inertia)) {
    check.verdict = UnitCheck::Verdict::kTooHeavy;
  }
  if (fit.samples > 0 && !may_be_a_wheel(fit)) find_exchange(record, least_squares, check);
  return check;
}

bool tells_delays(const Record& record) {
  return voluntary_torque_known(record.equation()) || (record.has(kTorqueBarValid) && record.has(kTorqueRimValid));
}

TorqueDelay torque_delay(const Record& record) {
  constexpr double kMostS = 0.06;
  const ClockLag lag =
      clock_lag(record, kTorqueDriverValid | kTorqueMotorValid | kTorqueBarValid | kTorqueRimValid, kMostS);
  return {.late_s = lag.late_s, .shown = lag.shown};
}

}  // namespace steerid
