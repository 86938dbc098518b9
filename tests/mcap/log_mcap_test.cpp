// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// MCAP files that @mcap/core has written: what is read is what was put in; and what is no MCAP ends in one sentence.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/packed_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::test {
namespace {

constexpr const char* kColumns = "angle=/joint_states/position[0]:rad,torque_bar=/bar/data:nm";
constexpr double kFirstS = 1795613219.0;  // of write_logs.mjs

class McapLogs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const std::string line = STEERID_WRITE_MCAP_LOGS " '" + folder_->path().string() + "'";
    wrote_ = std::system(line.c_str()) == 0;  // NOLINT(cert-env33-c): our own command with our own words
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_TRUE(wrote_) << "write_logs.mjs: are node, lz4 and npm's packages there?"; }

  [[nodiscard]] static std::filesystem::path file(const std::string& name) { return folder_->path() / name; }
  [[nodiscard]] static std::string bytes_of(const std::string& name) {
    std::stringstream bytes;
    bytes << std::ifstream(file(name), std::ios::binary).rdbuf();
    return bytes.str();
  }
  static void write(const std::string& name, const std::string& bytes) {
    std::ofstream(file(name), std::ios::binary) << bytes;
  }
  [[nodiscard]] static std::string refusal(const std::string& name) {
    try {
      (void)read_log(file(name), {.columns = parse_columns(kColumns)});
    } catch (const BadInput& error) {
      return error.what();
    }
    return "was read";
  }

  static inline TemporaryFolder* folder_ = nullptr;
  static inline bool wrote_ = false;
};

void expect_the_drive(const Record& record, std::size_t fewest) {
  ASSERT_GE(record.size(), fewest);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double at_s = record.time_s[i] - kFirstS;
    ASSERT_NEAR(record.torque_bar_nm[i], 2 * std::cos(3 * at_s), 2e-6) << at_s;  // a stamp of 1.8e9 s has 0.24 us
    // By the header's stamps: by the recorder's, 2 ms later, it would be off by up to 0.4 * 4 * .002 = 3.2e-3. The
    // cubic beside an end errs by at most step^4 times the fourth derivative: 1e-8 * 0.4 * 4^4 = 1e-6.
    ASSERT_NEAR(record.angle_rad[i], 0.4 * std::sin(4 * at_s), 3e-6) << at_s;
  }
}

TEST_F(McapLogs, NumbersAreWhatWasPutIn) {
  for (const char* log :
       {"cdr_none.mcap", "cdr_lz4.mcap", "cdr_zstd.mcap", "cdr_loose.mcap", "json.mcap", "shuffled.mcap"}) {
    SCOPED_TRACE(log);
    RecordQuality seen;
    const Record record = read_log(file(log), {.columns = parse_columns(kColumns)}, &seen);
    EXPECT_EQ(record.channels, kAngleValid | kTorqueBarValid);
    expect_the_drive(record, 599);
    std::string notes;
    for (const std::string& note : seen.notes) notes += note + "\n";
    EXPECT_NE(notes.find("not read: /other (protobuf with schema protobuf)"), std::string::npos) << notes;
  }
}

TEST_F(McapLogs, EveryFieldOfThePlainMessagesIsAColumn) {
  for (const char* log : {"cdr_zstd.mcap", "json.mcap"}) {
    std::string names;
    const auto logs = open_logs({file(log)}, {});
    for (const LogColumn& column : logs.front().source->columns()) names += column.name + " ";
    for (const char* name :
         {"/bar/data ", "/joint_states/header/stamp/sec ", "/joint_states/position[1] ", "/joint_states/effort[0] ",
          "/joint_states/engaged ", "/joint_states/gear ", "/picture/height ", "/picture/centre[1] "}) {
      EXPECT_NE(names.find(name), std::string::npos) << names;
    }
    EXPECT_EQ(names.find("/picture/data"), std::string::npos) << "a picture is no channel: " << names;
    EXPECT_EQ(names.find("MODE_FREE"), std::string::npos) << "a constant is not in the message: " << names;
  }
}

TEST_F(McapLogs, AFileThatWasNotFinishedIsReadUpToThere) {
  const std::string whole = bytes_of("cdr_none.mcap");
  std::size_t read = 0;
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 50) {
    write("cut.mcap", whole.substr(0, length));
    try {
      const Record record = read_log(file("cut.mcap"), {.columns = parse_columns(kColumns)});
      expect_the_drive(record, 50);
      ++read;
    } catch (const BadInput&) {  // too short for a record
    }
  }
  EXPECT_GT(read, 30U);
}

TEST_F(McapLogs, AChunkThatIsDamagedIsRefused) {
  for (const char* log : {"cdr_none.mcap", "cdr_lz4.mcap", "cdr_zstd.mcap"}) {
    std::string bytes = bytes_of(log);
    bytes[1000] = static_cast<char>(bytes[1000] ^ 1);  // of the first chunk
    write("damaged.mcap", bytes);
    const std::string sentence = refusal("damaged.mcap");
    EXPECT_NE(sentence.find("damaged.mcap: expected a chunk that "), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("or mend it by `mcap recover`"), std::string::npos) << sentence;
  }
}

TEST_F(McapLogs, WhatNobodyCanReadIsNamed) {
  EXPECT_NE(refusal("cdr_none.mcap"), "");
  write("none.mcap", bytes_of("cdr_none.mcap").substr(0, 30));
  EXPECT_NE(refusal("none.mcap").find("expected messages with numbers, in JSON or in ROS 2's CDR"), std::string::npos)
      << refusal("none.mcap");
}

TEST(PackedBytes, ComeBackAndPromiseNothingTheyDoNotHold) {
  const std::string bytes(3'000'000, 'x');
  const std::string packed = packed_by_zstd(bytes);
  EXPECT_LT(packed.size(), 1000U);
  EXPECT_EQ(unpacked("zstd", packed, bytes.size()), bytes);
  EXPECT_FALSE(unpacked("zstd", packed, bytes.size() + 1));
  EXPECT_FALSE(unpacked("zstd", packed.substr(0, packed.size() / 2), bytes.size()));
  EXPECT_FALSE(unpacked("lz4", packed, bytes.size()));
  EXPECT_FALSE(unpacked("zstd", "", std::uint64_t{1} << 40));
  EXPECT_FALSE(unpacked("bz2", packed, bytes.size()));
  EXPECT_EQ(crc32_of("123456789"), 0xcbf43926U);  // the check value of this CRC
}

}  // namespace
}  // namespace steerid::test
