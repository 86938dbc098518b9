// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/channel_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace steerid {
namespace {

std::string motion(const MotionFit& fit, double sign) {
  return fmt::format("J {:.3g} kg m2, B {:.2g} Nms/rad", sign * fit.inertia.value, sign * fit.damping.value);
}

/// The transducer of a car's record.
const char* transducer_name(Equation equation) {
  return channel_name((channels_of(equation) & kTorqueBarValid) != 0 ? kTorqueBarValid : kTorqueRimValid);
}

}  // namespace

std::string equation_words(Equation equation) {
  switch (equation) {
    case Equation::kNone:
      return "none";
    case Equation::kDriverMotor:
      return "T_driver - T_motor = J th'' + B th' + C th: arm and wheel";
    case Equation::kDriverBar:
      return "T_driver - T_bar = J th'' + B th' + C th: arm and wheel, above the torsion bar";
    case Equation::kDriverRim:
      return "T_driver - T_rim = J th'' + B th' + C th: the arm alone";
    case Equation::kBar:
      return "Tv - T_bar = J th'' + B th' + C th, Tv not measured: arm and wheel, above the torsion bar";
    case Equation::kRim:
      return "Tv - T_rim = J th'' + B th' + C th, Tv not measured: the arm alone";
  }
  return "unknown";
}

std::string pair_words(const TorquePair& pair) {
  const auto alone = [&](double sign, const char* driver_is, const char* motor_is) {
    return fmt::format(
        "torque_driver and torque_motor have the wheel alone between them ({}, no stiffness): these are {} and {}; "
        "name "
        "them so with --columns torque_rim=COLUMN,torque_bar=COLUMN",
        motion(pair.between, sign), driver_is, motor_is);
  };
  switch (pair.verdict) {
    case TorquePair::Verdict::kAsNamed:
      return "";
    case TorquePair::Verdict::kRimAndBar:
      return alone(1, "the hand's torque on the rim", "the torsion bar");
    case TorquePair::Verdict::kBarAndRim:
      return alone(-1, "the torsion bar", "the hand's torque on the rim");
    case TorquePair::Verdict::kReaction:
      return fmt::format(
          "torque_driver is what an arm ({}, C {:.3g} Nm/rad) answers the wheel's motion with, not what moves it: give "
          "the reading of a torsion bar as --columns torque_bar=COLUMN, that of a rim transducer as torque_rim=COLUMN; "
          "only a driver's own torque that is written the other way round needs --sign torque_driver=-1",
          motion(pair.between, 1), pair.between.stiffness.value);
    case TorquePair::Verdict::kBarAndMotor:
      return "torque_driver and torque_motor answer each other as a torsion bar, or a rim transducer, and the motor "
             "below it do: name the first --columns torque_bar=COLUMN, or torque_rim=COLUMN, and the motor needs no "
             "sign; only where torque_driver is the driver's own torque is torque_motor written the other way round, "
             "--sign torque_motor=-1";
  }
  return "";
}

std::string may_be_reaction(std::string_view channel) {
  return fmt::format(
      "where {} is the reading of a torsion bar or of a rim transducer, name it so instead, --columns "
      "torque_bar=COLUMN or torque_rim=COLUMN: there the driver's own torque may be unknown",
      channel);
}

std::string turned_words(Equation equation, const InstrumentalFit& fit) {
  const bool bar = (channels_of(equation) & kTorqueBarValid) != 0;
  const char* channel = transducer_name(equation);
  return fmt::format(
      "{} makes an arm of J {:.3g} kg m2, B {:.3g} Nms/rad, C {:.3g} Nm/rad, as one that is turned round does: it has "
      "to "
      "be positive when {}; if it is written otherwise, use --sign {}, or --sign angle where that is",
      channel, fit.inertia.value, fit.damping.value, fit.stiffness.value,
      bar ? "the driver turns counter-clockwise against the column" : "the hand turns the rim counter-clockwise",
      channel);
}

std::string driving_words(const Record& record) {
  if (voluntary_torque_known(record.equation())) return "";
  return fmt::format(
      "the simulation is driven by {} alone: what a driver does of his own is in no column; a little of "
      "it, and slow, counts as unmeasured_torque",
      transducer_name(record.equation()));
}

std::string own_torque_words(const Record& record) {
  if (voluntary_torque_known(record.equation())) return "";
  const InstrumentalFit fit = fit_by_instrument(record);
  if (fit.rows == 0) return "";
  return fmt::format(
      "of {}'s power below 2 Hz {:.0f} % is more than an arm answers the motion with, as a driver's own torque is, "
      "which is in no column: where that is much, record an arm at rest or a wheel without hands while the EPS plays "
      "a probe, or use `steerid identify`, which goes by the probe alone",
      transducer_name(record.equation()), 100 * std::min(fit.unexplained_share, 1.0));
}

bool contradicts(const WheelBetween& wheel) {
  using Verdict = WheelBetween::Verdict;
  return wheel.verdict == Verdict::kSame || wheel.verdict == Verdict::kSwapped || wheel.verdict == Verdict::kOpposed;
}

std::string wheel_words(const WheelBetween& wheel) {
  const std::string gain = fmt::format("{:.3g} +- {:.2g}", wheel.gain.value, wheel.gain.sd);
  switch (wheel.verdict) {
    case WheelBetween::Verdict::kUnknown:
      return "the wheel between torque_rim and torque_bar moves too little to be identified, and the two sensors to be "
             "compared";
    case WheelBetween::Verdict::kAgree:
      return fmt::format("torque_rim and torque_bar agree (gain {}), with the wheel alone between them: {}", gain,
                         motion(wheel.fit, 1));
    case WheelBetween::Verdict::kSame:
      return "torque_rim and torque_bar are one and the same signal: leave one of the two out, or name the other's "
             "column with --columns torque_rim=COLUMN";
    case WheelBetween::Verdict::kSwapped:
      return fmt::format(
          "the wheel between torque_rim and torque_bar would have a negative inertia, {:.3g} kg m2: the one is the "
          "other, swap them with --columns torque_rim=COLUMN,torque_bar=COLUMN; or both are negative when the driver "
          "turns counter-clockwise, then use --sign torque_rim,torque_bar",
          wheel.fit.inertia.value);
    case WheelBetween::Verdict::kOpposed:
      return fmt::format(
          "torque_rim and torque_bar go opposite ways (gain {}): turn the one round that is negative when the driver "
          "turns counter-clockwise, --sign torque_bar or --sign torque_rim",
          gain);
    case WheelBetween::Verdict::kDisagree:
      return fmt::format(
          "torque_rim and torque_bar do not agree (gain {}, and between them J {:.3g} kg m2, B {:.2g} Nms/rad, C "
          "{:.2g} "
          "Nm/rad, which is no wheel alone): calibrate one of them, or record without it",
          gain, wheel.fit.inertia.value, wheel.fit.damping.value, wheel.fit.stiffness.value);
  }
  return "";
}

}  // namespace steerid
