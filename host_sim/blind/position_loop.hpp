// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An EPS that holds the wheel to an angle, as it does while it steers: the motor's torque answers the measured angle,
// with its noise. What a record of it shows above the reference's frequencies is the loop, not the wheel.
//
//   every millisecond: e = reference - (angle + n),  command = P e + D d/dt e (low-passed)
//   the motor pushes with the command of some milliseconds ago, and holds it for one
//
// n is on the recorded angle, too. The loop is an element that acts before all others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "blind/draw.hpp"
#include "blind/element.hpp"
#include "blind/signal.hpp"
#include "blind/simulation.hpp"

namespace steerid::blind {

struct PositionLoop {
  Signal reference_rad;
  double stiffness_nm_per_rad = 0;  ///< P
  double damping_nms_per_rad = 0;   ///< D
  double low_pass_s = 0.003;        ///< of the error's rate
  double noise_rad = 0;             ///< n, standard deviation, white at 1 kHz
  std::size_t late_ms = 0;
  std::uint64_t seed = 0;  ///< of n
};

/// A loop for this arm: crossover at 25 to 60 rad/s, a reference up to 3 to 6 Hz of 0.15 to 0.4 rad rms.
[[nodiscard]] PositionLoop draw_position_loop(const Arm& arm, const Run& run, std::uint64_t seed, Draw& draw);

/// The torque that takes a linear arm along the reference.
[[nodiscard]] Signal torque_along(const PositionLoop& loop, const Arm& arm, const Run& run);

[[nodiscard]] std::unique_ptr<Element> held_by(const PositionLoop& loop, const Run& run);

}  // namespace steerid::blind
