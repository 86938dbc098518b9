// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A frame as a CAN logger writes it, and what reads frames one after the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace steerid {

struct CanFrame {
  static constexpr std::size_t kMostBytes = 64;  ///< CAN FD

  double time_s = 0;
  std::uint32_t id = 0;
  bool extended = false;
  std::size_t bytes = 0;
  std::array<std::uint8_t, kMostBytes> data{};
};

class CanFrames {
 public:
  CanFrames() = default;
  CanFrames(const CanFrames&) = delete;
  CanFrames& operator=(const CanFrames&) = delete;
  virtual ~CanFrames() = default;

  /// The next data frame; false at the end. Remote and error frames and what is no frame are passed over. Throws
  /// BadInput.
  virtual bool next(CanFrame& frame) = 0;
};

}  // namespace steerid
