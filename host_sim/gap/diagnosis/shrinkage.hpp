// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How far the gap shrinks: free runs of the simulation as it was given, refitted, and with the causes added, judged on
// the held-out part, with the floor that noise alone would leave and a block-bootstrap interval.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/likelihood/held_out_split.hpp"
#include "gap/likelihood/noise_floor.hpp"

namespace steerid::gap {

struct ShrinkageInput {
  const Record& record;  ///< as it was recorded
  const std::vector<Block>& blocks;
  const std::vector<double>& sim_rad;
  const std::vector<double>& refit_rad;
  const std::vector<double>& with_effect_rad;
  /// |H|^2 at w of the simulation with the causes: what noise torques pass through.
  std::function<double(double)> gain;
  NoiseFloor floor;
  std::optional<double> floor_rad{};  ///< what the floor leaves of the angle, where it is known better than by `gain`
  double quantum_rad = 0;             ///< step of a coarse angle, 0 if it is not
  /// Mean squares over the held-out part of what the simulation moves by when its numbers are drawn from what they may
  /// be, rad^2: so much of what it leaves may be theirs, and not the effect's.
  std::vector<double> unsure_rad2{};
  bool every_second = false;  ///< only the held-out samples that slow_torque() left unseen
  int draws = DiagnoseOptions().bootstrap_draws;
  std::uint64_t seed = DiagnoseOptions().seed;
};

/// No better is the floor known, as a share of itself: a gap that is smaller cannot be told from noise.
inline constexpr double kFloorKnownTo = 0.1;

/// Standard deviation of the measured angle on the held-out part, rad: what its NRMSEs are divided by.
[[nodiscard]] double held_out_sd(const Record& record, const std::vector<Block>& blocks);

/// Fills the NRMSEs and the closed fraction; the torque figures are not touched.
[[nodiscard]] GapSizes shrinkage(const ShrinkageInput& input);

}  // namespace steerid::gap
