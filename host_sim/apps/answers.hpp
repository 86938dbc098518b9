// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The two answers of `steerid identify` to one record at 100 Hz, each with the free run that shows what it is worth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/firmware_run.hpp"
#include "apps/identification.hpp"
#include "fit/amplitude_fit.hpp"
#include "fit/gauss_newton.hpp"
#include "fit/instrumental_fit.hpp"
#include "fit/model_check.hpp"
#include "fit/wheel_friction.hpp"
#include "log/record.hpp"

namespace steerid {

/// An answer, the model's own run on the record's torques (NaN where it was not used) and figure 7's curves.
struct Answer {
  Identification found;
  std::vector<double> free_run_rad;
  AmplitudeCurves curves;
};

/// The last estimate of the firmware. Its free run starts each gap-free stretch from the angle and rate that suit it
/// best, since the firmware estimates neither; `torque_offset` grants it a constant torque that suits best as well.
/// Where the driver's own torque is not measured a free run would lack it: there it is held against what the probe has
/// driven (fit/instrumental_fit.hpp).
Answer recursive_answer(const Record& record, const FirmwareRun& run, bool torque_offset);

/// What an answer becomes when its record is not credible (FirstLook::doubt): no value, every parameter `fault`.
void refuse(Identification& found, const std::string& doubt);

/// Widens a deviation by another one. What was valid and is then not known to a quarter of itself becomes `otherwise`.
void widen(IdentifiedParameter& parameter, double by, ParameterState otherwise);

/// Widens the deviations of J, B and C by what noise on the torque may have put on them: a fit of the angle takes the
/// torque for exact and states neither. A parameter whose deviation is then more than a quarter of it is `not excited`.
void widen(Identification& found, const ModelCheck& check);

/// Of the whole record at once: output-error Gauss-Newton (fit/gauss_newton.hpp), and where the driver's own torque is
/// not measured instrumental variables (fit/instrumental_fit.hpp), which grant a constant torque in any case; that fit
/// is in `bare` already where nobody holds a wheel with dry friction.
Answer batch_answer(const Record& record, bool torque_offset, const std::optional<BareWheelFit>& bare = {});

}  // namespace steerid
