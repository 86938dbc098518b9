// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The line to an ECU: a serial port, or the emulator's process with the serial line on its standard streams. Throws
// BadInput when there is no such port, no emulator or no image.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "log/unfinished_files.hpp"

namespace steerid::hil {

class ByteChannel {
 public:
  /// `port`: a device such as /dev/ttyUSB0, set to 921600 baud 8N1, or a pseudo terminal. Throws BadInput for any other
  /// file.
  static ByteChannel open_port(const std::filesystem::path& port);
  /// Starts qemu-system-arm with `machine` ("mps2-an386") and the image. It ends with this object.
  static ByteChannel start_emulator(const std::string& machine, const std::filesystem::path& image);

  ByteChannel(ByteChannel&& other) noexcept;
  ByteChannel& operator=(ByteChannel&&) = delete;
  ByteChannel(const ByteChannel&) = delete;
  ByteChannel& operator=(const ByteChannel&) = delete;
  ~ByteChannel();

  /// All of it, as fast as the line takes it.
  void write(std::span<const std::uint8_t> bytes);
  /// What has arrived, at least one byte; nothing after `timeout_ms`.
  std::span<const std::uint8_t> read(int timeout_ms);

 private:
  ByteChannel(int descriptor, pid_t child, std::string name);

  int descriptor_;
  pid_t child_;  ///< 0: none
  std::unique_ptr<EndsWithProgram> ended_by_signals_;
  std::string name_;
  std::uint8_t buffer_[4096] = {};
};

}  // namespace steerid::hil
