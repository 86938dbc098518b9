// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The record with the motion that a simulation's own free run carries.
//
// What an effect does on the measured motion (gap/hypotheses/hypothesis.hpp) is known as well as that motion. At first
// the refitted linear wheel's run carries it (gap/hypotheses/measured_motion.hpp). Where an effect is strong that run
// is far from the record, and what the wheel does beyond it, above the smoothing's limit, is lost. The run of a wheel
// that has the effect is near: what is left to be smoothed is what nobody simulates, a slow torque and noise. On that
// motion a fit is as exact as by free runs, and knows besides where the slow torque took the wheel
// (docs/adr/0015).
#pragma once

#include "gap/model/simulated_model.hpp"
#include "gap/model/spectral_model.hpp"

namespace steerid::gap {

/// `record` with the motion carried by `model`'s run; as it was where that run diverges, or begins anew at every
/// block. Costs a run and a few passes over the record.
[[nodiscard]] SpectralRecord carried_record(const SpectralRecord& record, SimulatedModel& model, const Point& at,
                                            double smoothing_hz = kSmoothingBeyondRun_hz);

}  // namespace steerid::gap
