// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The convergence theory of section III.C of Lv et al. 2018, measured on records of the experiment.
//
//   rate      near a minimum x* a step of unit length maps the error e to about -[J'J]^-1 H e (equations 21 to 26), so
//             that the factor a step gains is at most ||[J'J]^-1 H(x*)|| (27). Measured here without H: the step is
//             taken from x* + e and from x* - e, e of 1e-4 of x*, half the difference of the two ends is the linear
//             part, and repeating it with the result as the next e finds the slowest direction. Both in the norm of
//             J'J, where units drop out.
//   order     with H = 0 (a record without noise) convergence is quadratic: log e'/log e of successive errors tends to
//             2
//   angle     cos of the angle between step and steepest descent, the quantity of Zoutendijk's condition
//             that theorem 1 keeps away from zero (20), in relative units of J, B and C
//   basin     from which starting values J, C the iteration ends in x*: with steps of unit length (12), and with a line
//             search (15)
//   rank      equation 17 wants ||J z|| >= gamma ||z||: where a record leaves a direction unexcited, which one it is
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "log/record.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

struct ConvergenceTrace {
  WheelArm start;
  std::vector<double> distance;  ///< ||x_k - x*|| over ||x*||, in the norm of J'J(x*), k = 0, 1, ...
  std::vector<double> cosine;    ///< of each step
  bool reached = false;
};

struct ConvergenceCase {
  std::string name;
  WheelArm minimum;
  double predicted_factor = 0;  ///< ||[J'J]^-1 H||, equation 27
  double measured_factor = 0;
  std::vector<ConvergenceTrace> traces;  ///< from poor starts, steps of unit length halved where f would rise
};

/// Measures one record; the traces start at each of `starts`.
[[nodiscard]] ConvergenceCase measure_convergence(const std::string& name, const Record& record, const WheelArm& near,
                                                  const std::vector<WheelArm>& starts);

/// The order of convergence over the last steps of a trace: slope of log e_(k+1) over log e_k where e_k lies between
/// 1e-1 and 1e-9. Nothing with fewer than two such steps.
[[nodiscard]] std::optional<double> order_of(const ConvergenceTrace& trace);

struct Basin {
  WheelArm minimum;
  std::vector<double> inertia_kgm2;          ///< starts
  std::vector<double> stiffness_nm_per_rad;  ///< starts
  double damping_nms_per_rad = 0;            ///< start, the same for all
  /// steps[stiffness][inertia] to within 0.1 % of the minimum; NaN where it is not reached.
  std::vector<std::vector<double>> unit_steps;
  std::vector<std::vector<double>> line_search;

  [[nodiscard]] double unit_share() const;
  [[nodiscard]] double line_search_share() const;
};

/// Starts from 1/30 to 30 times the minimum's J and C, `side` of each, B that of the minimum.
[[nodiscard]] Basin draw_basin(
    const Record& record, const WheelArm& near, std::size_t side, unsigned threads,
    const std::function<void(std::size_t done)>& at_start = [](std::size_t) {});

struct RankCase {
  std::string name;
  int rank = 0;      ///< directions of J, B, C that the record shows
  double gamma = 0;  ///< smallest singular value of the scaled Jacobian, over the noise
  std::string says;  ///< what is unexcited
};

/// What equation 17 finds in `record`, in words: which of J, B and C, or which combination, the record does not show.
/// Relative changes are counted from `scale`, an arm of the usual size: the fit's own J is anything where J is
/// unexcited.
[[nodiscard]] RankCase examine_rank(const std::string& name, const Record& record, const WheelArm& scale);

/// A steady sine of torque on a wheel, in closed form, with white noise on the angle.
[[nodiscard]] Record sine_record(const WheelArm& wheel, double frequency_hz, double amplitude_nm, double duration_s,
                                 double angle_noise_rad, std::uint64_t seed);

/// A wheel in balance with the paper's triangle of 5 Nm at 0.025 Hz, and with a constant torque, likewise with noise.
[[nodiscard]] Record triangle_record(const WheelArm& wheel, double duration_s, double angle_noise_rad,
                                     std::uint64_t seed);
[[nodiscard]] Record constant_record(const WheelArm& wheel, double torque_nm, double duration_s, double angle_noise_rad,
                                     std::uint64_t seed);

}  // namespace steerid
