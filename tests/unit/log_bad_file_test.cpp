// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every bad file ends in BadInput with exactly one sentence: the sentences are the reader's interface to people, so
// they are spelled out here.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <ios>
#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log_text.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::test {
namespace {

struct BadFile {
  std::string what;
  std::string text;
  std::string sentence;
  LogFormat format{};
};

std::string rows_apart(int count, double apart) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{},1,1,1\n", apart * i);
  return text;
}

const std::string kGood = kHeader + rows(60);  // lines 1 to 61

std::vector<BadFile> bad_files() {
  return {
      {"empty", "", "drive.csv: expected a header line and rows, found an empty file; check that the log was written"},
      {"comments only", "# a\n\n# b",
       "drive.csv: expected a header line and rows, found an empty file; check that the log was written"},
      {"no header", rows(60),
       "drive.csv, line 1: expected a header with the columns' names, found \"0.00,0,-0,0\"; put a line such as "
       "time_s,torque_bar_nm,angle_rad above the rows"},
      {"no time", "t,torque_motor_nm,angle_rad\n1,2,3\n",
       "drive.csv, line 1: expected a column time_s, found \"t\", \"torque_motor_nm\", \"angle_rad\"; name it with "
       "--columns time=t, or see what `steerid inspect` proposes"},
      {"no angle", "# comment\ntime_s,torque_motor_nm\n1,2\n",
       "drive.csv, line 2: expected a column angle_rad, found \"time_s\", \"torque_motor_nm\"; name it with --columns "
       "angle=COLUMN, or see what `steerid inspect` proposes"},
      {"no torque", "time_s,angle_rad\n1,2\n",
       "drive.csv, line 1: expected a column torque_bar_nm, torque_rim_nm, torque_driver_nm or torque_motor_nm, found "
       "\"time_s\", \"angle_rad\"; name it with --columns torque_bar=COLUMN, or see what `steerid inspect` proposes"},
      {"a probe alone", "time_s,probe_nm,angle_rad\n1,2,3\n",
       "drive.csv, line 1: expected a column torque_bar_nm, torque_rim_nm, torque_driver_nm or torque_motor_nm, found "
       "\"time_s\", \"probe_nm\", \"angle_rad\"; name it with --columns torque_bar=COLUMN, or see what `steerid "
       "inspect` proposes"},
      {"all of it called otherwise, with likely candidates",
       "Zeit [ms];Lenkwinkel [deg];Motormoment [Nm];Gang\n1;2;3;4\n",
       "drive.csv, line 1: expected columns time_s; angle_rad; torque_bar_nm, torque_rim_nm, torque_driver_nm or "
       "torque_motor_nm, found \"Zeit [ms]\", \"Lenkwinkel [deg]\", \"Motormoment [Nm]\", \"Gang\"; name them with "
       "--columns time=Zeit [ms],angle=Lenkwinkel [deg],torque_motor=Motormoment [Nm], or see what `steerid inspect` "
       "proposes"},
      {"a column that was asked for",
       kGood,
       "drive.csv, line 1: expected a column \"force_n\" for torque_motor, found \"time_s\", \"torque_driver_nm\", "
       "\"torque_motor_nm\", \"angle_rad\"; name the column with --columns torque_motor=torque_motor_nm",
       {.columns = parse_columns("torque_motor=force_n")}},
      {"many columns", "a,b,c,d,e,f,g,h,i,j\n",
       "drive.csv, line 1: expected columns time_s; angle_rad; torque_bar_nm, torque_rim_nm, torque_driver_nm or "
       "torque_motor_nm, found \"a\", \"b\", \"c\", \"d\", \"e\", \"f\", \"g\", \"h\" and 2 more; name them with "
       "--columns time=COLUMN,angle=COLUMN,torque_bar=COLUMN, or see what `steerid inspect` proposes"},
      {"a column twice", "time_s,torque_motor_nm,angle_rad,angle_rad\n1,2,3,4\n",
       "drive.csv, line 1, column 'angle_rad': expected each column's name once, found it twice; rename one of the "
       "two"},
      {"one column for two channels",
       kGood,
       "drive.csv, line 1, column 'torque_motor_nm': expected one channel for the column, found torque_driver and "
       "torque_motor; name the column of torque_motor with --columns",
       {.columns = parse_columns("torque_driver=torque_motor_nm,torque_motor=Torque_motor_nm")}},
      {"a quote open in the header", "time_s,\"torque_motor_nm,angle_rad\n1,2,3\n",
       "drive.csv, line 1: expected names of columns with every quote closed, found "
       "\"time_s,\"torque_motor_nm,angle_rad\"; close the quote"},
      {"text for a number", kGood + "0.60,1,abc,2\n",
       "drive.csv, line 62, column 'torque_motor_nm': expected a number, found \"abc\"; leave the cell empty where "
       "nothing was measured"},
      {"a number and more", kGood + "0.60,1,2,2.5rad\n",
       "drive.csv, line 62, column 'angle_rad': expected a number, found \"2.5rad\"; leave the cell empty where "
       "nothing was measured"},
      {"hexadecimal", kGood + "0.60,1,2,0x10\n",
       "drive.csv, line 62, column 'angle_rad': expected a number, found \"0x10\"; leave the cell empty where "
       "nothing "
       "was measured"},
      {"a mark for thousands", "time_s;torque_motor_nm;angle_rad\n0,01;1;2\n0,02;1.000,5;2\n",
       "drive.csv, line 3, column 'torque_motor_nm': expected a number, found \"1.000,5\"; write numbers without a "
       "mark "
       "for the thousands, with one decimal point or comma"},
      {"a percentage",
       "time_s;torque;angle_rad\ns;%;rad\n0,01;1;2\n",
       "drive.csv, line 1, column 'torque': expected a unit of torque_motor (nm, mnm, cnm, danm, knm, lbft, lbin, "
       "kgfm, n), found \"%\"; "
       "say how much one of it is, as --columns torque_motor=torque:nm*SCALE",
       {.columns = parse_columns("torque_motor=torque")}},
      {"binary rubbish", kGood + std::string("0.60,1,2,\x01\xff\x1b[2J\n"),
       "drive.csv, line 62, column 'angle_rad': expected a number, found \"\\x01\u00ff\\x1b[2J\"; leave the cell "
       "empty "
       "where nothing was measured"},
      {"names that are no ASCII", "time_s,angle_rad,wheel_\u00b0,\u65b9\u5411,\x1b[2J,\u2028\n",
       "drive.csv, line 1: expected a column torque_bar_nm, torque_rim_nm, torque_driver_nm or torque_motor_nm, found "
       "\"time_s\", \"angle_rad\", \"wheel_\u00b0\", \"\u65b9\u5411\", \"\\x1b[2J\", \"\\xe2\\x80\\xa8\"; name it with "
       "--columns torque_bar=COLUMN, or see what `steerid inspect` proposes"},
      {"names in Latin-1", "time_s,angle_rad,wheel_\xb0,\xd6\n",
       "drive.csv, line 1: expected a column torque_bar_nm, torque_rim_nm, torque_driver_nm or torque_motor_nm, found "
       "\"time_s\", \"angle_rad\", \"wheel_\u00b0\", \"\u00d6\"; name it with --columns torque_bar=COLUMN, or see what "
       "`steerid inspect` proposes"},
      {"long rubbish", kGood + "0.60,1,2," + std::string(200, 'x') + "\n",
       "drive.csv, line 62, column 'angle_rad': expected a number, found \"" + std::string(40, 'x') +
           "...\"; leave the cell empty where nothing was measured"},
      {"infinite", kGood + "0.60,inf,2,3\n",
       "drive.csv, line 62, column 'torque_driver_nm': expected a finite number, found \"inf\"; leave the cell empty "
       "where nothing was measured"},
      {"minus infinity in words", kGood + "0.60,1,-Infinity,3\n",
       "drive.csv, line 62, column 'torque_motor_nm': expected a finite number, found \"-Infinity\"; leave the cell "
       "empty where nothing was measured"},
      {"beyond a double", kGood + "0.60,1,2,1e999\n",
       "drive.csv, line 62, column 'angle_rad': expected a finite number, found \"1e999\"; leave the cell empty "
       "where "
       "nothing was measured"},
      {"too few cells", kGood + "0.60,1,2\n",
       "drive.csv, line 62: expected 4 cells, found 3; complete the row or delete it"},
      {"too many cells", kGood + "0.60,1,2,3,4,5\n",
       "drive.csv, line 62: expected 4 cells, found 6; complete the row or delete it"},
      {"a quote open in a row", kGood + "0.60,1,2,\"3\n",
       "drive.csv, line 62: expected every quote closed, found \"0.60,1,2,\"3\"; complete the row or delete it"},
      {"text after a quote", kGood + "0.60,1,\"2\"5,3\n",
       "drive.csv, line 62: expected every quote closed, found \"0.60,1,\"2\"5,3\"; complete the row or delete it"},
      {"time going back", kGood + "0.01,1,2,3\n",
       "drive.csv, line 62, column 'time_s': expected a time after the 0.59 s of line 61, found 0.01 s; split the "
       "file "
       "where its clock goes back"},
      {"an epoch in milliseconds", std::string(kHeader) + "1795264527000,1,2,3\n",
       "drive.csv, line 2, column 'time_s': expected a time within 1e+10 s of zero, found 1.79526e+12 s; state the "
       "unit of time with --columns time=time_s:ms"},
      {"an epoch in microseconds", std::string(kHeader) + "1795264527000000,1,2,3\n",
       "drive.csv, line 2, column 'time_s': expected a time within 1e+10 s of zero, found 1.79526e+15 s; state the "
       "unit of time with --columns time=time_s:us"},
      {"an epoch in nanoseconds", std::string(kHeader) + "1795264527000000000,1,2,3\n",
       "drive.csv, line 2, column 'time_s': expected a time within 1e+10 s of zero, found 1.79526e+18 s; state the "
       "unit of time with --columns time=time_s:ns"},
      {"too slow", kHeader + rows_apart(60, 0.1),
       "drive.csv, column 'time_s': expected 50 rows a second or more, found 10 (median); record faster, or state "
       "the unit of time with --columns time=time_s:ms"},
      {"from zero in microseconds", kHeader + rows_apart(60, 1e4),
       "drive.csv, column 'time_s': expected 50 rows a second or more, found 0.0001 (median); record faster, or state "
       "the unit of time with --columns time=time_s:us"},
      {"from zero in nanoseconds", kHeader + rows_apart(1010, 1e7),
       "drive.csv, line 1003, column 'time_s': expected a time within 1e+10 s of zero, found 1.001e+10 s; state the "
       "unit of time with --columns time=time_s:ns"},
      {"too short", kHeader + rows(49),
       "drive.csv: expected at least 50 rows with values, found 49; record a longer drive"},
      {"header only", kHeader, "drive.csv: expected at least 50 rows with values, found 0; record a longer drive"},
      {"no values", std::string(kHeader) + ",,,\n,,,\n",
       "drive.csv: expected at least 50 rows with values, found 0; record a longer drive"},
      {"a line without end", kHeader + std::string(std::size_t{3} << 20, '7'),
       "drive.csv, line 2: expected lines shorter than 262144 bytes, found a longer one; check that this is a CSV "
       "text file"},
  };
}

