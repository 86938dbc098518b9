// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/excitation.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiment/triangle.hpp"
#include "fit/autoregression.hpp"
#include "fit/certainty.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/free_run.hpp"
#include "plant/linear_response.hpp"
#include "plant/torque_signal.hpp"

namespace steerid {
namespace {

constexpr int kNoiseOrder = 30;  // 0.3 s, as the batch fit
constexpr double kStrongest_nm = 5.0;

using Rows = Autoregression::Rows;

/// What the sensors and the unmeasured torque leave of the angle when the true arm is known.
Eigen::VectorXd noise_of(const RecordingSettings& settings) {
  const Recording recording = make_recording(settings);
  FreeRun run(recording.record);
  const std::span<const double> model = run(settings.arm);
  Eigen::VectorXd residual(static_cast<Eigen::Index>(model.size()));
  for (std::size_t i = 0; i < model.size(); ++i) {
    residual[static_cast<Eigen::Index>(i)] = recording.record.angle_rad[i] - model[i];
  }
  return residual;
}

struct Drive {
  std::vector<double> time_s;
  std::vector<double> torque_nm;
  WheelState initial;
};

/// The net torque that the settings make, without noise.
Drive by_a_driver(RecordingSettings settings) {
  settings.instruments = Instruments::perfect();
  settings.unmeasured_percent = 0;
  const Record record = make_recording(settings).record;
  return {record.time_s, record.net_torque_nm(), {}};
}

/// 5 Nm at 0.025 Hz, or the torque that a sine of 1 rad at 0.25 Hz takes, each going on since long: a start from rest
/// would show J by its own transient.
Drive to_the_letter(const RecordingSettings& settings) {
  const double w = 2 * std::numbers::pi * 0.25;
  const WheelArm& arm = settings.arm;
  Triangle triangle(5.0, 4000);
  Multisine probe({.rms_nm = settings.probe_rms_nm});
  Drive drive;
  const bool passive = settings.task == TaskKind::kPassive;
  drive.initial.rate_rad_s = passive ? -0.5 / arm.stiffness_nm_per_rad : w;  // the triangle rises by 0.5 Nm a second
  if (passive) {
    drive.initial.angle_rad = -drive.initial.rate_rad_s * arm.damping_nms_per_rad / arm.stiffness_nm_per_rad;
  }
  const auto rows = static_cast<std::size_t>(std::llround(settings.duration_s / kTickS));
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = static_cast<double>(i) * kTickS;
    const double sine = (arm.stiffness_nm_per_rad - arm.inertia_kgm2 * w * w) * std::sin(w * t) +
                        arm.damping_nms_per_rad * w * std::cos(w * t);
    const double task = passive ? -triangle.next().value : sine;
    drive.time_s.push_back(t);
    drive.torque_nm.push_back(task - probe.next().value);
  }
  return drive;
}

/// The derivatives of the angle; what depends on the state at the start is eliminated later.
FreeRunSensitivities derivatives(const RecordingSettings& settings, Performed performed) {
  const Drive drive = performed == Performed::kByADriver ? by_a_driver(settings) : to_the_letter(settings);
  FreeRunSensitivities run;
  free_run_sensitivities(settings.arm,
                         TorqueSignal::from_samples(drive.time_s, drive.torque_nm, TorqueSignal::Between::kBandLimited),
                         drive.time_s, drive.initial, 0, run);
  return run;
}

}  // namespace

ExcitationBound::ExcitationBound(const RecordingSettings& given, Performed performed) : arm_(given.arm) {
  RecordingSettings task = given;
  task.stiffness_swing = 0;
  task.probe_rms_nm = 0;
  RecordingSettings probed = task;
  probed.probe_rms_nm = 1;

  const std::array residual{noise_of(task)};
  const Autoregression noise = Autoregression::fit(residual, kNoiseOrder);
  Rows rows = Rows::Zero(residual[0].size(), Autoregression::kColumns);
  Rows white;
  rows.col(0) = residual[0];
  noise.whiten(rows, white);
  const double variance = white.col(0).squaredNorm() / static_cast<double>(white.rows());

  const FreeRunSensitivities plain = derivatives(task, performed);
  const FreeRunSensitivities with = derivatives(probed, performed);
  rows.leftCols<3>() = plain.by.leftCols<3>();
  rows.middleCols<3>(3) = with.by.leftCols<3>() - plain.by.leftCols<3>();
  rows.rightCols<2>() = plain.by.middleCols<2>(kByInitialAngle);
  noise.whiten(rows, white);
  gram_ = white.transpose() * white / variance;
}

std::array<double, 3> ExcitationBound::relative_sd(double probe_rms_nm) const {
  Eigen::Matrix<double, 8, 5> mix = Eigen::Matrix<double, 8, 5>::Zero();
  mix.topLeftCorner<3, 3>().setIdentity();
  mix.block<3, 3>(3, 0).diagonal().setConstant(probe_rms_nm);
  mix.bottomRightCorner<2, 2>().setIdentity();
  const Eigen::Matrix<double, 5, 5> information = mix.transpose() * gram_ * mix;
  const Eigen::Matrix<double, 5, 1> unit = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, 5, 5> scaled = unit.asDiagonal() * information * unit.asDiagonal();
  // A direction without information is one: parameters without a part in it are still seen.
  constexpr double kRounding = 1e-12;
  constexpr double kPart = 1e-3;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 5, 5>> eigen(scaled);
  const std::array value{arm_.inertia_kgm2, arm_.damping_nms_per_rad, arm_.stiffness_nm_per_rad};
  std::array<double, 3> sd{};
  for (int i = 0; i < 3; ++i) {
    double variance = 0;
    for (int k = 0; k < 5; ++k) {
      const double part = eigen.eigenvectors()(i, k);
      const double seen = eigen.eigenvalues()[k];
      if (seen > kRounding) variance += part * part / seen;
      if (seen <= kRounding && std::abs(part) > kPart) variance = std::numeric_limits<double>::infinity();
    }
    sd[static_cast<std::size_t>(i)] = std::sqrt(variance) * unit[i] / value[static_cast<std::size_t>(i)];
  }
  return sd;
}

