// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whole experiment: ten subjects, two tasks, six hand positions, each record taken twice, once as the paper excites
// the wheel and once with a small probe from the EPS on top.
//
// A record depends on the seed, its subject, task and hands only: any number of threads gives the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "experiment/virtual_subject.hpp"
#include "reproduction/identified_record.hpp"

namespace steerid {

struct ExperimentSettings {
  std::uint64_t seed = 1;
  double probe_rms_nm = 0.5;        ///< of the second record of each pair; multisine, 0.2 to 5 Hz
  double passive_s = 80;            ///< two periods of the triangle
  double active_s = 60;             ///< fifteen cycles; the paper asks for five at least
  double stiffness_swing = 0.0075;  ///< how far co-contraction drifts, either way
  double unmeasured_percent = 0.3;  ///< torque that no sensor sees, rms over the applied torque's
  unsigned threads = 0;             ///< 0: one a core
};

struct ExperimentRun {
  ExperimentSettings settings;
  std::vector<VirtualSubject> subjects;
  std::vector<IdentifiedRecord> plain;   ///< in the order task, hands, subject
  std::vector<IdentifiedRecord> probed;  ///< likewise

  [[nodiscard]] static std::size_t index(TaskKind task, HandPosition hands, std::size_t subject) {
    return ((task == TaskKind::kActive ? 6U : 0U) + static_cast<std::size_t>(hands)) * kSubjects + subject;
  }
};

inline constexpr std::array kSteeringTasks{TaskKind::kPassive, TaskKind::kActive};
inline constexpr std::size_t kRecordsOfAKind = kSteeringTasks.size() * kAllHandPositions.size() * kSubjects;

[[nodiscard]] RecordingSettings recording_settings(const ExperimentSettings& settings,
                                                   const std::vector<VirtualSubject>& subjects, TaskKind task,
                                                   HandPosition hands, std::size_t subject, bool probed);

/// `at_record` hears, on the calling thread, how many of 2 kRecordsOfAKind records are done.
[[nodiscard]] ExperimentRun run_experiment(
    const ExperimentSettings& settings, const std::function<void(std::size_t done)>& at_record = [](std::size_t) {});

}  // namespace steerid
