// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The exact free run of J th'' + B th' + C th = T(t) under a torque that is a cubic polynomial between samples
// (plant/torque_signal.hpp): no integration error, so what is left between model and record is the model's fault.
//
// One step over dt is a matrix-vec product, [th, w](t + dt) = E(dt) [th, w](t) + G(dt) [c0 c1 c2 c3]. Everything in E
// and G follows from the impulse response g and its convolution q = g * g (L = J d2/dt2 + B d/dt + C):
//   free response from angle 1, rate 0   h1 = J g' + B g
//   free response from angle 0, rate 1   h2 = J g
//   response to the torque tau^k         k! times the (k+1)-fold integral of g
// g and q are summed as power series, which has no special case for C = 0, B = 0, underdamped, critical or overdamped
// wheels or a small negative C; a long dt is halved until the series converges quickly and the step is then doubled.
//
// Sensitivities. With z the answer of the same wheel to its own angle, J z'' + B z' + C z = th, z(0) = z'(0) = 0,
//
//   d th / d C      = -z                              (differentiate the equation: L dth = -th)
//   d th / d B      = -z' + z''(0) h2                 (L dth = -th';  z' solves it, but starts at rate z''(0))
//   d th / d J      = -z'' + z''(0) h1 + z'''(0) h2   (L dth = -th''; likewise)
//   d th / d th(0)  = h1
//   d th / d th'(0) = h2
//   d th / d offset = (1/J) integral of h2
//
//   with z''(0) = th(0)/J and z'''(0) = (th'(0) - B z''(0))/J.
//
// One augmented state [th, w, z, z', h2, h2'] therefore gives the angle and all sensitivities; see also Young,
// Recursive Estimation and Time-Series Analysis (2011), chapter 8, for the same use of a single prefilter.
//
// Cost, measured: 25 ns a sample for the angle with all sensitivities at equal spacing; where the spacing differs from
// sample to sample the matrices are rebuilt, some 400 ns each.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "plant/torque_signal.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

struct WheelState {
  double angle_rad = 0;
  double rate_rad_s = 0;
};

/// The step over one interval for the state [th, w, z, z'] and the torque's coefficients [c0 c1 c2 c3]. The wheel
/// alone is the upper left 2 x 2 block of `transition` and the upper two rows of `input`. J > 0; B and C any.
struct LinearStep {
  LinearStep(const WheelArm& wheel, double dt_s);
  /// The same for any linear system of four states, x' = rate x + push T.
  LinearStep(const Eigen::Matrix4d& rate, const Eigen::Vector4d& push, double dt_s);

  Eigen::Matrix4d transition;
  Eigen::Matrix4d input;
};

/// Columns of FreeRunSensitivities::by.
enum SensitivityColumn : int {
  kByInertia = 0,
  kByDamping = 1,
  kByStiffness = 2,
  kByInitialAngle = 3,
  kByInitialRate = 4,
  kByTorqueOffset = 5,
};
inline constexpr int kSensitivityColumns = 6;

struct FreeRunSensitivities {
  Eigen::VectorXd angle_rad;
  /// d angle_rad / d parameter, SI units; one row a sample.
  Eigen::Matrix<double, Eigen::Dynamic, kSensitivityColumns, Eigen::RowMajor> by;
};

/// The wheel's angle at `time_s` (strictly increasing) from `initial` at time_s.front(), under `torque` plus a
/// constant. Nothing is assumed about where the torque's own samples lie.
std::vector<double> free_run(const WheelArm& wheel, const TorqueSignal& torque, std::span<const double> time_s,
                             const WheelState& initial, double torque_offset_nm = 0);

/// The same, with the rates.
std::vector<WheelState> free_run_states(const WheelArm& wheel, const TorqueSignal& torque,
                                        std::span<const double> time_s, const WheelState& initial,
                                        double torque_offset_nm = 0);

/// The same, with the derivatives of every angle. Reuses the memory of `out`.
void free_run_sensitivities(const WheelArm& wheel, const TorqueSignal& torque, std::span<const double> time_s,
                            const WheelState& initial, double torque_offset_nm, FreeRunSensitivities& out);

}  // namespace steerid
