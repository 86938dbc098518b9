// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What every operation of the firmware that can fail returns. The firmware neither throws nor allocates.
#pragma once

#include <cstdint>

namespace steerid {

enum class [[nodiscard]] Status : std::uint8_t{
    kOk = 0,
    kEndOfStream,  ///< the back end has no further tick: a record is over, a simulation has run its time
    kNoData,       ///< nothing new since the last call
    kLate,         ///< the tick came after its deadline; work may go on
    kOutOfRange,   ///< an argument or a reading is outside its documented range
    kCorrupt,      ///< a stored or received record fails its check
    kIoError,      ///< the device did not do as asked
};

constexpr const char* name(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kEndOfStream:
      return "end of stream";
    case Status::kNoData:
      return "no data";
    case Status::kLate:
      return "late";
    case Status::kOutOfRange:
      return "out of range";
    case Status::kCorrupt:
      return "corrupt";
    case Status::kIoError:
      return "i/o error";
  }
  return "unknown";
}

}  // namespace steerid
