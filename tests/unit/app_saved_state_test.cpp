// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The record that survives power-off: its layout and check, every bit flipped, every write cut short.
#include <gtest/gtest.h>

#include <random>
#include <string_view>
#include <vector>

#include "app/saved_state.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr std::uint32_t kWheel = 0xA1B2C3D4;

SavedEstimate estimate(std::int32_t number) {
  return {{number, 1'500'000 + number, 22'700'000 + number}, {1 + number, 20 + number, 300 + number}, 9000 + number};
}

TEST(SavedRecord, UsesTheCrcOfEveryTextbook) {
  const std::string_view text = "123456789";
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  EXPECT_EQ(crc32(bytes), 0xCBF43926U);  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(crc32({}), 0U);
}

TEST(SavedRecord, HasTheLayoutThatItsHeaderStates) {
  const SavedRecord record = encode({{0x01020304, 2, 3}, {4, 5, 6}, 7}, 0xA1B2C3D4, 0x0A0B0C0D);
  const std::uint8_t start[] = {'S',  'T',  'I',  'D',  1,    0,    0,    0,    0x0D, 0x0C,
                                0x0B, 0x0A, 0xD4, 0xC3, 0xB2, 0xA1, 0x04, 0x03, 0x02, 0x01};
  for (std::size_t i = 0; i < sizeof start; ++i) EXPECT_EQ(record[i], start[i]) << i;
  EXPECT_EQ(record[28], 4);
  EXPECT_EQ(record[40], 7);
}

TEST(SavedRecord, ComesBackAsItWas) {
  SavedEstimate read;
  EXPECT_EQ(decode(encode(estimate(1), kWheel, 5), kWheel, read), Status::kOk);
  EXPECT_EQ(read, estimate(1));
}

TEST(SavedRecord, IsRefusedWithAnyBitFlipped) {
  const SavedRecord whole = encode(estimate(1), kWheel, 5);
  for (std::size_t bit = 0; bit < 8 * kSavedBytes; ++bit) {
    SavedRecord record = whole;
    record[bit / 8] = static_cast<std::uint8_t>(record[bit / 8] ^ (1U << (bit % 8)));
    SavedEstimate read = estimate(99);
    EXPECT_EQ(decode(record, kWheel, read), Status::kCorrupt) << "bit " << bit;
    EXPECT_EQ(read, estimate(99));
  }
}

TEST(SavedRecord, IsRefusedWithAnyTwoBitsFlippedAndAnyBurst) {
  const SavedRecord whole = encode(estimate(1), kWheel, 5);
  SavedEstimate read;
  for (std::size_t a = 0; a < 8 * kSavedBytes; ++a) {
    for (std::size_t b = a + 1; b < 8 * kSavedBytes; ++b) {
      SavedRecord record = whole;
      record[a / 8] = static_cast<std::uint8_t>(record[a / 8] ^ (1U << (a % 8)));
      record[b / 8] = static_cast<std::uint8_t>(record[b / 8] ^ (1U << (b % 8)));
      ASSERT_EQ(decode(record, kWheel, read), Status::kCorrupt) << "bits " << a << ", " << b;
    }
  }
  std::mt19937_64 random(test::seed(40));
  for (int i = 0; i < 100'000; ++i) {
    SavedRecord record = whole;
    const std::size_t at = random() % (kSavedBytes - 3);
    auto burst = static_cast<std::uint32_t>(random());
    if (burst == 0) burst = 1;
    for (std::size_t k = 0; k < 4; ++k) record[at + k] = static_cast<std::uint8_t>(record[at + k] ^ (burst >> (8 * k)));
    ASSERT_EQ(decode(record, kWheel, read), Status::kCorrupt);
  }
}

