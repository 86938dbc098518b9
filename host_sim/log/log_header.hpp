// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which cell of a row holds which channel, and in which unit: the header line of a log, understood.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "log/log_format.hpp"

namespace steerid {

struct LogHeader {
  static constexpr std::size_t kUnused = kChannels;

  char separator = ',';
  std::vector<std::string> names{};        ///< the columns as the file names them
  std::vector<std::size_t> channel_of{};   ///< for each column the index of its channel, or kUnused
  std::array<double, kChannels> per_si{};  ///< a cell divided by this is SI; negative when the channel is turned round
  std::array<bool, kChannels> present{};
  std::vector<std::string> notes{};  ///< units taken for granted, torques taken as zero

  [[nodiscard]] std::string_view column(Channel channel) const;

  /// Record::channels of this log. Without a bar and a rim, the paper's two torques are there: as zeros if need be.
  [[nodiscard]] std::uint8_t channels() const;
};

/// Throws BadInput, naming `file` and `line`, when a channel that must be there is not, or a column is there twice.
[[nodiscard]] LogHeader understand_header(std::string_view text, const LogFormat& format, const std::string& file,
                                          std::size_t line);

}  // namespace steerid
