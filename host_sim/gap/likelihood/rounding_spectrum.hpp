// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What rounding an angle to a coarse step adds to the Fourier lines of a record's blocks.
//
// A rounded angle's error is white, of variance step^2/12, where the wheel moves by many steps from one sample to the
// next (Widrow and Kollar, Quantization Noise, 2008). A coarse one stays on a step for many samples: the error is a
// saw-tooth as slow as the wheel's way from step to step, and while the wheel rests a constant. Both stand in the lines
// below 12 Hz, up to a hundred times above the level that is read off where no wheel moves. The error follows from the
// motion alone, so that the motion of a simulation's run says what to expect. Where exactly within a step the wheel is
// no simulation knows: the mean over all places is taken.
#pragma once

#include <Eigen/Core>
#include <span>

#include "gap/likelihood/block_spectra.hpp"

namespace steerid::gap {

/// The expected power of the rounding's error, rad^2, one value a bin, as that of white noise of as large a variance a
/// sample would be. `motion_rad` has one angle a sample of the record, all finite.
[[nodiscard]] Eigen::VectorXd rounding_spectrum(const BlockSpectra& spectra, std::span<const double> motion_rad,
                                                double step_rad);

}  // namespace steerid::gap
