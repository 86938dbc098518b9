// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the frames of a bus mean: messages and signals of a DBC file.
//
// Read are BO_, SG_ (both byte orders, signed and not, plain multiplexing) and SIG_VALTYPE_ (floats); the rest is
// passed over. Extended multiplexing (m0M) is taken as plain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "log/can_frame.hpp"

namespace steerid {

struct DbcSignal {
  enum class Number : std::uint8_t { kUnsigned, kSigned, kFloat, kDouble };

  std::string name;
  std::string unit{};
  std::size_t start = 0;   ///< DBC's bit number: the lowest bit of Intel's, the highest of Motorola's
  std::size_t length = 0;  ///< bits, 1 to 64
  bool motorola = false;
  Number number = Number::kUnsigned;
  double factor = 1;
  double offset = 0;
  bool selects = false;                        ///< the multiplexer
  std::optional<std::uint64_t> selected_by{};  ///< the multiplexer's value with which it is there

  /// The number that it stands for; nothing when the frame is too short.
  [[nodiscard]] std::optional<double> value(const CanFrame& frame) const;
  [[nodiscard]] std::optional<std::uint64_t> raw(const CanFrame& frame) const;
};

struct DbcMessage {
  std::string name;
  std::uint32_t id = 0;
  bool extended = false;
  std::vector<DbcSignal> signals{};
};

/// `name` stands for the file in sentences. Throws BadInput when a line of a message or signal cannot be read, and when
/// there is no message.
[[nodiscard]] std::vector<DbcMessage> parse_dbc(std::string_view text, const std::string& name);
[[nodiscard]] std::vector<DbcMessage> load_dbc(const std::filesystem::path& file);

}  // namespace steerid
