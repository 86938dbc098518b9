// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How a free run moves with the numbers of a wheel and its effects, without running it: on the measured motion.
//
// On that motion (gap/model/spectral_model.hpp) an effect's torque stays what it is when a number changes. In a run the
// motion changes with the number, and the torque with the motion. To first order, where f(acceleration, rate, angle, t)
// is the torque,
//
//   (J - df/dacceleration) d'' + (B - df/drate) d' + (C - df/dangle) d = -(a dJ + v dB + q dC) + df
//
// a linear wheel whose numbers change in time, driven by what a change of a number does on the motion (the output
// error's sensitivity: Ljung, System Identification, 1999, section 10.3). It is solved sample by sample (Newmark's mean
// acceleration, which never diverges by itself: half a percent to 2 % of a slope). Without it a drag that takes several
// times what the damping takes leads a fit nowhere. Where a part's torque depends on more than the moment, or changes
// the response, derivatives are those on the measured motion. Costs five torques a part, seven where one knows the
// acceleration, and a torque of all and a transform a number.
#pragma once

#include "gap/model/spectral_model.hpp"

namespace steerid::gap {

class RunSlopes {
 public:
  /// `record`'s motion should be near the run's.
  RunSlopes(const SpectralRecord& record, Parts parts);

  /// See Slopes.
  [[nodiscard]] std::vector<Spectrum> at(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted);

 private:
  /// What the parts do together on a motion.
  [[nodiscard]] std::vector<double> torque_nm(const Point& at, const MeasuredMotion& motion) const;
  /// What of it is lost along a channel of the motion, per unit: an inertia, a damping, or a stiffness.
  [[nodiscard]] std::vector<double> lost_along(const Point& at, std::vector<double> MeasuredMotion::*channel) const;
  /// That of acceleration, rate and angle; without `inertia` where no part knows the acceleration.
  struct Lost {
    std::vector<double> inertia;
    std::vector<double> damping;
    std::vector<double> stiffness;
  };
  /// d for one driving torque, one value a sample.
  [[nodiscard]] std::vector<double> moved(const WheelArm& wheel, const Lost& lost,
                                          const std::vector<double>& driving_nm) const;

  const SpectralRecord& record_;
  Parts parts_;
  SpectralModel on_motion_;
  bool momentary_ = false;  // all of them are, and at least one depends on the motion
};

}  // namespace steerid::gap
