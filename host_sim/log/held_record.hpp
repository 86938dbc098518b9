// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A record whose logger holds channels (log/held_messages.hpp), stretch by stretch: as the record of their messages,
// or, where they came by several clocks, filtered from each to common times.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "log/held_messages.hpp"
#include "log/record.hpp"

namespace steerid {

class HeldRecord {
 public:
  /// Nothing where no channel is held in the longest stretch. Throws BadInput, about `file`, where a sensor sends too
  /// seldom.
  [[nodiscard]] static std::optional<HeldRecord> of(const Record& record, const std::string& file);

  /// Of every channel but the time; 0 where it is not held.
  [[nodiscard]] const std::array<double, kChannels - 1>& message_hz() const { return message_hz_; }
  /// Of the clock with the fewest messages a second.
  [[nodiscard]] double slowest_hz() const;
  /// Between two rows of the log.
  [[nodiscard]] double row_s() const { return row_s_; }
  /// In which channels are not held as in the longest one.
  [[nodiscard]] std::size_t dropped_stretches() const { return dropped_stretches_; }

  /// The record of its messages, where all channels came in the same ones; rows are appended to `empty`.
  [[nodiscard]] std::optional<Record> messages_alone(Record empty) const;

  /// Else every channel filtered from its own clock, by the filter for the slowest, at common times `period_s` apart;
  /// one for every stretch, without samples where that is too short.
  [[nodiscard]] std::vector<Stretch> filtered_messages(double period_s) const;

 private:
  struct HeldStretch {
    Stretch rows;
    MessageClocks clocks;
  };
  [[nodiscard]] Stretch filtered_messages(const HeldStretch& one, double period_s) const;

  std::vector<HeldStretch> stretches_;
  std::array<double, kChannels - 1> message_hz_{};
  std::size_t dropped_stretches_ = 0;
  double first_s_ = 0;  // the record's first stamp
  double row_s_ = 0;    // median
};

}  // namespace steerid