TEST(LogBadFile, EachEndsInItsSentence) {
  for (const BadFile& bad : bad_files()) {
    SCOPED_TRACE(bad.what);
    try {
      (void)read_text(bad.text, bad.format);
      ADD_FAILURE() << "was read";
    } catch (const BadInput& error) {
      EXPECT_EQ(error.what(), bad.sentence);
    }
  }
}

std::string sentence_of(const std::filesystem::path& path) {
  try {
    (void)read_log(path);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "was read";
}

TEST(LogBadFile, AFolder) {
  const TemporaryFolder folder;
  EXPECT_EQ(sentence_of(folder.path()),
            folder.path().string() + ": expected a log, found a folder; name the file in it");
}

TEST(LogBadFile, NoSuchFile) {
  EXPECT_EQ(sentence_of("no/such.csv"),
            "no/such.csv: expected a readable file, found \"No such file or directory\"; check its name and "
            "permissions");
}

TEST(LogBadFile, NotPermitted) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const TemporaryFolder folder;
  const auto path = folder.file("drive.csv", kGood);
  std::filesystem::permissions(path, std::filesystem::perms::none);
  EXPECT_EQ(sentence_of(path), path.string() +
                                   ": expected a readable file, found \"Permission denied\"; check its name and "
                                   "permissions");
}

TEST(LogBadFile, AReadErrorIsNoEndOfFile) {
  // A process may not read its own memory at address zero: the file opens, the first read fails.
  const std::filesystem::path unreadable = "/proc/self/mem";
  if (!std::filesystem::exists(unreadable)) GTEST_SKIP() << "no /proc here";
  EXPECT_EQ(sentence_of(unreadable),
            "/proc/self/mem: expected a readable file, found a read error after 0 bytes; check the disk or copy the "
            "file anew");
}

}  // namespace
}  // namespace steerid::test
