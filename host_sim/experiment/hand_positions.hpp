// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where the hands are, and the arm that goes with it: the nominal rows of tables I and II of Lv et al. 2018.
//
// The right arm's numbers are the paper's. For both arms the paper gives directions only: inertia, stiffness and
// natural frequency go up against one arm. Chosen here: J x 1.15, B x 1.15, C x 1.3 of the one-armed row with the
// nearest grip; the natural frequency rises with sqrt(1.3/1.15), and all three stay within what the tables span.
//
// The probe is held against as a disturbance is: it takes the passive row. In the active rows xi = B / (2 sqrt(J C))
// is 1.3 to 1.5: the paper's natural frequencies (0.7 to 0.8 Hz) do not follow from its own equation 5 there.
#pragma once

#include <array>
#include <string_view>

#include "plant/wheel_arm.hpp"

namespace steerid {

enum class TaskKind { kPassive, kActive, kProbe };
enum class HandPosition { kRight3, kRight12, kRight130, kBoth3And9, kBoth12And6, kBoth10And10 };

inline constexpr std::array<TaskKind, 3> kAllTasks{TaskKind::kPassive, TaskKind::kActive, TaskKind::kProbe};
inline constexpr std::array<HandPosition, 6> kAllHandPositions{HandPosition::kRight3,     HandPosition::kRight12,
                                                               HandPosition::kRight130,   HandPosition::kBoth3And9,
                                                               HandPosition::kBoth12And6, HandPosition::kBoth10And10};

/// As the command line spells it.
constexpr std::string_view name(TaskKind task) {
  switch (task) {
    case TaskKind::kPassive:
      return "passive";
    case TaskKind::kActive:
      return "active";
    case TaskKind::kProbe:
      return "probe";
  }
  return "unknown";
}

constexpr std::string_view name(HandPosition hands) {
  switch (hands) {
    case HandPosition::kRight3:
      return "right_3";
    case HandPosition::kRight12:
      return "right_12";
    case HandPosition::kRight130:
      return "right_130";
    case HandPosition::kBoth3And9:
      return "both_3_9";
    case HandPosition::kBoth12And6:
      return "both_12_6";
    case HandPosition::kBoth10And10:
      return "both_10_10";
  }
  return "unknown";
}

/// J, B, C of the average driver for this task with the hands there.
constexpr WheelArm nominal_arm(TaskKind task, HandPosition hands) {
  constexpr WheelArm kPassive[3] = {{0.11, 1.5, 22.7}, {0.11, 2.1, 45.9}, {0.11, 0.7, 17.0}};
  constexpr WheelArm kActive[3] = {{0.11, 2.9, 10.2}, {0.11, 3.0, 9.2}, {0.11, 3.1, 10.0}};
  const auto place = static_cast<unsigned>(hands);
  const WheelArm one = (task == TaskKind::kActive ? kActive : kPassive)[place % 3];
  if (place < 3) return one;
  return {1.15 * one.inertia_kgm2, 1.15 * one.damping_nms_per_rad, 1.3 * one.stiffness_nm_per_rad};
}

}  // namespace steerid
