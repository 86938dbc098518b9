// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The wheel's motion as measured, with its rate and acceleration: what effects that depend on the motion are evaluated
// on.
//
// Differentiating the measured angle would differentiate its noise. Here the free run of the refitted wheel carries the
// motion, exactly and free of noise, and only what the measurement has beyond it is smoothed: a centred Gaussian
// kernel, no phase, -3 dB at kSmoothing_hz.
#pragma once

#include <span>
#include <vector>

#include "log/record.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

inline constexpr double kSmoothing_hz = 6.0;

struct MeasuredMotion {
  std::vector<double> time_s;  ///< the record's stamps: since its origin
  std::vector<double> angle_rad;
  std::vector<double> rate_rad_s;
  std::vector<double> acceleration_rad_s2;

  [[nodiscard]] double length_s() const { return time_s.back() - time_s.front(); }
};

/// `wheel` should be the best linear fit. One value a sample; across gaps nothing is smoothed.
[[nodiscard]] MeasuredMotion measured_motion(const Record& record, const WheelArm& wheel);

/// -3 dB of the smoothing beyond the run of a wheel that has the effects: less is left there, and less of it slow.
inline constexpr double kSmoothingBeyondRun_hz = 10.0;

/// The same with a run in the linear wheel's place, one angle a sample; as in `otherwise` where the run has a sample
/// that is not finite. Beyond the run it is -3 dB at `smoothing_hz`.
[[nodiscard]] MeasuredMotion motion_carried_by(const Record& record, std::span<const double> run_rad,
                                               const MeasuredMotion& otherwise,
                                               double smoothing_hz = kSmoothingBeyondRun_hz);

/// The centred Gaussian low pass used above, -3 dB at `cutoff_hz`, over a signal with one value a sample.
[[nodiscard]] std::vector<double> smoothed(const std::vector<double>& signal, double rate_hz, double cutoff_hz);

}  // namespace steerid::gap
