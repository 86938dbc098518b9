// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Memory that a reset leaves alone (section .kept, no part of what start-up clears): why the last reset came, and the
// two saved pages. It stands for the flash page or the backed-up RAM of a real ECU; after power-on it holds garbage,
// which the record's CRC tells from a record.
#pragma once

#include <array>
#include <cstdint>

#include "app/saved_state.hpp"

namespace steerid::mps2 {

inline constexpr std::uint32_t kAskedForReset = 0x5E7A5CEDU;
inline constexpr std::uint32_t kWatchdogReset = 0xBADD06E5U;

struct KeptMemory {
  std::uint32_t reset_mark;
  std::array<SavedRecord, 2> pages;

  void forget() {
    for (SavedRecord& page : pages) page.fill(0xFF);
  }
};

KeptMemory& kept_memory();

/// steerid::SavedStorage on the two pages.
class KeptPages {
 public:
  Status read(int slot, SavedRecord& into) {
    into = kept_memory().pages[static_cast<std::size_t>(slot)];
    return Status::kOk;
  }
  Status write(int slot, const SavedRecord& from) {
    kept_memory().pages[static_cast<std::size_t>(slot)] = from;
    return Status::kOk;
  }
};

}  // namespace steerid::mps2
