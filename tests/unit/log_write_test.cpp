// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "log/csv_writer.hpp"
#include "log/log_reader.hpp"
#include "log/whole_file.hpp"
#include "support/property.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::test {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

/// Any finite double, the subnormal and the largest ones too: 64 random bits.
rc::Gen<double> any_finite() {
  return rc::gen::suchThat(rc::gen::map(rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>()),
                                        [](std::uint64_t bits) { return std::bit_cast<double>(bits); }),
                           [](double value) { return std::isfinite(value); });
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

TEST(LogWrite, ReadingGivesTheSameBitsBack) {
  const TemporaryFolder folder;
  check_property(20260101, 200, [&] {
    const auto intervals_us =
        *rc::gen::resize(200, rc::gen::suchThat(rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 20'001)),
                                                [](const std::vector<int>& v) { return v.size() >= kFewestRows; }));
    const auto start_us = *rc::gen::inRange<std::int64_t>(-1'000'000'000, 2'000'000'000'000'000);
    Record record;
    std::int64_t stamp_us = start_us;
    for (const int interval_us : intervals_us) {
      stamp_us += interval_us;
      record.time_s.push_back(static_cast<double>(stamp_us) / 1e6);
    }
    const auto column = rc::gen::container<std::vector<double>>(record.size(), any_finite());
    record.torque_driver_nm = *column;
    record.torque_motor_nm = *column;
    record.angle_rad = *column;
    const bool car = *rc::gen::arbitrary<bool>();
    if (car) {
      record.torque_driver_nm.assign(record.size(), 0.0);
      record.torque_bar_nm = *column;
      record.torque_rim_nm = *column;
      record.probe_nm = *column;
      record.channels = kAngleValid | kTorqueMotorValid | kTorqueBarValid | kTorqueRimValid | kProbeValid;
    }
    // Stamps of an epoch in seconds have steps of 0.24 us, so that equal ones cannot arise.
    const auto path = folder.path() / "record.csv";
    write_record(path, record, {"a comment", "time_s\nis not a row"});
    const Record back = read_log(path);
    RC_ASSERT(same_bits(back.time_s, record.time_s));
    RC_ASSERT(same_bits(back.torque_driver_nm, record.torque_driver_nm));
    RC_ASSERT(same_bits(back.torque_motor_nm, record.torque_motor_nm));
    RC_ASSERT(same_bits(back.angle_rad, record.angle_rad));
    RC_ASSERT(same_bits(back.torque_bar_nm, record.torque_bar_nm));
    RC_ASSERT(same_bits(back.torque_rim_nm, record.torque_rim_nm));
    RC_ASSERT(same_bits(back.probe_nm, record.probe_nm));
    RC_ASSERT(back.channels == record.channels);
  });
}

TEST(LogWrite, CellsAreSpelledOut) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "out.csv";
  CsvWriter csv(path, {"a", "b,c", "state"}, {"made by a test"});
  csv.cell(0.1).cell(2.0 / 3.0, 3).cell("not excited").end_row();
  csv.cell(1e-7).cell(-0.0, 1).cell("say \"hm\",\nthen").end_row();
  csv.cell(std::numeric_limits<double>::quiet_NaN())
      .cell(std::numeric_limits<double>::infinity(), 2)
      .cell("")
      .end_row();
  csv.commit();
  EXPECT_EQ(contents(path),
            "# made by a test\n"
            "a,\"b,c\",state\n"
            "0.1,0.667,not excited\n"
            "1e-07,-0.0,\"say \"\"hm\"\", then\"\n"
            ",,\n");
}

TEST(LogWrite, ARowOfTheWrongLengthIsAFaultOfTheProgram) {
  const TemporaryFolder folder;
  CsvWriter csv(folder.path() / "out.csv", {"a", "b"});
  csv.cell(1.0);
  EXPECT_THROW(csv.end_row(), std::logic_error);
}

TEST(WholeFile, AppearsAtCommitAndNotBefore) {
  const TemporaryFolder folder;
  const auto path = folder.file("out.txt", "old");
  {
    WholeFile file(path);
    file.write(std::string(1'000'000, 'x'));  // more than any buffer
    EXPECT_EQ(contents(path), "old");
    file.commit();
    EXPECT_EQ(contents(path).size(), 1'000'000U);
  }
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(WholeFile, WithoutCommitNothingIsLeft) {
  const TemporaryFolder folder;
  const auto kept = folder.file("kept.txt", "old");
  for (const auto& path : {kept, folder.path() / "new.txt"}) {
    try {
      WholeFile file(path);
      file.write(std::string(1'000'000, 'x'));
      throw std::runtime_error("in the middle of the work");
    } catch (const std::runtime_error&) {
    }
  }
  EXPECT_EQ(contents(kept), "old");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(WholeFile, KeepsPermissionsAndFollowsLinks) {
  const TemporaryFolder folder;
  const auto real = folder.file("real.txt", "old");
  std::filesystem::permissions(real, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::create_symlink("real.txt", folder.path() / "link.txt");
  write_whole_file(folder.path() / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.txt"));
  EXPECT_EQ(contents(real), "new");
  EXPECT_EQ(static_cast<unsigned>(std::filesystem::status(real).permissions()), 0600U);
}

TEST(WholeFile, ADeviceStaysADevice) {
  write_whole_file("/dev/null", "gone");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

std::string refusal(const std::filesystem::path& path) {
  try {
    write_whole_file(path, std::string(1'000'000, 'x'));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "was written";
}

TEST(WholeFile, BadPlacesEachWithASentence) {
  const TemporaryFolder folder;
  const std::string name = folder.path().string();
  EXPECT_EQ(refusal(folder.path()), name + ": expected the name of a file to write, found a folder; name a file in it");
  EXPECT_EQ(refusal(folder.path() / ""),
            name + "/: expected the name of a file to write, found a folder; name a file in it");
  EXPECT_EQ(refusal("no/such/out.csv"),
            "no/such/out.csv: expected an existing folder to write to, found no folder \"no/such\"; create it first");
  EXPECT_EQ(refusal("/dev/full"),
            "/dev/full: expected room to write, found \"No space left on device\"; choose another place or free this "
            "one");
  EXPECT_EQ(refusal("/proc/out.csv"),
            "/proc/out.csv: expected a folder that can be written to, found \"No such file or directory\"; choose "
            "another place or free this one");
}

}  // namespace
}  // namespace steerid::test
