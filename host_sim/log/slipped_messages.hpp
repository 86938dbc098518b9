// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A sensor and a logger of one rate by two clocks: now and then a row shows no new message, or one was never shown.
//
// Crystals differ by 20 to 200 ppm. A logger that writes the last message every 10 ms, of a sensor that sends every
// 10 ms, then repeats one in 50 to 500 s, or skips one, and from there on every row is a message older, or younger,
// than the rows before. Between two slips the messages' age drifts (log/angle_clock.hpp); a slip takes that back at
// once, so that a drift is seen as such only when its slips are counted.
//
// A repeat of a sample that was lost looks the same, but the next message is in time again. The motion tells: an
// autoregression of the channel (order 24, by Levinson and Durbin's recursion) predicts each message by those before
// it. With q_h half of the squared errors, in deviations, of the 24 messages behind a place where h are missing, which
// read as what fits best,
//
//   a repeat is a slip where it is likelier than a loss, q_h - q_0, and than h messages that read alike, by 5 nats and
//   the logarithm of how many repeats there are;
//   a message was skipped where q_0 without its largest two neighbours is above q_1 by 7 nats and log n, as it may be
//   anywhere, and q_1 is no more than three times the median of q_0. Two errors in a row are a blow: a wheel that runs
//   against a stop changes its rate at once.
//
// Skips are looked for in an angle alone: a wheel's inertia lets it make no such step, and a torque may. A channel with
// more than one repeat in 1000 rows, more slips than crystals make, or slips of both kinds, has something else; so has
// an angle that is as surprising at places where none was skipped. Asked only of channels whose noise is larger than
// their steps. A slip while the wheel hardly turns tells nothing: of 24 drawn ones, 16 of 18 repeats are found and 4 of
// 6 skips. Of 2,400 records without one, 1,800 of them with 45 impacts by 0.3 to 1.3 rad/s, one has a skip; of
// 1,600 whose readings are alike now and then, one.
//
// A message is as old as can be just before a skip, and new behind it; it is new just before a repeat. There the clocks
// are in step: the numbers are those of the rows behind the first skip, and before the first repeat.
//
// Cost: some 0.2 us a row of a torque, 2 us of an angle.
#pragma once

#include <optional>
#include <span>

#include "log/late_messages.hpp"

namespace steerid {

/// Of even rows. `inert`: of an angle. Nothing where no slip tells.
[[nodiscard]] std::optional<MessageNumbers> slipped_numbers(std::span<const double> values, bool inert);

}  // namespace steerid
