// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The readers of CAN logs and of DBC files must end every text in frames and messages that keep their promises, or in
// one BadInput of one line.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "log/bad_input.hpp"
#include "log/blf.hpp"
#include "log/can_text.hpp"
#include "log/dbc.hpp"
#include "promise.hpp"

namespace {

using steerid::fuzz::check_sentence;
using steerid::fuzz::promise;

template <class Work>
void in_one_sentence(Work work) {
  try {
    work();
  } catch (const steerid::BadInput& error) {
    check_sentence(error.what());
  }
}

void read_frames(std::unique_ptr<steerid::CanFrames> (*open)(steerid::OpenedLog), const std::string& bytes) {
  in_one_sentence([&] {
    const auto frames = open({.in = std::make_unique<std::istringstream>(bytes), .name = "fuzz.log"});
    const steerid::DbcSignal signal{.name = "all", .start = 3, .length = 64, .motorola = true};
    steerid::CanFrame frame;
    while (frames->next(frame)) {
      promise(frame.bytes <= steerid::CanFrame::kMostBytes, "frames of 64 bytes or less");
      promise(frame.id < 0x20000000U, "identifiers of 29 bits or less");
      promise(std::isfinite(frame.time_s), "finite stamps");
      const auto value = signal.value(frame);
      promise(!value || std::isfinite(*value), "finite values");
    }
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  read_frames(steerid::candump_frames, bytes);
  read_frames(steerid::asc_frames, bytes);
  read_frames(steerid::blf_frames, bytes);
  in_one_sentence([&] {
    steerid::CanFrame frame{.bytes = steerid::CanFrame::kMostBytes};
    frame.data.fill(0xa5);
    for (const steerid::DbcMessage& message : steerid::parse_dbc(bytes, "fuzz.dbc")) {
      for (const steerid::DbcSignal& signal : message.signals) {
        const auto value = signal.value(frame);
        promise(!value || std::isfinite(*value), "finite values");
      }
    }
  });
  return 0;
}
