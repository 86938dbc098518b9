// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/first_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "apps/channel_words.hpp"
#include "fit/channel_check.hpp"
#include "fit/gauss_newton.hpp"
#include "fit/instrumental_fit.hpp"
#include "fit/sign_check.hpp"

namespace steerid {
namespace {

constexpr double kHardlyAnything = 0.5;  // of the angle's power left unexplained

BatchFit fit_with_offset(const Record& record) {
  FitOptions options;
  options.torque_offset = true;
  options.convergence_factor = false;
  return fit_batch(record, options);
}

/// An inertia without damping beside it may be a line in the noise that an undamped model rings along with.
bool shows_inertia(const BatchFit& fit) {
  return fit.inertia.state == ParameterState::kValid && fit.damping.state == ParameterState::kValid;
}

Record turned_round(Record record) {
  for (double& torque_nm : record.torque_driver_nm) torque_nm = -torque_nm;
  for (double& torque_nm : record.torque_motor_nm) torque_nm = -torque_nm;
  return record;
}

bool no_driver(const Record& record) {
  return std::ranges::all_of(record.torque_driver_nm, [](double torque_nm) { return torque_nm == 0; });
}

/// What is to be said of torques whose signs are in doubt.
std::string sign_words(const SignCheck& check, const TorquePair& pair, bool no_driver) {
  const bool both = check.torque_driver && check.torque_motor;
  const char* channels = both ? "both torques" : (check.torque_driver ? "torque_driver" : "torque_motor");
  const char* option = both ? "-1" : (check.torque_driver ? "torque_driver=-1" : "torque_motor=-1");
  const std::string turned = fmt::format(
      "as the record stands the best wheel leaves {:.3g} % of the angle's power unexplained, turned round "
      "{:.3g} %",
      100 * check.unexplained, 100 * check.unexplained_turned);
  if (const std::string words = pair_words(pair); !words.empty()) {
    return fmt::format("{}; with {} turned round, {}", words, channels, turned);
  }
  return fmt::format(
      "{} seem{} to have the wrong sign: {}. Positive driver's torque turns the wheel towards positive angles, "
      "positive "
      "motor torque turns it back; if the log is written otherwise, use --sign {}, or leave that out if it is given; "
      "{}",
      channels, both ? "" : "s", turned, option, may_be_reaction(no_driver ? "torque_motor" : "torque_driver"));
}

/// What the bar or the rim reads, Nm.
const std::vector<double>& readings(const Record& record, std::uint8_t transducer) {
  return transducer == kTorqueBarValid ? record.torque_bar_nm : record.torque_rim_nm;
}

/// A driver's own torque that is, to the noise, what a transducer beside it reads.
std::string copied_words(const Record& record) {
  constexpr double kOneSignal = 0.999;
  for (const std::uint8_t other : {kTorqueBarValid, kTorqueRimValid}) {
    if (!record.has(other)) continue;
    if (smoothed_correlation(record, record.torque_driver_nm, readings(record, other)) < kOneSignal) continue;
    return fmt::format(
        "torque_driver and {} are one signal: no transducer reads the driver's own torque, so record "
        "without torque_driver, or name no column for it",
        channel_name(other));
  }
  return "";
}

bool reads_one_value(const std::vector<double>& channel) {
  return std::ranges::adjacent_find(channel, std::ranges::not_equal_to()) == channel.end();
}

/// A transducer that reads one value while the angle changes: an arm that is turned pulls at it.
std::string silent_words(const Record& record) {
  if (reads_one_value(record.angle_rad)) return "";
  for (const std::uint8_t one : {kTorqueBarValid, kTorqueRimValid}) {
    if (!record.has(one) || !reads_one_value(readings(record, one))) continue;
    return fmt::format(
        "{} is {:g} Nm in every row while the angle changes: nothing reads this transducer, or its resolution hides "
        "all torque; look at its wiring, or name the column that has its torque",
        channel_name(one), readings(record, one).front());
  }
  return "";
}

/// Of a record whose driver's own torque is known: whether its torques are what their channels say.
void look_at_torques(const Record& record, bool inertia, bool torque_offset, FirstLook& look) {
  look.doubt = copied_words(record);
  const TorquePair pair = record.equation() == Equation::kDriverMotor ? torque_pair(record) : TorquePair{};
  const bool wheel_alone =
      pair.verdict == TorquePair::Verdict::kRimAndBar || pair.verdict == TorquePair::Verdict::kBarAndRim;
  if (wheel_alone) look.doubt = pair_words(pair);
  if (!look.doubt.empty()) return;
  const SignCheck signs = check_signs(record, torque_offset);
  const bool alone = no_driver(record);
  if (signs.doubtful()) {
    look.doubt = sign_words(signs, pair, alone);
  } else if (!inertia && signs.unexplained > kHardlyAnything && shows_inertia(fit_with_offset(turned_round(record)))) {
    look.notes.push_back(fmt::format(
        "with the torque turned round this record shows an inertia, as it stands it does not: if positive torque is to "
        "turn the wheel towards positive angles, use --sign -1; {}",
        may_be_reaction(alone ? "torque_motor" : "torque_driver")));
  } else if (signs.unexplained > kHardlyAnything) {
    look.misfit = fmt::format(
        "no wheel explains more than {:.3g} % of this record's angle, whichever way its torques are "
        "turned: what follows "
        "is worth little. Are columns and units right, and is all torque in the log?",
        100 * (1 - signs.unexplained));
    if (const std::string words = pair_words(pair); !words.empty()) look.notes.push_back(words);
  }
}

/// Of a record whose driver moves the wheel by a torque that nobody measured: a sensor that is turned round makes an
/// arm of negative inertia, damping and stiffness. Without a probe so does a driver who steers.
void look_at_turned(const Record& record, FirstLook& look) {
  constexpr double kSure = 4;  // standard deviations: one record in thirty thousand by chance
  const InstrumentalFit fit = fit_by_instrument(record);
  const auto negative = [](const FittedParameter& p) { return p.value < -kSure * p.sd; };
  if (!fit.by_probe || !negative(fit.inertia) || !(negative(fit.damping) || negative(fit.stiffness))) return;
  look.doubt = turned_words(record.equation(), fit);
}

/// Of a car's record.
void look_at_sensors(const Record& record, FirstLook& look) {
  if (record.has(kTorqueBarValid) && record.has(kTorqueRimValid)) {
    const WheelBetween wheel = wheel_between(record);
    (contradicts(wheel) ? look.doubt : look.notes.emplace_back()) = wheel_words(wheel);
  }
  if (look.doubt.empty() && !voluntary_torque_known(record.equation())) look_at_turned(record, look);
}

}  // namespace

std::string no_wheel_words(const PortUnits& units) {
  return fmt::format(
      "this is no steering wheel; the firmware counts its torque in {:g} Nm and its angle in {:g} rad, and tells no "
      "driver's state",
      units.torque_nm, units.angle_rad);
}

FirstLook first_look(const Record& record, std::optional<bool> torque_offset) {
  FirstLook look;
  look.torque_offset = torque_offset.value_or(false);
  look.doubt = silent_words(record);
  if (!look.doubt.empty()) return look;
  if (!voluntary_torque_known(record.equation())) {
    look_at_sensors(record, look);
    return look;
  }
  const BatchFit fit = fit_with_offset(record);
  const bool inertia = shows_inertia(fit);
  const bool a_car = record.has(kTorqueBarValid) || record.has(kTorqueRimValid);
  if (inertia && !a_car) look.units = port_units_for(record, fit.inertia.value);
  look_at_torques(record, inertia, torque_offset.value_or(true), look);
  look_at_sensors(record, look);
  if (!torque_offset && fit.torque_offset && std::abs(fit.torque_offset->value) > kOffsetInSd * fit.torque_offset->sd) {
    look.torque_offset = true;
    look.notes.push_back(fmt::format(
        "a constant torque of {:.3g} +- {:.2g} Nm acts on this machine; the batch fit and the free runs allow for it "
        "(--torque-offset no forbids that)",
        fit.torque_offset->value, fit.torque_offset->sd));
  }
  return look;
}

}  // namespace steerid
