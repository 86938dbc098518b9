// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a simulation that only shows its prediction has in it.
//
// Any simulator can be diagnosed that is given a record's torques and answers with an angle. What it answers is a
// record of a wheel of its own: diagnosed against the linear wheel that fits it best, what that one lacks is what the
// simulator has, and J, B, C and the effects are known as a record tells them. A torque that nobody measured is none of
// these: a prediction follows from the record's torques, and what it has besides is its remainder.
//
// A formula's angle has no noise, and what two simulations make differently of one law, a ten-thousandth of the angle,
// would pass for an effect of its own. A third of the record's noise is therefore added to it: differences that the
// record cannot show are none, and what is known of the simulator adds a twentieth to the deviations that the record
// itself leaves.
#pragma once

#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "log/record.hpp"
#include "plant/simulation.hpp"

namespace steerid::gap {

struct PredictedSimulation {
  Simulation simulation;
  Diagnosis found;                ///< of the prediction against a linear wheel
  double prediction_nrmse = 0;    ///< rms(measured - prediction)/std(measured), the whole record
  double missed_nrmse = 0;        ///< rms(prediction - simulation's free run)/std(prediction), likewise
  PredictionRemainder remainder;  ///< for the diagnosis of the record: what that is, or nothing
};

/// `predicted_rad`: one angle a sample of `record`. Throws BadInput where the prediction cannot tell anything.
[[nodiscard]] PredictedSimulation predicted_simulation(const Record& record, const std::vector<double>& predicted_rad,
                                                       const DiagnoseOptions& options);

}  // namespace steerid::gap
