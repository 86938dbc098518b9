// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// CAN logs that are text: candump's and Vector's ASC.
//
//   (1436509052.249713) vcan0 044#2A366C2BBA          candump -L, CAN FD as 044##1112233
//   (1436509052.249713)  vcan0  044   [5]  2A 36 6C   candump -ta
//   base hex  timestamps absolute                     ASC, hexadecimal or decimal
//   0.017 1  44x  Rx  d 5 2A 36 6C 2B BA
#pragma once

#include <memory>
#include <string_view>

#include "log/can_frame.hpp"
#include "log/log_source.hpp"

namespace steerid {

[[nodiscard]] bool is_candump(std::string_view first_bytes);
[[nodiscard]] bool is_asc(std::string_view first_bytes);

/// Both keep `log.in`. Their next() throws BadInput, naming the line, for a frame that is cut.
[[nodiscard]] std::unique_ptr<CanFrames> candump_frames(OpenedLog log);
[[nodiscard]] std::unique_ptr<CanFrames> asc_frames(OpenedLog log);

}  // namespace steerid
