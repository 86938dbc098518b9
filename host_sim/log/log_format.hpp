// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How a log's channels are found among its columns, in which units they are, and which way their signs go.
//
//   --columns time=t_ms,torque_motor=force_n,angle=theta:deg     channel=column, the unit by the column's own (a suffix
//                                                                such as _ms or [ms], a row of units, a DBC) or after
//                                                                a colon
//   --columns angle=counts:deg*0.0219-180                        counts: column * scale + offset is in that unit
//   --columns 'angle="theta, left":deg'                          a name with a comma, colon or equals sign is quoted
//   --columns time=a/t,time=b/zeit:ms,angle=b/theta              of several files: FILE/COLUMN, FILE without its folder
//                                                                and ending; a column of time for each
//   --sign torque_driver | -torque_driver | torque_driver=-1     the channel is turned round; several with commas
//   --sign -1                                                    every torque is turned round
//
// | channel       | contract's column | read as              |
// | time          | time_s            | s                    |
// | torque_driver | torque_driver_nm  | Nm (N for a slide)   |
// | torque_motor  | torque_motor_nm   | Nm (N for a slide)   |
// | angle         | angle_rad         | rad (m for a slide)  |
// | torque_bar    | torque_bar_nm     | Nm (N for a slide)   |
// | torque_rim    | torque_rim_nm     | Nm (N for a slide)   |
// | probe         | probe_nm          | Nm (N for a slide)   |
//
// The units are in log/units.hpp. Without --columns the contract's column is taken, with another unit behind it too
// (angle_deg, "angle [deg]").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "log/record.hpp"
#include "log/units.hpp"

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

/// The quantity that the channel measures.
[[nodiscard]] Quantity quantity_of(Channel channel);

/// One channel's entry in --columns. An empty name: the option does not mention the channel.
struct ColumnChoice {
  std::string name{};
  std::string unit{};  ///< as stated after the colon; empty: as the column states it
  double scale = 1.0;  ///< of counts: column * scale + offset is in the unit
  double offset = 0.0;

  bool operator==(const ColumnChoice&) const = default;
};

struct ColumnChoices : std::array<ColumnChoice, kChannels> {
  std::vector<ColumnChoice> more_times{};  ///< of further files
};
using Reversed = std::array<bool, kChannels>;

/// The default reads the contract's columns with the signs they have.
struct LogFormat {
  ColumnChoices columns{};
  Reversed reversed{};
  std::vector<std::filesystem::path> dbc{};  ///< what the frames of a CAN log mean
  std::vector<double> moved_s{};             ///< for each file, added to its stamps; none for the files behind the last
  bool start_together = false;               ///< files that the first has no time in common with begin with it
};

/// As the option has it: "angle=counts:deg*0.0219-180", the name in quotes where it needs them.
[[nodiscard]] std::string choice_text(Channel channel, const ColumnChoice& choice);

/// The text of --columns. Throws BadOption with one sentence on an unknown channel or unit, a channel or column named
/// twice, or an empty name.
[[nodiscard]] ColumnChoices parse_columns(std::string_view text);

/// The text of --sign. Throws BadOption with one sentence on anything but the forms above.
[[nodiscard]] Reversed parse_sign(std::string_view text);

}  // namespace steerid
