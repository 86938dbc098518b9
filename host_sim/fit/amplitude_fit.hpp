// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How well a model explains a record: in the frequency domain as in figure 7 of Lv et al. 2018, and in the time domain.
//
// Amplitude fit. Measured angle and model output (the free run on the measured torque) have their means removed, are
// weighted by a Hann window and Fourier transformed. Over the bins with 0 < f <= 5 Hz,
//   amplitude fit = 100 % (1 - sum | |Y| - |Yhat| | / sum |Y|),
// 100 % when the amplitudes agree in every bin, 0 % for a model that never moves; it can be negative. Each bin weighs
// by its amplitude, so that bins in which nothing happens do not decide. The paper quotes "over 97 %" without a
// formula; this is the plainest one that its figure shows. It does not see phase: the free-run error beside it does.
//
// Free-run NRMSE = rms(angle - free run) / std(angle).
//
// Samples are taken as equally spaced; of a record with gaps, the longest gap-free segment is used for the spectrum and
// all samples with a model value for the NRMSE. Cost: two FFTs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fit/gauss_newton.hpp"
#include "log/record.hpp"

namespace steerid {

/// The paper's "particular frequency range under 5 Hz, which covers the main working range of the system".
inline constexpr double kAmplitudeFitLimit_hz = 5.0;

struct AmplitudeCurves {
  std::vector<double> frequency_hz;  ///< from the first bin above zero up to the limit asked for
  std::vector<double> measured_rad;  ///< amplitude of a sine that would give this line
  std::vector<double> model_rad;
};

/// Single-sided amplitude spectra of two signals sampled every `period_s`; the same length, at least 8.
AmplitudeCurves amplitude_curves(std::span<const double> measured, std::span<const double> model, double period_s,
                                 double limit_hz = kAmplitudeFitLimit_hz);

/// The percentage defined above; nothing when the curves are empty or the angle never moves.
std::optional<double> amplitude_fit_percent(const AmplitudeCurves& curves, double limit_hz = kAmplitudeFitLimit_hz);

/// rms(measured - model) / std(measured) over the samples where both are finite; nothing when there are none or the
/// angle never moves.
std::optional<double> free_run_nrmse(std::span<const double> measured, std::span<const double> model);

struct ModelQuality {
  AmplitudeCurves curves;
  std::optional<double> amplitude_fit_percent;
  std::optional<double> free_run_nrmse;
};

/// All of it for a batch fit.
ModelQuality model_quality(const Record& record, const BatchFit& fit);

}  // namespace steerid
