// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a simulation leaves of the record, as a torque and as a spectrum.
#pragma once

#include <optional>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/likelihood/noise_floor.hpp"
#include "gap/model/restarted_run.hpp"

namespace steerid::gap {

/// The torque that would explain measured minus simulated angle, J r'' + B r' + C r, low-passed at kSmoothing_hz.
[[nodiscard]] std::vector<double> residual_torque(const Record& record, const std::vector<RunStretch>& stretches,
                                                  const std::vector<double>& simulated_rad, const WheelArm& wheel);

/// Its variance when there is nothing but the floor's noise.
[[nodiscard]] double residual_torque_noise(const NoiseFloor& floor, const WheelArm& wheel);

/// Averaged over Hann-windowed pieces of 10 s (the whole record when it is shorter), half overlapping.
[[nodiscard]] ResidualSpectrum residual_spectrum(const Record& record, const std::vector<RunStretch>& stretches,
                                                 const GapSeries& series, const NoiseFloor& floor,
                                                 const WheelArm& wheel);

/// The band that holds most of what the spectrum has above the noise with all that is named; none where nothing is.
[[nodiscard]] std::optional<Unexplained::Band> band_of_rest(const ResidualSpectrum& spectrum);

}  // namespace steerid::gap
