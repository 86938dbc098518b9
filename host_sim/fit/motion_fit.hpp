// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which motion a torque goes with: least squares in the torque itself.
//
//   torque = J th'' + B th' [+ C th] + constant [+ gain * another torque]
//
// All signals pass the same Gaussian of 30 ms (about 5 Hz) and its derivatives, so that differentiating does not drown
// in the angle's noise and no delay is invented. What noise is left in th'' would pull J towards zero: its part in the
// normal equations is known from the angle's sixth differences, and is taken off. Nothing is said of who moves whom:
// that is right where all of the torque goes into this motion, as between two torque sensors on either side of a wheel,
// and only there; an arm whose driver steers needs more (docs/theory.md). Standard deviations allow for what the
// Gaussian makes of the noise, which is taken as white.
//
// Record at 100 Hz; stretches between gaps shorter than 0.4 s are left out. Cost: 3 us a sample.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "log/record.hpp"

namespace steerid {

struct FittedNumber {
  double value = 0;
  double sd = 0;

  /// Further from zero than chance takes it.
  [[nodiscard]] bool shown() const { return value * value > 16 * sd * sd; }
};

struct MotionFit {
  FittedNumber inertia;        ///< kg m2
  FittedNumber damping;        ///< Nms/rad
  FittedNumber stiffness;      ///< Nm/rad
  FittedNumber gain;           ///< of the other torque; 0 without one
  double explained = 0;        ///< share of the torque's power about its mean, of the smoothed one
  double torque_rms_nm = 0;    ///< of the smoothed one about its mean
  double residual_rms_nm = 0;  ///< of what stays unexplained
  std::size_t samples = 0;     ///< 0: nothing to fit
};

/// `torque_nm` and `beside_nm`, which may be empty, have a value for each sample.
[[nodiscard]] MotionFit fit_motion(const Record& record, std::span<const double> torque_nm, bool spring = true,
                                   std::span<const double> beside_nm = {});

/// 2 sqrt(pi) times the 3 samples of the Gaussian: behind it so many samples are as good as one.
inline constexpr double kSamplesAlike = 10.6;

/// The torque whose motion says the most: on the wheel alone where rim and bar tell it, else on what is identified.
[[nodiscard]] std::vector<double> explained_torque_nm(const Record& record);

/// The angle's rate behind the same Gaussian, rad/s, a value for each sample; 0 where its taps reach beyond a stretch.
[[nodiscard]] std::vector<double> smoothed_rate_rad_s(const Record& record);

/// Correlation of two channels after the same smoothing, -1 to 1; 0 when one of them stands still.
[[nodiscard]] double smoothed_correlation(const Record& record, std::span<const double> one,
                                          std::span<const double> other);

}  // namespace steerid
