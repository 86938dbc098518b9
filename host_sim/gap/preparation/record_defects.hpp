// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Defects of the record itself, read off its numbers before any model is fitted: lost samples, coarse resolution,
// clipped torques. Each is found by what no moving wheel can do:
//   sample_loss          the angle repeats exactly while the wheel moves by many times its resolution and noise, or
//                        stands still for several samples and then jumps
//   coarse_quantization  the angle takes values on a lattice whose step explains (nearly) all of its white noise
//   torque_saturation    a torque stays within its noise of the largest value that it ever has, again and again, and
//                        for longer than its own curvature allows; certainly, where a channel with noise has one
//                        largest value again and again
// The repaired record is what every other hypothesis is then compared with.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "log/record.hpp"
#include "plant/effects/effect.hpp"

namespace steerid::gap {

struct RecordDefect {
  Effect effect;
  double strength = 0;   ///< how plainly it shows: 0 at the threshold of doubt, 1 and more beyond it
  bool certain = false;  ///< nothing but the defect makes such numbers

  /// A defect is read off, not inferred: what is left is the chance of having read wrongly.
  [[nodiscard]] double probability() const;
};

/// Clipped samples from `first` on: what may be wrong with their repair, independent shapes of the size of their
/// standard deviation, one a column.
struct HiddenTorque {
  std::size_t first = 0;
  Eigen::MatrixXd shapes_nm;
};

struct RecordDefects {
  std::vector<RecordDefect> found;
  Record repaired;                   ///< equals the record when nothing was found
  std::vector<HiddenTorque> hidden;  ///< what clipped torques hid
  std::vector<char> lost;            ///< 1 where an angle sample repeats the one before; empty unless samples were lost

  /// The defect of this id; found.end() where there is none.
  [[nodiscard]] std::vector<RecordDefect>::const_iterator find(std::string_view id) const {
    return std::ranges::find_if(found, [id](const RecordDefect& one) { return one.effect.type->id == id; });
  }
};

[[nodiscard]] RecordDefects record_defects(const Record& record);

}  // namespace steerid::gap
