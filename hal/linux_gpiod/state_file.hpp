// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The two slots of the saved estimate (app/saved_state.hpp) in one file: slot 0 at byte 0, slot 1 at byte 4096, on
// different blocks of any usual file system, so that a block that is torn by a loss of power holds one slot only.
//
// Every write reaches the medium before it returns (fdatasync), which may take long: never from the 100 Hz loop.
#pragma once

#include <string>

#include "base/status.hpp"
#include "linux_gpiod/descriptor.hpp"

namespace steerid::linux_gpiod {

class StateFile {
 public:
  /// Makes the file when it is not there. Throws Failure when it can be neither opened nor made, and when `path` is no
  /// regular file: a symbolic link would have the daemon write wherever it points.
  explicit StateFile(const std::string& path);

  /// kOk, with bytes beyond the file's end as zeros; kIoError.
  template <class Record>
  Status read(int slot, Record& into) {
    into = Record{};
    return read_bytes(slot, into.data(), into.size());
  }
  template <class Record>
  Status write(int slot, const Record& from) {
    return write_bytes(slot, from.data(), from.size());
  }

 private:
  Status read_bytes(int slot, void* bytes, std::size_t count);
  Status write_bytes(int slot, const void* bytes, std::size_t count);

  Descriptor file_;
};

}  // namespace steerid::linux_gpiod