std::optional<double> ExcitationBound::least_probe_nm(int parameter, double limit) const {
  const auto seen = [&](double probe) { return relative_sd(probe)[static_cast<std::size_t>(parameter)] <= limit; };
  if (seen(0)) return 0.0;
  if (!seen(kStrongest_nm)) return std::nullopt;
  double low = 1e-4;
  if (seen(low)) return low;
  double high = kStrongest_nm;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    (seen(middle) ? high : low) = middle;
  }
  return high;
}

std::vector<ExcitationRow> excitation_rows(const ExperimentSettings& settings) {
  std::vector<ExcitationRow> rows;
  for (std::size_t i = 0; i < 4 * kAllHandPositions.size(); ++i) {
    const Performed performed = i < 2 * kAllHandPositions.size() ? Performed::kToTheLetter : Performed::kByADriver;
    const TaskKind task = kSteeringTasks[i / kAllHandPositions.size() % 2];
    const HandPosition hands = kAllHandPositions[i % kAllHandPositions.size()];
    rows.push_back(
        {performed, task, hands, nominal_arm(task, hands), {0, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 1.5}, {}, {}});
  }
  work_in_parallel(rows.size(), settings.threads, [&](std::size_t i) {
    ExcitationRow& row = rows[i];
    RecordingSettings what;
    what.task = row.task;
    what.hands = row.hands;
    what.arm = row.arm;
    what.duration_s = row.task == TaskKind::kPassive ? settings.passive_s : settings.active_s;
    what.unmeasured_percent = settings.unmeasured_percent;
    what.seed = settings.seed * 10'000 + 5'000 + i;
    const ExcitationBound bound(what, row.performed);
    for (const double probe : row.probe_rms_nm) row.relative_sd.push_back(bound.relative_sd(probe));
    for (int k = 0; k < 3; ++k) row.least_probe_nm[static_cast<std::size_t>(k)] = bound.least_probe_nm(k, kVisible);
  });
  return rows;
}

std::vector<SweepPoint> probe_sweep(const ExperimentSettings& settings, const std::vector<VirtualSubject>& subjects,
                                    const std::function<void(std::size_t done)>& at_record) {
  const std::size_t of_a_point = subjects.size() * kSteeringTasks.size();
  std::vector<IdentifiedRecord> records(kSweptProbes_nm.size() * of_a_point);
  work_in_parallel(records.size(), settings.threads, at_record, [&](std::size_t job) {
    const std::size_t subject = job % subjects.size();
    const TaskKind task = kSteeringTasks[job / subjects.size() % kSteeringTasks.size()];
    RecordingSettings what = recording_settings(settings, subjects, task, HandPosition::kRight3, subject, true);
    what.probe_rms_nm = kSweptProbes_nm[job / of_a_point];
    what.seed += 100 * (1 + job / of_a_point);  // another drive at every strength
    records[job] = identify_recording(subject, what, make_recording(what).record);
  });
  std::vector<SweepPoint> points;
  for (std::size_t i = 0; i < kSweptProbes_nm.size(); ++i) {
    const std::span<const IdentifiedRecord> here = std::span(records).subspan(i * of_a_point, of_a_point);
    for (const TaskKind task : kSteeringTasks) {
      points.push_back({kSweptProbes_nm[i], task, measured_errors(here, task, &IdentifiedRecord::batch),
                        measured_errors(here, task, &IdentifiedRecord::recursive)});
    }
  }
  return points;
}

MeasuredErrors measured_errors(std::span<const IdentifiedRecord> records, TaskKind task,
                               ArmAnswer IdentifiedRecord::*answer) {
  MeasuredErrors out;
  double count = 0;
  for (const IdentifiedRecord& record : records) {
    if (record.what.task != task) continue;
    ++count;
    const WheelArm& arm = record.what.arm;
    const std::array truth{arm.inertia_kgm2, arm.damping_nms_per_rad, arm.stiffness_nm_per_rad};
    for (std::size_t i = 0; i < 3; ++i) {
      const double error = (record.*answer).value[i] / truth[i] - 1;
      out.rms[i] += error * error;
      out.bias[i] += error;
      if (!(record.*answer).valid(static_cast<int>(i))) continue;
      out.valid_share[i] += 1;
      out.covered[i] += std::abs(error * truth[i]) <= kNormal95 * (record.*answer).sd[i] ? 1 : 0;
    }
  }
  out.records = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < 3; ++i) {
    out.rms[i] = std::sqrt(out.rms[i] / count);
    out.bias[i] /= count;
    if (out.valid_share[i] > 0) out.covered[i] /= out.valid_share[i];
    out.valid_share[i] /= count;
  }
  return out;
}

std::vector<ErrorRow> error_rows(const ExperimentRun& run) {
  std::vector<ErrorRow> rows;
  for (const bool probed : {false, true}) {
    for (const TaskKind task : kSteeringTasks) {
      for (const bool batch : {true, false}) {
        rows.push_back({probed, task, batch,
                        measured_errors(probed ? run.probed : run.plain, task,
                                        batch ? &IdentifiedRecord::batch : &IdentifiedRecord::recursive)});
      }
    }
  }
  return rows;
}

}  // namespace steerid
