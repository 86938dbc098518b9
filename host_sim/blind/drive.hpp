// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The drives of the blind generator, after the paper's tasks (Lv et al. 2018, section III):
//   passive  a slow triangle from the EPS motor, about 5 Nm and 0.025 Hz, with a small multisine
//   active   the driver steers about 60 degrees at 0.25 Hz, no cycle like another; the motor assists a little
//   probe    a multisine from the EPS motor alone
//   loop     the EPS holds the wheel to an angle (blind/position_loop.hpp), the driver's hand rests on it
// A driver's hand is never quite still: slow restlessness and tremor are on the measured driver torque everywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "blind/draw.hpp"
#include "blind/simulation.hpp"

namespace steerid::blind {

enum class Task { kPassive, kActive, kProbe, kLoop };
[[nodiscard]] std::string_view name(Task task);

/// J a'' + B a' + C a of an angle a(t).
[[nodiscard]] Signal torque_along(const Arm& arm, const std::function<double(double)>& angle, double from_s,
                                  double to_s);

/// Draws a drive over `run`, for an arm like `arm`. No torque is unseen yet.
[[nodiscard]] Torques draw_torques(Task task, const Arm& arm, const Run& run, Draw& draw);

}  // namespace steerid::blind
