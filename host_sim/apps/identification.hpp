// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What `steerid identify` found in a record, whichever method found it, and what follows from it in closed form.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "fit/channel_check.hpp"
#include "fit/instrumental_fit.hpp"
#include "port/equation.hpp"
#include "port/estimate.hpp"

namespace steerid {

/// One identified parameter in the unit of its field's name; `sd` is one standard deviation, infinite when unknown.
struct IdentifiedParameter {
  double value = 0.0;
  double sd = std::numeric_limits<double>::infinity();
  ParameterState state = ParameterState::kStarting;
  std::optional<double> at_most = {};  ///< where the record shows no value but an upper limit
};

struct Identification {
  /// "recursive", "batch_gauss_newton", "batch_instrumental_variables", or without a probe "batch_by_torque_alone"
  std::string method;
  Equation equation = Equation::kDriverMotor;  ///< what J, B and C belong to
  std::optional<WheelBetween> wheel = {};      ///< of a record with torque_rim and torque_bar
  IdentifiedParameter inertia_kgm2;
  IdentifiedParameter damping_nms_per_rad;
  IdentifiedParameter stiffness_nm_per_rad;
  /// How much of the measured amplitude curve (up to 5 Hz) the model explains; nothing when the record has no curve.
  std::optional<double> amplitude_fit_percent;
  /// rms(angle - free-run angle) / std(angle) over the whole record; nothing when the free run diverges.
  std::optional<double> free_run_nrmse;
  /// Where the driver's own torque is not measured, in place of the two above: how well the arm explains what the probe
  /// has driven; nothing without a probe, or without an arm.
  std::optional<DrivenPart> driven = {};
  /// Dry friction of the wheel above the torsion bar, Nm: of a record whose wheel nobody holds, by the batch fit.
  std::optional<FittedNumber> friction_nm = {};
  /// Where the driver's own torque is not measured, by the batch fit: rms of the torque below 6.6 Hz that no sensor
  /// explains, mostly the driver's own.
  std::optional<double> unmeasured_torque_nm = {};
  std::string doubt;  ///< why none of it is credible; empty when there is no reason
};

/// What the firmware published, `unit` times the port's micro-units. A deviation at the end of its range stands for "at
/// least that": unknown.
IdentifiedParameter from_published(const ParameterEstimate& published, double unit = 1.0);

/// What is said about the natural frequency that an answer implies.
struct FrequencyAnswer {
  std::optional<double> hz;
  std::string reason;                   ///< why there is none; empty when `hz` holds a value
  std::optional<double> damping_ratio;  ///< nothing unless J, B and C are known, J and C above zero
};

/// The natural frequency of the identified arm (plant/wheel_arm.hpp). It has none either when a parameter that it needs
/// was not identified, or when C is within two standard deviations of zero: a frequency made from that would be noise.
FrequencyAnswer frequency_answer(const Identification& found);

/// True when the value comes from the record rather than from the prior.
constexpr bool is_identified(ParameterState state) {
  return state != ParameterState::kStarting && state != ParameterState::kNotExcited;
}

}  // namespace steerid
