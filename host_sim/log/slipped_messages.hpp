// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A sensor and a logger of one rate by two clocks: now and then a row shows no new message, or one was never shown.
//
// Crystals differ by 20 to 200 ppm. A logger that writes the last message every 10 ms, of a sensor that sends every
// 10 ms, then repeats one in 50 to 500 s, or skips one, and from there on every row is a message older, or younger,
// than the rows before. Between two slips the messages' age drifts (log/angle_clock.hpp); a slip takes that back at
// once, so that a drift is seen as such only when its slips are counted.
//
// A repeat of a sample that was lost looks the same, but the next message is in time again. The motion tells: four
// messages in a row lie on a parabola of their numbers (log/bend.hpp). With q_h the squares of the three bends around a
// place where h messages are missing, over 4 s^2 (s^2 is the mean square of all bends; these share messages, so that
// each counts half),
//
//   a repeat is a slip where it is likelier than a loss, q_h - q_0, by 7 nats (a thousand to one);
//   a message was skipped where q_0 - q_1 is above 7 nats and log n, as it may be anywhere, what is left is below 4.5,
//   and the step is beyond all means of what those before and those behind it make of it, by as many nats: a wheel that
//   runs against a stop changes its rate at once, and its step there is such a mean.
//
// Skips are looked for in an angle alone: a wheel's inertia lets it make no such step, and a torque may. A channel with
// more than one repeat in 1000 rows, or more slips than crystals make, or of both kinds, has something else. Asked only
// of channels whose noise is larger than their steps. A slip while the wheel hardly turns tells nothing: of 24 drawn
// ones, 15 of 18 repeats are found and 1 of 6 skips.
//
// A message is as old as can be just before a skip, and new behind it; it is new just before a repeat. There the clocks
// are in step: the numbers are those of the rows behind the first skip, and before the first repeat.
//
// Cost: a pass a channel.
#pragma once

#include <optional>
#include <span>

#include "log/late_messages.hpp"

namespace steerid {

/// Of even rows. `inert`: of an angle. Nothing where no slip tells.
[[nodiscard]] std::optional<MessageNumbers> slipped_numbers(std::span<const double> values, bool inert);

}  // namespace steerid
