// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Bytes between an interrupt and the loop: one writes, the other reads, and neither ever waits.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace steerid::mps2 {

/// Size is a power of two; it holds one byte less.
template <std::size_t Size>
class Ring {
 public:
  static_assert((Size & (Size - 1)) == 0);

  [[nodiscard]] std::size_t room() const { return (tail_.load() - head_.load() - 1) & (Size - 1); }
  [[nodiscard]] bool empty() const { return head_.load() == tail_.load(); }
  bool push(std::uint8_t byte) {
    if (room() == 0) return false;
    const std::size_t head = head_.load();
    bytes_[head] = byte;
    head_.store((head + 1) & (Size - 1));
    return true;
  }
  bool pop(std::uint8_t& byte) {
    if (empty()) return false;
    const std::size_t tail = tail_.load();
    byte = bytes_[tail];
    tail_.store((tail + 1) & (Size - 1));
    return true;
  }

 private:
  std::array<std::uint8_t, Size> bytes_{};
  std::atomic<std::size_t> head_ = 0;
  std::atomic<std::size_t> tail_ = 0;
};

}  // namespace steerid::mps2