/// An intact record with other bytes at `at`.
SavedRecord forged(std::size_t at, std::uint32_t value) {
  SavedRecord record = encode(estimate(1), kWheel, 5);
  for (std::size_t i = 0; i < 4; ++i) record[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
  const std::uint32_t crc = crc32(std::span(record).first(44));
  for (std::size_t i = 0; i < 4; ++i) record[44 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  return record;
}

TEST(SavedRecord, IsRefusedOfAnotherVersionOrWheelOrWithNumbersThatNoSaveWrites) {
  SavedEstimate read;
  EXPECT_EQ(decode(forged(4, 1), kWheel, read), Status::kOk);
  EXPECT_EQ(decode(forged(4, 2), kWheel, read), Status::kOutOfRange);
  EXPECT_EQ(decode(forged(12, kWheel + 1), kWheel, read), Status::kOutOfRange);
  for (const std::size_t at : {16U, 20U, 24U, 28U, 32U, 36U, 40U}) {
    EXPECT_EQ(decode(forged(at, 0), kWheel, read), Status::kOutOfRange) << at;
    EXPECT_EQ(decode(forged(at, 0x80000000U), kWheel, read), Status::kOutOfRange) << at;
  }
  EXPECT_EQ(decode(forged(0, 0), kWheel, read), Status::kCorrupt);
}

/// Memory that loses power: a write stops after `bytes_left` bytes, and the rest of the slot is what the kind of memory
/// makes of it.
struct Memory {
  enum class Rest { kOld, kErased, kGarbage };

  Status read(int slot, SavedRecord& into) {
    if (broken) return Status::kIoError;
    into = slots[static_cast<std::size_t>(slot)];
    return Status::kOk;
  }
  Status write(int slot, const SavedRecord& from) {
    if (broken) return Status::kIoError;
    SavedRecord& place = slots[static_cast<std::size_t>(slot)];
    for (std::size_t i = 0; i < kSavedBytes; ++i) {
      if (i < bytes_left) {
        place[i] = from[i];
      } else if (rest == Rest::kErased) {
        place[i] = 0xFF;
      } else if (rest == Rest::kGarbage) {
        place[i] = static_cast<std::uint8_t>(37 * i + 11);
      }
    }
    last_slot = slot;
    return Status::kOk;
  }

  std::array<SavedRecord, 2> slots = [] {
    SavedRecord erased;
    erased.fill(0xFF);
    return std::array<SavedRecord, 2>{erased, erased};
  }();
  std::size_t bytes_left = kSavedBytes;
  Rest rest = Rest::kOld;
  bool broken = false;
  int last_slot = -1;
};

TEST(TwoSlots, TakeTurns) {
  Memory memory;
  TwoSlots slots(memory, kWheel);
  SavedEstimate read;
  EXPECT_EQ(slots.load(read), Status::kNoData);
  for (std::int32_t k = 0; k < 10; ++k) {
    ASSERT_EQ(slots.save(estimate(k + 1)), Status::kOk);
    EXPECT_EQ(memory.last_slot, k % 2);
    ASSERT_EQ(slots.load(read), Status::kOk);
    EXPECT_EQ(read, estimate(k + 1));
  }
}

TEST(TwoSlots, PowerLostAtAnyByteLeavesAGoodRecord) {
  for (const Memory::Rest rest : {Memory::Rest::kOld, Memory::Rest::kErased, Memory::Rest::kGarbage}) {
    for (int saves_before = 1; saves_before <= 3; ++saves_before) {
      for (std::size_t cut = 0; cut <= kSavedBytes; ++cut) {
        Memory memory;
        memory.rest = rest;
        TwoSlots slots(memory, kWheel);
        for (int k = 1; k <= saves_before; ++k) ASSERT_EQ(slots.save(estimate(k)), Status::kOk);
        memory.bytes_left = cut;
        ASSERT_EQ(slots.save(estimate(50)), Status::kOk);  // the power goes before anybody hears of it
        SavedEstimate read;
        ASSERT_EQ(slots.load(read), Status::kOk) << cut;
        // Erasing memory that loses the last bytes of a record that ends in 0xFF would have it whole: none does here.
        EXPECT_EQ(read, estimate(cut == kSavedBytes ? 50 : saves_before)) << cut;

        // And the next save works, and again spares the good one.
        memory.bytes_left = cut;
        ASSERT_EQ(slots.save(estimate(60)), Status::kOk);
        memory.bytes_left = kSavedBytes;
        ASSERT_EQ(slots.save(estimate(70)), Status::kOk);
        ASSERT_EQ(slots.load(read), Status::kOk);
        EXPECT_EQ(read, estimate(70));
      }
    }
  }
}

TEST(TwoSlots, GenerationsWrap) {
  Memory memory;
  memory.slots[0] = encode(estimate(1), kWheel, 0xFFFFFFFEU);
  memory.slots[1] = encode(estimate(2), kWheel, 0xFFFFFFFFU);
  TwoSlots slots(memory, kWheel);
  SavedEstimate read;
  for (std::int32_t k = 3; k < 8; ++k) {
    ASSERT_EQ(slots.save(estimate(k)), Status::kOk);
    ASSERT_EQ(slots.load(read), Status::kOk);
    EXPECT_EQ(read, estimate(k));
  }
}

TEST(TwoSlots, SayWhyThereIsNothing) {
  Memory memory;
  TwoSlots slots(memory, kWheel);
  SavedEstimate read = estimate(9);
  for (SavedRecord& slot : memory.slots) slot.fill(0);
  EXPECT_EQ(slots.load(read), Status::kNoData);
  memory.slots[0][7] = 3;
  EXPECT_EQ(slots.load(read), Status::kCorrupt);
  memory.slots[1] = encode(estimate(1), kWheel + 1, 1);
  EXPECT_EQ(slots.load(read), Status::kOutOfRange);
  // The wheel was changed: what was learned on this one is written over the older slot and found again.
  EXPECT_EQ(slots.save(estimate(2)), Status::kOk);
  EXPECT_EQ(slots.load(read), Status::kOk);
  EXPECT_EQ(read, estimate(2));
  memory.broken = true;
  EXPECT_EQ(slots.load(read), Status::kIoError);
  EXPECT_EQ(slots.save(read), Status::kIoError);
}

}  // namespace
}  // namespace steerid
