// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Vector's binary CAN log, BLF: objects in containers that are packed with zlib.
//
// Read are CAN_MESSAGE, CAN_MESSAGE2, CAN_FD_MESSAGE and CAN_FD_MESSAGE_64 (types 1, 86, 100 and 101), loose or in
// containers, packed or not; other objects are passed over. The layout is that which python-can's reader and writer
// document (can/io/blf.py). Stamps count from the start of the measurement, which the head of the file has in ms.
// Memory: two containers, of 16 MiB at most.
#pragma once

#include <memory>
#include <string_view>

#include "log/can_frame.hpp"
#include "log/log_source.hpp"

namespace steerid {

[[nodiscard]] bool is_blf(std::string_view first_bytes);

/// next() throws BadInput where an object is cut or does not unpack.
[[nodiscard]] std::unique_ptr<CanFrames> blf_frames(OpenedLog log);

}  // namespace steerid
