// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What survives power-off: the last good estimate, as a record of kSavedBytes in non-volatile memory.
//
// | byte | what           |                                                                                        |
// | 0    | magic, u32     | 0x44495453, "STID"                                                                     |
// | 4    | version, u32   | kSavedVersion; a record of another version is refused                                  |
// | 8    | generation,u32 | counts saves, wraps; tells the newer of two slots                                      |
// | 12   | wheel, u32     | which wheel it was learned on, the integrator's choice; another wheel's is refused     |
// | 16   | value, 3 x i32 | J, B, C in micro-units                                                                 |
// | 28   | sd, 3 x i32    | one standard deviation each, in micro-units                                            |
// | 40   | noise, i32     | of the whitened residual, in uNm                                                       |
// | 44   | CRC-32, u32    | IEEE 802.3 (reflected 0xEDB88320, start and final xor 0xFFFFFFFF) over bytes 0 to 43.  |
// |      |                | Finds every error of up to 4 bits at this length, and every burst of up to 32          |
//
// Little endian, whatever the processor.
//
// Two slots are written alternately (TwoSlots): the one that holds the newest good record is never touched by a save,
// so that power lost at any byte of a write leaves it. Statuses of a load:
//   kOk          the newest intact record of this wheel and version
//   kNoData      both slots blank, all bytes 0xFF or all 0: nothing was ever saved
//   kOutOfRange  intact, but of another wheel or version, or with numbers that no save writes
//   kCorrupt     neither slot passes its check
//   kIoError     the storage did not do as asked
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/crc32.hpp"
#include "base/status.hpp"

namespace steerid {

inline constexpr std::size_t kSavedBytes = 48;
inline constexpr std::uint32_t kSavedVersion = 1;
using SavedRecord = std::array<std::uint8_t, kSavedBytes>;

/// J, B, C in their order.
struct SavedEstimate {
  std::array<std::int32_t, 3> value_micro{};
  std::array<std::int32_t, 3> sd_micro{};
  std::int32_t noise_unm = 0;

  friend bool operator==(const SavedEstimate&, const SavedEstimate&) = default;
};

namespace saved {

inline constexpr std::uint32_t kMagic = 0x44495453U;
inline constexpr std::size_t kVersionAt = 4;
inline constexpr std::size_t kGenerationAt = 8;
inline constexpr std::size_t kWheelAt = 12;
inline constexpr std::size_t kNumbersAt = 16;
inline constexpr std::size_t kCrcAt = kSavedBytes - 4;

constexpr void put(SavedRecord& record, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) record[at + i] = static_cast<std::uint8_t>(value >> (8U * i));
}

constexpr std::uint32_t get(const SavedRecord& record, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(record[at + i]) << (8U * i);
  return value;
}

constexpr bool intact(const SavedRecord& record) {
  return get(record, 0) == kMagic && get(record, kCrcAt) == crc32(std::span(record).first(kCrcAt));
}

constexpr bool blank(const SavedRecord& record) {
  if (record[0] != 0xFFU && record[0] != 0U) return false;
  for (const std::uint8_t byte : record) {
    if (byte != record[0]) return false;
  }
  return true;
}

}  // namespace saved

constexpr SavedRecord encode(const SavedEstimate& estimate, std::uint32_t wheel, std::uint32_t generation) {
  SavedRecord record{};
  saved::put(record, 0, saved::kMagic);
  saved::put(record, saved::kVersionAt, kSavedVersion);
  saved::put(record, saved::kGenerationAt, generation);
  saved::put(record, saved::kWheelAt, wheel);
  for (std::size_t i = 0; i < 3; ++i) {
    saved::put(record, saved::kNumbersAt + 4 * i, static_cast<std::uint32_t>(estimate.value_micro[i]));
    saved::put(record, saved::kNumbersAt + 12 + 4 * i, static_cast<std::uint32_t>(estimate.sd_micro[i]));
  }
  saved::put(record, saved::kNumbersAt + 24, static_cast<std::uint32_t>(estimate.noise_unm));
  saved::put(record, saved::kCrcAt, crc32(std::span(record).first(saved::kCrcAt)));
  return record;
}

