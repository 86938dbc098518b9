// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How a log file names its columns, in which units, and which way its signs go.
//
//   --columns time=t_ms,torque_motor=force_n,angle=theta:deg     channel=column, the unit by the column's suffix or
//                                                                after a colon
//   --sign torque_driver | -torque_driver | torque_driver=-1     the channel is turned round; several with commas
//   --sign -1                                                    every torque is turned round
//
// | channel       | contract's column | units: suffix or after the colon | read as              |
// | time          | time_s            | s, ms, us                        | s                    |
// | torque_driver | torque_driver_nm  | nm, mnm, n                       | Nm (N for a slide)   |
// | torque_motor  | torque_motor_nm   | nm, mnm, n                       | Nm (N for a slide)   |
// | angle         | angle_rad         | rad, deg, mrad, urad, m          | rad (m for a slide)  |
// | torque_bar    | torque_bar_nm     | nm, mnm, n                       | Nm (N for a slide)   |
// | torque_rim    | torque_rim_nm     | nm, mnm, n                       | Nm (N for a slide)   |
// | probe         | probe_nm          | nm, mnm, n                       | Nm (N for a slide)   |
//
// Unit names ignore case. A linear drive is read with newtons and metres in place of newton metres and radians; its
// J is then a mass in kg.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "log/record.hpp"

namespace steerid {

enum class Channel : std::size_t { kTime, kTorqueDriver, kTorqueMotor, kAngle, kTorqueBar, kTorqueRim, kProbe };

inline constexpr std::size_t kChannels = 7;
inline constexpr std::array<Channel, kChannels> kAllChannels = {
    Channel::kTime,      Channel::kTorqueDriver, Channel::kTorqueMotor, Channel::kAngle,
    Channel::kTorqueBar, Channel::kTorqueRim,    Channel::kProbe};

/// As --columns names it: "torque_bar".
[[nodiscard]] std::string_view channel_name(Channel channel);

/// The column the contract gives the channel: "torque_bar_nm".
[[nodiscard]] std::string_view contract_column(Channel channel);

/// The channel's bit in Record::channels and Sample::valid_bits; 0 for the time, which every sample has.
[[nodiscard]] std::uint8_t valid_bit(Channel channel);

/// The channel's values in a record.
[[nodiscard]] std::vector<double>& values_of(Record& record, Channel channel);
[[nodiscard]] const std::vector<double>& values_of(const Record& record, Channel channel);

/// The unit a channel is held in: "s", "nm", "nm", "rad".
[[nodiscard]] std::string_view si_unit(Channel channel);

/// How many of `unit` make one SI unit of the channel (1000 for "ms"); nothing when it is no unit of this channel.
[[nodiscard]] std::optional<double> units_per_si(Channel channel, std::string_view unit);

/// One channel's entry in --columns. An empty name: the option does not mention the channel.
struct ColumnChoice {
  std::string name{};
  std::string unit{};  ///< as stated after the colon; empty: by the column's suffix
};

using ColumnChoices = std::array<ColumnChoice, kChannels>;
using Reversed = std::array<bool, kChannels>;

/// The default reads the contract's columns with the signs they have.
struct LogFormat {
  ColumnChoices columns{};
  Reversed reversed{};
};

/// The text of --columns. Throws BadOption with one sentence on an unknown channel or unit, a channel or column named
/// twice, or an empty name.
[[nodiscard]] ColumnChoices parse_columns(std::string_view text);

/// The text of --sign. Throws BadOption with one sentence on anything but the forms above.
[[nodiscard]] Reversed parse_sign(std::string_view text);

}  // namespace steerid
