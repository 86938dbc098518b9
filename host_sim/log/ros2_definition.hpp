// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Message types of ROS 2, from their text (.msg files):
//
//   float64 position          # a field
//   string<=10 name "left"    # bounded, with a preset
//   int32[3] fixed            # three of them; [] and [<=3] for as many as there are
//   builtin_interfaces/Time stamp
//   int32 LIMIT=7             # a constant, not in the message
//
// The types that a definition needs follow behind lines of "=", each below "MSG: package/Type".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steerid {

enum class Ros2Kind : std::uint8_t { kWhole, kWholeSigned, kFloat, kText, kMessage };
enum class Ros2Count : std::uint8_t { kOne, kFixed, kAny };

struct Ros2Field {
  std::string name;
  Ros2Kind kind = Ros2Kind::kFloat;
  std::size_t bytes = 0;    ///< of a number
  std::size_t message = 0;  ///< of a message: index of its type
  Ros2Count count = Ros2Count::kOne;
  std::size_t fixed = 0;  ///< how many
};

/// Each type's fields; the first is the message's own. No type holds itself.
using Ros2Types = std::vector<std::vector<Ros2Field>>;

/// Nothing where the text is not understood: a type that is not there or holds itself, wide strings.
[[nodiscard]] std::optional<Ros2Types> parse_ros2_definition(std::string_view type, std::string_view definition);

}  // namespace steerid
