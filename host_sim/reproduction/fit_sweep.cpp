// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/fit_sweep.hpp"

#include "parallel/work_in_parallel.hpp"

namespace steerid {

FitSweep fit_sweep(const ExperimentSettings& settings, const std::vector<VirtualSubject>& subjects,
                   const std::function<void(std::size_t done)>& at_record) {
  std::vector<FitPoint> points;
  points.reserve(kSweptSwings.size() + kSweptUnmeasured_percent.size());
  for (const double swing : kSweptSwings) points.push_back({swing, settings.unmeasured_percent, {}});
  for (const double percent : kSweptUnmeasured_percent) points.push_back({settings.stiffness_swing, percent, {}});

  constexpr std::size_t kOfAPoint = kSteeringTasks.size() * kSweptSubjects;
  std::vector<IdentifiedRecord> records(points.size() * kOfAPoint);
  work_in_parallel(records.size(), settings.threads, at_record, [&](std::size_t job) {
    const std::size_t subject = job % kSweptSubjects;
    const TaskKind task = kSteeringTasks[job / kSweptSubjects % kSteeringTasks.size()];
    RecordingSettings what = recording_settings(settings, subjects, task, HandPosition::kRight3, subject, false);
    what.stiffness_swing = points[job / kOfAPoint].stiffness_swing;
    what.unmeasured_percent = points[job / kOfAPoint].unmeasured_percent;
    records[job] = identify_recording(subject, what, make_recording(what).record);
  });
  FitSweep out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].accuracy = accuracy_of(std::span(records).subspan(i * kOfAPoint, kOfAPoint));
    (i < kSweptSwings.size() ? out.over_swing : out.over_unmeasured).push_back(points[i]);
  }
  return out;
}

}  // namespace steerid
