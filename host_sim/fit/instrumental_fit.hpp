// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Batch identification of J, B and C where the driver's own torque is not measured: refined instrumental variables.
//
//   torque = J th'' + B th' + C th + constant + v                    (fit/instrumented_rows.hpp)
//
// v, the driver's torque, has moved the wheel: least squares of a torsion bar on the motion finds what lies below the
// bar. The instrument z, the motion that the probe has caused, is independent of v, so that
//
//   p = (Z' Phi)^-1 Z' y,   covariance s^2 (Z' Phi)^-1 Z' Z (Phi' Z)^-1
//
// is consistent whatever the driver does (Soderstrom and Stoica, Instrumental Variable Methods for System
// Identification, 1983). It is efficient when all rows are whitened by the spectrum of v (Young 1976, refined
// instrumental variables): an autoregression of what is left unexplained, order by AICc, found anew until p stands.
// The variance is then that of the best estimate that knows v's spectrum and nothing but the probe to go by.
//
// Without a probe the torque itself is the source. That is right where the driver's hands rest; otherwise a share a of
// the motion is the driver's, in which the torque answers as the column -Pc does, not as the arm P: the estimate is off
// by a (1 + Pc/P) of its value, and the root of the share of the torque that stays unexplained is larger than that as
// long as a is small. So sd holds that root beside chance, and a record is valid only where it shows itself that there
// was hardly any driver. The share is taken below 2 Hz: above, drivers do next to nothing, and sensors' noise counts.
//
// An arm that changes has no J, B, C that hold: what it leaves unexplained widens sd, and varying_arm.hpp follows it.
//
// Cost: less than 10 ms for 30 s of record.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "fit/autoregression.hpp"
#include "fit/certainty.hpp"
#include "fit/instrumented_rows.hpp"
#include "log/record.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

struct InstrumentalFit {
  static constexpr int kLongestNoise = 12;  ///< order of the autoregression at most: half a second

  FittedParameter inertia;
  FittedParameter damping;
  FittedParameter stiffness;
  double constant_nm = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of J, B, C, by chance alone

  bool by_probe = false;      ///< the probe is the instrument; otherwise the torque is
  bool settled = false;       ///< the whitening filter stands still
  double unexplained_nm = 0;  ///< rms of v below 6.6 Hz: mostly the driver's own torque
  double unexplained_share =
      0;                 ///< of the torque's power below 2 Hz; may exceed 1 where the driver holds against the bar
  Autoregression noise;  ///< of v, at InstrumentedRows::kRowsPerS
  double noise_nm = 0;   ///< rms of its innovations
  std::size_t rows = 0;  ///< 0: nothing to fit
  Eigen::Matrix4d driven = Eigen::Matrix4d::Zero();  ///< products of torque, th'', th', th as far as the probe drives
};

/// How well an arm explains what the probe alone has caused: rms(torque - J th'' - B th' - C th) of the probe-driven
/// parts over that of the torque, weighted by what v covers. A run of the whole record says nothing where v is missing.
struct DrivenPart {
  double nrmse = 0;
  double by_noise = 0;  ///< what v makes of it even for the right arm
};

/// Nothing without a probe, or when it has driven nothing.
[[nodiscard]] std::optional<DrivenPart> driven_part(const InstrumentalFit& fit, const WheelArm& arm);

/// `record` is at 100 Hz. `valid_relative_sd`: sd over value up to which a parameter is called valid.
[[nodiscard]] InstrumentalFit fit_by_instrument(const Record& record, double valid_relative_sd = 0.25);
[[nodiscard]] InstrumentalFit fit_by_instrument(const InstrumentedRows& rows, double valid_relative_sd = 0.25);

}  // namespace steerid
