// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which column of which file holds which channel, and in which unit: the logs of one drive, understood.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "log/log_format.hpp"
#include "log/log_source.hpp"

namespace steerid {

struct NamedLog {
  std::string name;  ///< stands for the file in sentences
  std::string stem;  ///< as --columns names it before a slash
  std::unique_ptr<LogSource> source;
};

/// What is to be read of one file.
struct ChosenColumns {
  Wanted wanted{};
  std::vector<Channel> channels{};  ///< for each of Wanted::columns
};

struct Choice {
  std::vector<ChosenColumns> files{};  ///< for each log; one that has no channel is not read
  std::array<bool, kChannels> present{};
  std::array<std::string, kChannels> columns{};  ///< of each channel, as --columns names it
  bool slide = false;                            ///< some unit is one of a linear drive
  std::vector<std::string> notes{};              ///< units taken for granted, torques taken as zero

  /// Record::channels. Without a bar and a rim, the paper's two torques are there: as zeros if need be.
  [[nodiscard]] std::uint8_t channels() const;
};

/// Throws BadInput: of the channels that must be there and are not, all at once, with the columns that they may be; a
/// column that is there twice; a unit that is none of the channel's.
[[nodiscard]] Choice choose_columns(const std::vector<NamedLog>& logs, const LogFormat& format);

}  // namespace steerid
