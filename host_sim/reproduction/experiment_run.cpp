// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/experiment_run.hpp"

#include "parallel/work_in_parallel.hpp"

namespace steerid {

RecordingSettings recording_settings(const ExperimentSettings& settings, const std::vector<VirtualSubject>& subjects,
                                     TaskKind task, HandPosition hands, std::size_t subject, bool probed) {
  const std::size_t index = ExperimentRun::index(task, hands, subject);
  return {.task = task,
          .hands = hands,
          .arm = subjects[subject].arm(task, hands),
          .duration_s = task == TaskKind::kPassive ? settings.passive_s : settings.active_s,
          .probe_rms_nm = probed ? settings.probe_rms_nm : 0.0,
          .stiffness_swing = settings.stiffness_swing,
          .unmeasured_percent = settings.unmeasured_percent,
          .instruments = {},
          .seed = settings.seed * 10'000 + index};
}

ExperimentRun run_experiment(const ExperimentSettings& settings,
                             const std::function<void(std::size_t done)>& at_record) {
  ExperimentRun run{settings, virtual_subjects(settings.seed), {}, {}};
  run.plain.resize(kRecordsOfAKind);
  run.probed.resize(kRecordsOfAKind);
  work_in_parallel(2 * kRecordsOfAKind, settings.threads, at_record, [&](std::size_t job) {
    const bool probed = job % 2 == 1;
    const std::size_t index = job / 2;
    const std::size_t subject = index % kSubjects;
    const HandPosition hands = kAllHandPositions[index / kSubjects % kAllHandPositions.size()];
    const TaskKind task = kSteeringTasks[index / (kSubjects * kAllHandPositions.size())];
    const RecordingSettings what = recording_settings(settings, run.subjects, task, hands, subject, probed);
    (probed ? run.probed : run.plain)[index] = identify_recording(subject, what, make_recording(what).record);
  });
  return run;
}

}  // namespace steerid
