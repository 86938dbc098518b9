// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The ten subjects of the paper's experiment, drawn: each one's arm for both tasks and all six hand positions.
//
// A parameter of a subject lies at z standard deviations from the median of ten: median = the nominal value, and the
// ends of the printed range are where the smallest and largest of ten are expected, z = -+1.54. Between, the scale is
// logarithmic on either side:
//   value = nominal (high/nominal)^(z/1.54) for z > 0,  nominal (low/nominal)^(-z/1.54) for z < 0,  |z| at most 1.54
//
// Drawn together as the paper found them (section VI):
//   J  belongs to the subject and to where the hands are, never to the task: one draw serves both. Its range is that of
//      both tables together.
//   C  0.8 of z is the subject's (a strong arm is stiff in both tasks), the rest the record's.
//      The tables make it several times larger in the passive task.
//   B  half of z follows C: co-contraction damps as well.
//
// Both arms: J x 1.15, B x 1.15, C x 1.3, see hand_positions.hpp; the natural frequency follows. The hand position
// shifts nothing but what its row of the tables says.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "experiment/published_tables.hpp"

namespace steerid {

inline constexpr std::size_t kSubjects = 10;

struct VirtualSubject {
  std::array<WheelArm, 6> passive;  ///< by hand position
  std::array<WheelArm, 6> active;

  [[nodiscard]] const WheelArm& arm(TaskKind task, HandPosition hands) const {
    return (task == TaskKind::kActive ? active : passive)[static_cast<std::size_t>(hands)];
  }
};

/// What a deviation of `z` makes of a printed range.
[[nodiscard]] double value_at(const PublishedRange& range, double z);

[[nodiscard]] std::vector<VirtualSubject> virtual_subjects(std::uint64_t seed, std::size_t count = kSubjects);

}  // namespace steerid
