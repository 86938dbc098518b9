// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What an excitation can show of J, B and C: the Cramer-Rao bound of a record of the experiment, with a probe of any
// strength on top.
//
// With the residual's noise white after a filter W (an autoregression fitted to what the sensors and the unmeasured
// torque leave behind) and of variance s^2, the information on all unknowns is X'X/s^2, X = W dth/dx at the true arm;
// the initial angle and rate are unknown and eliminated. The wheel is linear, so the angle's derivatives are those of
// the task plus `a` times those of a probe of 1 Nm rms: one evaluation gives the bound for every strength a.
//
// The bound is that of the angle given the torque, as every output-error fit sees it; what noise on the measured torque
// adds by way of a bias is not in it, and shows beside it as the errors that were measured.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "reproduction/experiment_run.hpp"

namespace steerid {

/// How the task is done.
enum class Performed {
  kToTheLetter,  ///< the triangle, the sine and nothing else: what the paper prescribes
  kByADriver,    ///< with tremor, restlessness, corrections and cycles that differ
};

class ExcitationBound {
 public:
  /// Of the record that `settings` describe; its own probe and its drift of C are left out.
  ExcitationBound(const RecordingSettings& settings, Performed performed);

  /// Standard deviations of J, B, C over their true values that no unbiased estimator goes below; infinity where the
  /// excitation shows nothing.
  [[nodiscard]] std::array<double, 3> relative_sd(double probe_rms_nm) const;

  /// The least probe with which `parameter` has a relative standard deviation of at most `limit`; 0 when it has that
  /// without, nothing when 5 Nm rms do not suffice. To 1 %.
  [[nodiscard]] std::optional<double> least_probe_nm(int parameter, double limit) const;

 private:
  WheelArm arm_;
  Eigen::Matrix<double, 8, 8> gram_;  ///< of [task: J B C][probe: J B C][initial angle, rate], over the variance
};

/// The bound of one task at one hand position for a row of probe strengths.
struct ExcitationRow {
  Performed performed;
  TaskKind task;
  HandPosition hands;
  WheelArm arm;
  std::vector<double> probe_rms_nm;
  std::vector<std::array<double, 3>> relative_sd;       ///< one a strength
  std::array<std::optional<double>, 3> least_probe_nm;  ///< for kVisible
};

/// A parameter counts as visible when its standard deviation is at most this share of it: the identifier's own limit.
inline constexpr double kVisible = 0.1;

/// Nominal arms of the tables: to the letter and by a driver, both tasks, six hand positions.
[[nodiscard]] std::vector<ExcitationRow> excitation_rows(const ExperimentSettings& settings);

/// What was measured: mean and root mean square of the relative errors of J, B, C over all records, the share of
/// records whose parameter was called valid, and whether the deviations stated there are some.
struct MeasuredErrors {
  std::size_t records = 0;
  std::array<double, 3> rms{};
  std::array<double, 3> bias{};
  std::array<double, 3> valid_share{};
  std::array<double, 3> covered{};  ///< share of the valid answers whose 95 % interval holds the truth
};
[[nodiscard]] MeasuredErrors measured_errors(std::span<const IdentifiedRecord> records, TaskKind task,
                                             ArmAnswer IdentifiedRecord::*answer);

/// The errors of one kind of record by one method.
struct ErrorRow {
  bool probed;
  TaskKind task;
  bool batch;  ///< by the batch fit, else by the firmware
  MeasuredErrors errors;
};
/// All eight: without the probe first, then by task, the batch fit before the firmware.
[[nodiscard]] std::vector<ErrorRow> error_rows(const ExperimentRun& run);

/// The same over strengths of the probe, ten subjects at 3 o'clock: what the bound promises, measured.
struct SweepPoint {
  double probe_rms_nm;
  TaskKind task;
  MeasuredErrors batch;
  MeasuredErrors recursive;
};
inline constexpr std::array kSweptProbes_nm{0.0, 0.02, 0.05, 0.1, 0.2, 0.5};
inline constexpr std::size_t kSweepRecords = kSweptProbes_nm.size() * kSteeringTasks.size() * kSubjects;

[[nodiscard]] std::vector<SweepPoint> probe_sweep(
    const ExperimentSettings& settings, const std::vector<VirtualSubject>& subjects,
    const std::function<void(std::size_t done)>& at_record = [](std::size_t) {});

}  // namespace steerid
