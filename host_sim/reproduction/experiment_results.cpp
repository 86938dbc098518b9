// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/experiment_results.hpp"

#include <cmath>

#include "experiment/triangle.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/linear_response.hpp"
#include "sensors/random.hpp"

namespace steerid {
namespace {

constexpr std::size_t kBasinSide = 21;
constexpr std::size_t kConvergenceCases = 6;
constexpr std::size_t kFigureSubject = 0;

/// The record of a kind of the first subject, changed before it is taken.
template <class Change>
Record changed(const ExperimentRun& run, TaskKind task, HandPosition hands, bool probed, Change change) {
  RecordingSettings what = recording_settings(run.settings, run.subjects, task, hands, kFigureSubject, probed);
  change(what);
  return make_recording(what).record;
}

struct NamedRecord {
  const char* name;
  Record record;
  WheelArm arm;
};

std::vector<NamedRecord> convergence_records(const ExperimentRun& run) {
  const auto as_is = [](RecordingSettings&) {};
  const auto exact = [](RecordingSettings& what) {
    what.instruments = Instruments::perfect();
    what.stiffness_swing = 0;
    what.unmeasured_percent = 0;
  };
  const auto unmeasured = [](RecordingSettings& what) { what.unmeasured_percent = 10; };
  const auto drifting = [](RecordingSettings& what) { what.stiffness_swing = 0.2; };
  constexpr HandPosition kHands = HandPosition::kRight3;
  const WheelArm passive = run.subjects[kFigureSubject].arm(TaskKind::kPassive, kHands);
  const WheelArm active = run.subjects[kFigureSubject].arm(TaskKind::kActive, kHands);
  return {{"passive with probe, exact", changed(run, TaskKind::kPassive, kHands, true, exact), passive},
          {"passive with probe", changed(run, TaskKind::kPassive, kHands, true, as_is), passive},
          {"passive as in the paper", changed(run, TaskKind::kPassive, kHands, false, as_is), passive},
          {"passive, 10 % unmeasured torque", changed(run, TaskKind::kPassive, kHands, false, unmeasured), passive},
          {"active as in the paper", changed(run, TaskKind::kActive, kHands, false, as_is), active},
          {"active, C swings by 20 %", changed(run, TaskKind::kActive, kHands, false, drifting), active}};
}

std::vector<ConvergenceCase> convergence_cases(const ExperimentRun& run,
                                               const std::function<void(std::size_t done)>& at_case) {
  const std::vector<NamedRecord> records = convergence_records(run);
  std::vector<ConvergenceCase> cases(records.size());
  work_in_parallel(records.size(), run.settings.threads, at_case, [&](std::size_t i) {
    const WheelArm& arm = records[i].arm;
    const std::vector<WheelArm> poor{{3 * arm.inertia_kgm2, arm.damping_nms_per_rad / 3, arm.stiffness_nm_per_rad / 3},
                                     {arm.inertia_kgm2 / 3, 3 * arm.damping_nms_per_rad, 2 * arm.stiffness_nm_per_rad}};
    cases[i] = measure_convergence(records[i].name, records[i].record, arm, poor);
  });
  return cases;
}

/// The paper's tasks to the letter and what else a wheel may go through, with the angle's noise of the experiment.
std::vector<RankCase> rank_cases(const ExperimentRun& run) {
  constexpr double kNoise_rad = 2e-4;
  const WheelArm passive = nominal_arm(TaskKind::kPassive, HandPosition::kRight3);
  const WheelArm active = nominal_arm(TaskKind::kActive, HandPosition::kRight3);
  const auto as_is = [](RecordingSettings&) {};
  return {
      examine_rank("active task to the letter: a steady sine", sine_record(active, 0.25, 10.7, 60, kNoise_rad, 1),
                   active),
      examine_rank("passive task to the letter: a triangle", triangle_record(passive, 80, kNoise_rad, 2), passive),
      examine_rank("one flank of that triangle", triangle_record(passive, 9.5, kNoise_rad, 2), passive),
      examine_rank("a constant torque", constant_record(passive, 3.0, 30, kNoise_rad, 3), passive),
      examine_rank("a wheel at rest, no torque", constant_record(passive, 0.0, 30, kNoise_rad, 4), passive),
      examine_rank("passive, by a driver", changed(run, TaskKind::kPassive, HandPosition::kRight3, false, as_is),
                   passive),
      examine_rank("active, by a driver", changed(run, TaskKind::kActive, HandPosition::kRight3, false, as_is), active),
      examine_rank("passive, with the probe", changed(run, TaskKind::kPassive, HandPosition::kRight3, true, as_is),
                   passive),
      examine_rank("active, with the probe", changed(run, TaskKind::kActive, HandPosition::kRight3, true, as_is),
                   active)};
}

std::vector<GraspCheck> grasp_checks(const ExperimentRun& run) {
  std::vector<GraspCheck> checks;
  for (const HandPosition hands : kAllHandPositions) {
    const RecordingSettings what =
        recording_settings(run.settings, run.subjects, TaskKind::kActive, hands, kFigureSubject, false);
    checks.push_back(check_grasp(hands, make_recording(what)));
  }
  return checks;
}

Recording figure(const ExperimentRun& run, TaskKind task, HandPosition hands) {
  return make_recording(recording_settings(run.settings, run.subjects, task, hands, kFigureSubject, false));
}

}  // namespace

std::size_t experiment_jobs() {
  return 2 * kRecordsOfAKind + kSweepRecords + kFitSweepRecords + 2 * kTakeOverDrives + kBasinSide * kBasinSide +
         10 * kConvergenceCases;
}

ExperimentResults experiment_results(const ExperimentSettings& settings,
                                     const std::function<void(std::size_t done)>& at_job) {
  std::size_t before = 0;
  const auto part = [&](std::size_t done) { at_job(before + done); };
  ExperimentResults out;
  out.run = run_experiment(settings, part);
  before += 2 * kRecordsOfAKind;
  out.sweep = probe_sweep(settings, out.run.subjects, part);
  before += kSweepRecords;
  out.fit = fit_sweep(settings, out.run.subjects, part);
  before += kFitSweepRecords;
  out.driver_probed = score_driver_state(settings, out.run.subjects, settings.probe_rms_nm, part);
  before += kTakeOverDrives;
  out.driver_plain = score_driver_state(settings, out.run.subjects, 0, part);
  before += kTakeOverDrives;
  out.convergence = convergence_cases(out.run, [&](std::size_t done) { part(10 * done); });
  before += 10 * kConvergenceCases;
  const auto short_record = [](RecordingSettings& what) { what.duration_s = 20; };
  out.basin = draw_basin(changed(out.run, TaskKind::kActive, HandPosition::kRight3, true, short_record),
                         out.run.subjects[kFigureSubject].arm(TaskKind::kActive, HandPosition::kRight3), kBasinSide,
                         settings.threads, part);
  out.rows = table_rows(out.run);
  out.put_in = put_in(out.run);
  out.overdamped = overdamped_records(out.run);
  for (const PublishedRow& row : kPublishedRows) out.checks.push_back(check_frequency(row));
  out.plain_accuracy = accuracy_of(out.run.plain);
  out.probed_accuracy = accuracy_of(out.run.probed);
  out.correlations = label_correlations(out.run.probed);
  out.excitation = excitation_rows(settings);
  out.figure_5 = figure(out.run, TaskKind::kPassive, HandPosition::kRight130);
  out.figure_6 = figure(out.run, TaskKind::kActive, HandPosition::kRight3);
  out.grasps = grasp_checks(out.run);
  out.ranks = rank_cases(out.run);
  return out;
}

}  // namespace steerid
