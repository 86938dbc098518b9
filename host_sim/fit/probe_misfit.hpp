// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether an arm explains what the probe has driven, where the driver's own torque is not measured: what a free run
// against the angle is elsewhere.
//
// The probe drives torque and motion through eight functions of it (fit/instrumented_rows.hpp), and J, B and C are
// three numbers: five combinations are left that have to be noise. Their power over the noise's is chi-square with five
// degrees of freedom when the model is right (Sargan 1958, Econometrica 26: the test of overidentifying restrictions).
// A sensor that is late or slow, dry friction, a second mass on the rim put the probe into them.
//
// The evidence is that of a model that has the five as free numbers: half of the power over the noise's, the gain in
// log likelihood, less Schwarz's price of five numbers, (5/2) log rows. What moves the arm and is imitated by another
// J, B and C is not told: a pure delay is, to first order, a smaller B and C.
//
// Whether the probe has driven anything at all is told in the same way: half of the power over the noise's of the
// torque that it has driven, less Schwarz's price of the eight numbers that say how it did.
#pragma once

#include <optional>

#include "fit/instrumental_fit.hpp"

namespace steerid {

struct ProbeMisfit {
  double driven_nats = 0;     ///< above zero: the probe has driven torque that stands out of the noise
  double nats = 0;            ///< above zero: something else than an arm answers the probe
  double share = 0;           ///< rms left of the torque that the probe has driven, over its rms
  double share_by_noise = 0;  ///< what noise makes of it for the right arm
};

/// Nothing without a probe.
[[nodiscard]] std::optional<ProbeMisfit> probe_misfit(const InstrumentalFit& fit);

/// Whether there is a probe, and it has driven torque that stands out of the noise.
[[nodiscard]] bool drives(const std::optional<ProbeMisfit>& probe);

}  // namespace steerid
