// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A sensor's messages that a logger keeps the last of: some rows show an older one, as it came late.
//
// A sensor sends evenly, by a clock of its own; the logger writes a row by its own clock with what came last. Where a
// message comes just before or just behind the writing, some rows show it and some the one before: the channel repeats
// itself to the last digit, goes on, a row late, and jumps two messages when one is in time again. Repeats alone do not
// tell it from lost samples, behind which the next row is in time.
//
// Model. The m-th new value is message n_m of an even motion; it stands in row i_m, late by e_m = i_m - n_m rows,
//
//   e_m = e_(m-1) + i_m - i_(m-1) - (n_m - n_(m-1)),  0 <= e_m <= 2
//
// A row is late with the share of rows that repeat, and in time again with probability q a row (1: samples were lost,
// and it is at once). Clocks of different rates slip by a message now and then, without being late: once in
// exp(kSlip_nats) rows. What tells is the motion: four messages in a row lie on a parabola of their numbers, but for
// noise and what is faster (log/bend.hpp, of variance s^2 by its median). Neighbouring bends share samples: their log
// likelihood counts half.
//
// q is the likeliest of a few by the sum over all walks (the forward algorithm; Rabiner, Proc. IEEE 77, 1989), and
// messages are late where that is likelier than q = 1 by kSure_nats; their numbers are the likeliest walk's (Viterbi).
// Asked only of channels whose noise is larger than their steps, as in log/frozen_channels.hpp: others repeat by
// themselves.
//
// Cost: some 2 us a row of a channel that repeats; nothing of one that does not.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace steerid {

struct MessageNumbers {
  std::vector<std::size_t> row{};        ///< of every new value, ascending
  std::vector<std::ptrdiff_t> number{};  ///< of its message, strictly ascending; the row where none is late
  double late_share = 0;                 ///< of the rows
  std::vector<std::size_t> slips{};  ///< rows from which on it is a message off, for good (log/slipped_messages.hpp)
};

/// Of even rows. Nothing where no message is late, or nothing tells.
[[nodiscard]] std::optional<MessageNumbers> message_numbers(std::span<const double> values);

}  // namespace steerid
