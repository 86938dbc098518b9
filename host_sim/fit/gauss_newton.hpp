// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Batch identification of J, B and C: output error by Gauss-Newton, section III of Lv et al. 2018.
//
//   minimise f(x) = r'r/2,  r = measured angle - free run of J th'' + B th' + C th = T_driver - T_motor     (6), (7)
//   step     J'J p = -J'r,  x <- x + alpha p                                                               (11), (12)
//   alpha    1, halved until f falls by at least 1e-4 of what the slope promises (Armijo, (15)); J > 0 is kept by never
//            going more than nine tenths of the way to zero. The curvature condition |grad f(x + alpha p)' p| <=
//            0.9 |grad f(x)' p|, the other half of Wolfe's (18), is checked at every step and reported.
//   stop     when every column of the Jacobian is orthogonal to the residual to 1e-7 in cosine: a scale-free gradient
//            test (More 1980), which leaves less than 1e-4 standard deviations to go.
// Every sensitivity is analytic (plant/linear_response.hpp). Unknowns besides J, B, C: the angle and rate at the start
// of each gap-free segment, and on request a constant torque offset.
//
// Noise. `kWhite` is the paper's: equal weights. By default the residual's colour is estimated from the fit's own
// residual (fit/residual_colour.hpp: sensor noise and slow torque through the wheel, a free autoregression where there
// is more), residual and Jacobian are whitened with it, and the fit repeated until it settles: with torque noise and a
// driver's unmeasured slow torque that is what reaches the Cramer-Rao bound, and what makes sd a standard deviation.
// The recorded torque's own noise also enters the model's input; the bias that makes is the ratio of its spectral
// density to the torque's, below 1e-3 of the value for the cases tested.
//
// What the answer is worth. A parameter is kValid when its sd is at most a quarter of its value; else kNotExcited: the
// record does not say. A B or C that is negative by more than 1.96 sd cannot be noise: `model_misfit` is set and the
// parameter is not valid either. A model that lacks an effect (dry friction, say) leaves a residual that is larger and
// slower than noise, which the coloured covariance charges to the parameters.
//
// An inertia whose damping is not seen beside it may be a line in the noise that an undamped wheel rings along with,
// with a very small standard deviation. It is tried (inertia_limit.hpp), and when it is one J is kNotExcited; what the
// record does say is the largest J that it allows, `at_most`.
//
// Torque offset: off by default, because the steering contract has none and because a constant torque cannot be told
// from a constant angle. Real machines have one (a motor's current offset, gravity on an imperfectly balanced arm, a
// joint held off its zero): without it C, or J and B where C is small, take the blame.
//
// Cost of a 60 s record at 100 Hz, CPU time on a busy machine: 3 ms white, 9 to 13 ms coloured (tests/bench/fit_bench);
// at 1 kHz 0.04 and 0.3 s.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "fit/autoregression.hpp"
#include "fit/certainty.hpp"
#include "log/record.hpp"
#include "plant/linear_response.hpp"
#include "plant/torque_signal.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

struct FitOptions {
  enum class Noise {
    kWhite,           ///< all residuals weigh the same (the paper)
    kAutoregressive,  ///< the residual's colour is estimated and whitened
  };
  TorqueSignal::Between between = TorqueSignal::Between::kBandLimited;
  Noise noise = Noise::kAutoregressive;
  int ar_max_order = 0;              ///< of the free one; 0: as many samples as 0.3 s hold, 30 at 100 Hz
  bool torque_offset = false;        ///< also identify a constant torque
  std::optional<WheelArm> start;     ///< without it the fit finds its own, by state-variable-filter least squares
  int max_iterations = 50;           ///< of each Gauss-Newton run
  double gradient_tolerance = 1e-7;  ///< largest cosine between residual and a column of the Jacobian
  double valid_relative_sd = 0.25;   ///< sd / |value| up to which a parameter is called valid
  bool convergence_factor = true;    ///< equation 27; costs three more free runs
  bool inertia_limit = false;        ///< the largest J that the record allows, when it does not show J; costs 20 runs
};

/// Why the last Gauss-Newton run ended.
enum class StopReason : std::uint8_t {
  kGradient,        ///< the scaled gradient vanished: a minimum
  kExact,           ///< the residual is no more than rounding: there is nothing left to fit (a simulated record)
  kNoDescent,       ///< no step length lowers f: converged to rounding, or a direction lost to it
  kIterationLimit,  ///< max_iterations; the answer is the best so far
  kNoData,          ///< no gap-free segment is long enough, or the angle or torque never changes; nothing was fitted
};
const char* name(StopReason reason);

struct FitSegment {
  std::size_t first = 0;  ///< index of its first sample in the record
  std::size_t last = 0;
  WheelState initial;
};

struct BatchFit {
  FittedParameter inertia;
  FittedParameter damping;
  FittedParameter stiffness;
  std::optional<FittedParameter> torque_offset;
  Eigen::MatrixXd covariance;  ///< of J, B, C (and the offset); initial states marginalised

  StopReason stop = StopReason::kNoData;
  int iterations = 0;        ///< Gauss-Newton steps over all runs
  double gradient = 0;       ///< largest cosine at the end
  bool curvature_ok = true;  ///< Wolfe's curvature condition held at every step
  Excitation excitation;
  std::optional<double> convergence_factor;  ///< ||[J'J]^-1 H|| (27), in the norm of J'J, where units drop out
  Autoregression noise;                      ///< of the residual
  double noise_sd_rad = 0;                   ///< of the white innovations behind it

  std::vector<FitSegment> segments;
  std::vector<double> angle_model_rad;  ///< one a sample of the record; NaN where it was not used
  std::vector<double> residual_rad;     ///< measured - model, likewise

  [[nodiscard]] WheelArm wheel() const { return {inertia.value, damping.value, stiffness.value}; }
};

BatchFit fit_batch(const Record& record, const FitOptions& options = {});

}  // namespace steerid
