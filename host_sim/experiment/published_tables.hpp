// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Tables I and II of Lv et al. 2018: ten subjects, right arm only. "Nominal value" and "value range" as printed.
//
// The paper has no table for both arms. Where a range for both is needed, the factors of hand_positions.hpp are put on
// the row with the nearest grip.
#pragma once

#include <array>

#include "experiment/hand_positions.hpp"

namespace steerid {

struct PublishedRange {
  double nominal = 0;
  double low = 0;
  double high = 0;

  [[nodiscard]] constexpr PublishedRange times(double factor) const {
    return {factor * nominal, factor * low, factor * high};
  }
};

struct PublishedRow {
  TaskKind task;
  HandPosition hands;
  PublishedRange inertia_kgm2;
  PublishedRange damping_nms_per_rad;
  PublishedRange stiffness_nm_per_rad;
  PublishedRange natural_frequency_hz;

  [[nodiscard]] constexpr WheelArm nominal() const {
    return {inertia_kgm2.nominal, damping_nms_per_rad.nominal, stiffness_nm_per_rad.nominal};
  }
};

inline constexpr std::array<PublishedRow, 6> kPublishedRows{{
    {TaskKind::kPassive,
     HandPosition::kRight3,
     {0.11, 0.03, 0.14},
     {1.5, 0.1, 2.5},
     {22.7, 13.8, 69.5},
     {3.3, 0.85, 4.11}},
    {TaskKind::kPassive,
     HandPosition::kRight12,
     {0.11, 0.03, 0.18},
     {2.1, 0.1, 4.1},
     {45.9, 29.1, 80.5},
     {2.8, 0.82, 4.24}},
    {TaskKind::kPassive,
     HandPosition::kRight130,
     {0.11, 0.05, 0.14},
     {0.7, 0.1, 3.1},
     {17.0, 13.0, 35.2},
     {3.1, 0.95, 4.27}},
    {TaskKind::kActive,
     HandPosition::kRight3,
     {0.11, 0.03, 0.17},
     {2.9, 1.2, 3.6},
     {10.2, 5.1, 12.1},
     {0.8, 0.52, 1.36}},
    {TaskKind::kActive,
     HandPosition::kRight12,
     {0.11, 0.03, 0.18},
     {3.0, 1.6, 4.4},
     {9.2, 4.5, 13.1},
     {0.7, 0.34, 1.19}},
    {TaskKind::kActive,
     HandPosition::kRight130,
     {0.11, 0.02, 0.17},
     {3.1, 2.4, 3.4},
     {10.0, 7.8, 11.1},
     {0.8, 0.37, 1.03}},
}};

/// The row of a task, passive or active, with the grip of `hands`; for both arms that of the right one.
constexpr const PublishedRow& published_row(TaskKind task, HandPosition hands) {
  return kPublishedRows[(task == TaskKind::kActive ? 3U : 0U) + static_cast<unsigned>(hands) % 3U];
}

constexpr bool both_arms(HandPosition hands) { return static_cast<unsigned>(hands) >= 3; }

}  // namespace steerid
