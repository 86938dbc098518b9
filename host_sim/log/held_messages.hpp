// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Channels that a logger holds from row to row until the sensor's next message comes.
//
// A logger writes a row every ms with what came last, and the sensors send every 10 or 20 ms: most rows repeat the one
// before. Read as it stands, such a channel is late by half of its own period in the mean, and stairs; read when its
// messages came, it is neither. Rows of 10 ms that show a sensor of 12 or 20 ms are the same.
//
// Model. Message m comes at t_0 + m P, or later by what a bus makes it wait, and stands in the rows from the next one
// on. The stamps at which the channel changes then lie on an even grid (log/sampling_instants.hpp), but for less than a
// row, or half of P. P is longer than a row by 2 % at least; a sensor of the rows' own rate is
// log/late_messages.hpp's. A message that reads as the one before, or was lost, leaves its place empty, and is read as
// the row has it; a channel of one and a half to two rows a message that loses any may be left as it is. t_0 is by the
// row that shows a message the soonest, as any sample is taken to be of its row's stamp; where P is a whole number of
// rows it may be earlier by up to one.
//
// An angle that is rounded coarsely stands still as well, and at a constant rate evenly: no messages are told of one
// that mostly changes by its smallest step. A torque may be a staircase: what a motor or a simulated driver was told
// last, it does. Where the angle changes in every row the rows are the machine's own, and a torque that is held is
// taken as messages only if a sensor's noise shows (log/channel_noise.hpp), below 0.3 of its rms.
//
// Cost: one pass of a channel that changes in every row; some us a change of one that does not.
#pragma once

#include <array>
#include <optional>

#include "log/stretch.hpp"

namespace steerid {

struct MessageClock {
  double first_s = 0;   ///< stamp at which the first whole one came
  double period_s = 0;  ///< between two
  double wait_s = 0;    ///< behind its time a message stands in the rows, and the next does not
};

/// Of every channel that is held; none of the others.
using MessageClocks = std::array<std::optional<MessageClock>, kChannels - 1>;

[[nodiscard]] MessageClocks message_clocks(const Stretch& stretch);

/// Too few messages a second for a record (log/stamp_limits.hpp).
[[nodiscard]] bool is_slow(const MessageClock& clock);

/// What the rows have at every message of the clock.
[[nodiscard]] Stretch messages_of(const Stretch& stretch, const MessageClock& clock);

/// Where all channels that change are held by the same clock, and are every one of its messages: that. Else nothing.
[[nodiscard]] std::optional<MessageClock> clock_of_all(const Stretch& stretch, const MessageClocks& clocks);

}  // namespace steerid
