// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Log files as text for the reader's tests.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <sstream>
#include <string>

#include "log/log_reader.hpp"

namespace steerid::test {

inline constexpr const char* kHeader = "time_s,torque_driver_nm,torque_motor_nm,angle_rad\n";

/// Rows first .. first + count - 1 at 100 Hz: row i is i/100, i, -i, i/8.
inline std::string rows(std::size_t count, std::size_t first = 0) {
  std::string text;
  for (std::size_t i = first; i < first + count; ++i) {
    text += fmt::format("{:.2f},{},-{},{}\n", 0.01 * static_cast<double>(i), i, i, 0.125 * static_cast<double>(i));
  }
  return text;
}

inline Record read_text(const std::string& text, const LogFormat& format = {}, RecordQuality* noticed = nullptr) {
  std::istringstream in(text);
  return read_log(in, "drive.csv", format, noticed);
}

}  // namespace steerid::test