/// kOk, kNoData, kCorrupt or kOutOfRange as above; `estimate` is written for kOk only.
[[gnu::cold]] constexpr Status decode(const SavedRecord& record, std::uint32_t wheel, SavedEstimate& estimate) {
  if (saved::blank(record)) return Status::kNoData;
  if (!saved::intact(record)) return Status::kCorrupt;
  if (saved::get(record, saved::kVersionAt) != kSavedVersion || saved::get(record, saved::kWheelAt) != wheel) {
    return Status::kOutOfRange;
  }
  SavedEstimate read;
  const auto number = [&record](std::size_t i) {
    return static_cast<std::int32_t>(saved::get(record, saved::kNumbersAt + 4 * i));
  };
  for (std::size_t i = 0; i < 3; ++i) {
    read.value_micro[i] = number(i);
    read.sd_micro[i] = number(3 + i);
    if (read.value_micro[i] <= 0 || read.sd_micro[i] <= 0) return Status::kOutOfRange;
  }
  read.noise_unm = number(6);
  if (read.noise_unm <= 0) return Status::kOutOfRange;
  estimate = read;
  return Status::kOk;
}

/// Two places of kSavedBytes each in memory that keeps its contents, slot 0 and slot 1: flash sectors, EEPROM, a file.
/// A write may erase its slot first; it must not touch the other one. Both answer kOk or kIoError.
template <class S>
concept SavedStorage = requires(S storage, int slot, SavedRecord& into, const SavedRecord& from) {
  { storage.read(slot, into) } -> std::same_as<Status>;
  { storage.write(slot, from) } -> std::same_as<Status>;
};

template <SavedStorage Storage>
class TwoSlots {
 public:
  TwoSlots(Storage& storage, std::uint32_t wheel) : storage_(&storage), wheel_(wheel) {}

  /// The newest record that can be used; statuses above.
  [[gnu::cold]] Status load(SavedEstimate& estimate);
  /// Writes beside the newest intact record. kOk or kIoError. Blocks as long as the storage does: not for the 100 Hz
  /// tick of a target whose flash is slow.
  Status save(const SavedEstimate& estimate);

 private:
  /// a is newer than b, across the wrap.
  static bool newer(std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(a - b) > 0; }

  Storage* storage_;
  std::uint32_t wheel_;
};

template <SavedStorage Storage>
Status TwoSlots<Storage>::load(SavedEstimate& estimate) {
  Status result = Status::kNoData;
  std::uint32_t newest = 0;
  // What to say when no slot can be used: the graver, and with it the more telling, of the two.
  const auto gravity = [](Status status) {
    return status == Status::kNoData ? 0 : status == Status::kIoError ? 1 : status == Status::kCorrupt ? 2 : 3;
  };
  for (int slot = 0; slot < 2; ++slot) {
    SavedRecord record{};
    SavedEstimate read;
    Status status = storage_->read(slot, record);
    if (status == Status::kOk) status = decode(record, wheel_, read);
    if (status != Status::kOk) {
      if (result != Status::kOk && gravity(status) > gravity(result)) result = status;
      continue;
    }
    const std::uint32_t generation = saved::get(record, saved::kGenerationAt);
    if (result == Status::kOk && !newer(generation, newest)) continue;
    result = Status::kOk;
    newest = generation;
    estimate = read;
  }
  return result;
}

template <SavedStorage Storage>
Status TwoSlots<Storage>::save(const SavedEstimate& estimate) {
  int target = 0;
  std::uint32_t newest = 0;
  bool any = false;
  for (int slot = 0; slot < 2; ++slot) {
    SavedRecord record{};
    if (storage_->read(slot, record) != Status::kOk || !saved::intact(record)) continue;
    const std::uint32_t generation = saved::get(record, saved::kGenerationAt);
    if (any && !newer(generation, newest)) continue;
    any = true;
    newest = generation;
    target = 1 - slot;
  }
  return storage_->write(target, encode(estimate, wheel_, newest + 1));
}

}  // namespace steerid
