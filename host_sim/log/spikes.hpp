// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Samples that stand alone: a bit that tipped on the bus, a dropout that reads as full scale.
//
// A sample is a spike when it is far from the cubic through its two neighbours on either side, d, and these agree among
// each other:
//
//   |d_i| > 15 times what 19 of 20 samples of the channel have (30 standard deviations of white noise)
//   |d_i| > 4 times every difference between the neighbours next to each other
//
// A wheel has inertia and a channel an anti-alias filter, so that neither goes out and back within one sample. Nor does
// a rounded angle by more than a step, which is less than that. Spikes of two samples and more, small ones, and a
// channel of which more than 3 in 1000 samples are spikes, are left as they are. Cost: one pass and a selection.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <string>

#include "log/log_format.hpp"
#include "log/record.hpp"

namespace steerid {

struct Spikes {
  std::array<std::size_t, kChannels> count{};  ///< by channel

  [[nodiscard]] std::size_t of(Channel channel) const { return count[static_cast<std::size_t>(channel)]; }
  [[nodiscard]] std::size_t all() const { return std::accumulate(count.begin(), count.end(), std::size_t{0}); }
  /// A whole sentence for the user; empty without spikes.
  [[nodiscard]] std::string note() const;
};

/// Puts what its neighbours say, the cubic through them, in the place of every spike, and counts them by channel.
[[nodiscard]] Spikes mend_spikes(Record& record);

}  // namespace steerid
