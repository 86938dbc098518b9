// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One drive as spreadsheets, measurement tools and loggers write it, and as several of them write it together. The
// drive is a sum of two sines, so that its value at any time is known without the reader.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/time_text.hpp"
#include "log_text.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::test {
namespace {

double angle_rad(double at_s) { return 0.3 * std::sin(2 * std::numbers::pi * 0.9 * at_s) + 0.05 * std::sin(11 * at_s); }
double torque_nm(double at_s) { return 2.5 * std::cos(2 * std::numbers::pi * 1.3 * at_s) - 0.4 * at_s; }

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kRows = 120;
double stamp_s(std::size_t row) { return 0.01 * static_cast<double>(row); }

std::string with_commas(std::string text) {
  std::ranges::replace(text, '.', ',');
  return text;
}

/// A line a row, without the line's end.
std::string table(const std::string& header, const std::function<std::string(double)>& row) {
  std::string text = header;
  for (std::size_t i = 0; i < kRows; ++i) text += row(stamp_s(i)) + "\n";
  return text;
}

void expect_the_drive(const Record& record, double first_s, double tolerance) {
  ASSERT_EQ(record.size(), kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_NEAR(record.time_s[i] - first_s, stamp_s(i), 1e-6) << i;
    ASSERT_NEAR(record.angle_rad[i], angle_rad(stamp_s(i)), tolerance) << i;
    ASSERT_NEAR(record.torque_bar_nm[i], torque_nm(stamp_s(i)), 10 * tolerance) << i;
  }
}

std::string utf16(const std::string& latin_1, bool little, bool mark) {
  std::string out = mark ? (little ? "\xff\xfe" : "\xfe\xff") : "";
  for (const char c : latin_1) out += little ? std::string{c, '\0'} : std::string{'\0', c};
  return out;
}

const std::string kGermanHeader = "Zeit [ms];Lenkwinkel [\xb0];Lenkmoment [Nm]\r\n";  // Latin-1
constexpr const char* kGermanColumns = "time=Zeit [ms],angle=Lenkwinkel,torque_bar=lenkmoment";

std::string german_excel() {
  return table(kGermanHeader, [](double at_s) {
    return with_commas(fmt::format("{:.1f};{:.6f};{:.6f}\r", 1000 * at_s, kDegrees * angle_rad(at_s), torque_nm(at_s)));
  });
}

TEST(LogDialects, GermanExcelInEveryEncoding) {
  const LogFormat format{.columns = parse_columns(kGermanColumns)};
  expect_the_drive(read_text(german_excel(), format), 0, 1e-7);
  for (const bool little : {true, false}) {
    for (const bool mark : {true, false}) {
      expect_the_drive(read_text(utf16(german_excel(), little, mark), format), 0, 1e-7);
    }
  }
  std::string utf8 = german_excel();
  utf8.replace(utf8.find('\xb0'), 1, "\u00b0");
  expect_the_drive(read_text(utf8, format), 0, 1e-7);
  expect_the_drive(read_text("sep=;\r\n" + utf8, format), 0, 1e-7);
  RecordQuality noticed;
  (void)read_text(utf8, format, &noticed);
  EXPECT_TRUE(noticed.notes.empty()) << noticed.notes.front();  // every unit is stated
}

TEST(LogDialects, Utf16AcrossBlocksAndPairs) {
  // A block's end falls on every place of a pair of surrogates somewhere in the comments.
  std::u16string text;
  for (int i = 0; i < 40'000; ++i) text += std::u16string(u"#") + std::u16string(i % 7, u'-') + u"\U0001f600 \u20ac\n";
  text += u"time_s,torque_bar_nm,angle_rad\n";
  std::string bytes = "\xff\xfe";
  const auto append = [&](char16_t unit) {
    bytes += static_cast<char>(unit & 0xff);
    bytes += static_cast<char>(unit >> 8);
  };
  std::ranges::for_each(text, append);
  for (const char c :
       table("", [](double at_s) { return fmt::format("{},{},{}", at_s, torque_nm(at_s), angle_rad(at_s)); })) {
    append(static_cast<char16_t>(c));
  }
  expect_the_drive(read_text(bytes), 0, 1e-12);
}

TEST(LogDialects, ARowOfUnitsBelowTheNames) {
  const auto row = [](double at_s) {
    return fmt::format("{}\t{}\t{}\t3", 1e6 * at_s, 1000 * angle_rad(at_s), 100 * torque_nm(at_s));
  };
  const LogFormat format{.columns = parse_columns("time=time,angle=steer,torque_bar=tbar")};
  for (const char* units :
       {"us\tmrad\tNcm\t-\n", "[\u00b5s]\t[mrad]\t[Ncm]\t[]\n", "float\tfloat\tfloat\tint\nus\tmrad\tNcm\t1\n"}) {
    expect_the_drive(read_text(table(std::string("time\tsteer\ttbar\tgear\n") + units, row), format), 0, 1e-12);
  }
}

/// Spreadsheets on a Macintosh end lines so.
TEST(LogDialects, LinesThatEndInCarriageReturns) {
  std::string text = table("time_s,angle_rad,torque_bar_nm\n", [](double at_s) {
    return fmt::format("{:.3f},{:.8f},{:.7f}", at_s, angle_rad(at_s), torque_nm(at_s));
  });
  std::ranges::replace(text, '\n', '\r');
  expect_the_drive(read_text(text, {}), 0, 1e-7);
}

/// Two exports of one drive, one behind the other, each with its mark and its names and units.
TEST(LogDialects, NamesThatComeOnceMoreWhereALogWasAppended) {
  const std::string head = "\xef\xbb\xbftime,angle,torque_bar\ns,rad,Nm\n";
  std::string text = head;
  for (std::size_t i = 0; i < kRows; ++i) {
    if (i == kRows / 3) text += head;
    const double at_s = stamp_s(i);
    text += fmt::format("{:.3f},{:.8f},{:.7f}\n", at_s, angle_rad(at_s), torque_nm(at_s));
  }
  expect_the_drive(read_text(text, {}), 0, 1e-7);
  EXPECT_THROW((void)read_text(text + "time,angle,torque\n1.2,0,0\n", {}), BadInput);  // other names are no such
}

TEST(LogDialects, APreambleAboveTheNames) {
  const auto row = [](double at_s) { return fmt::format("{};{};{};", at_s, angle_rad(at_s), torque_nm(at_s)); };
  const std::string preamble = "CANape export\nVehicle;Mule 7\nStart;25.11.2026 13:26:19\n\n";
  expect_the_drive(read_text(table(preamble + "time_s;angle_rad;torque_bar_nm\n", row)), 0, 1e-12);
}

TEST(LogDialects, QuotedNamesOfPlotJuggler) {
  const auto row = [](double at_s) { return fmt::format("{},{},{}", at_s, angle_rad(at_s), torque_nm(at_s)); };
  const LogFormat format{.columns =
                             parse_columns(R"(time=__time,angle="/wheel/angle,left":rad,torque_bar=/eps/bar:nm)")};
  expect_the_drive(read_text(table("__time,\"/wheel/angle,left\",/eps/bar\n", row), format), 0, 1e-12);
}

TEST(LogDialects, StampsThatAreDates) {
  const auto text = [](const std::function<std::string(int, int)>& stamp) {
    return table("time;angle_rad;torque_bar_nm\n", [&](double at_s) {
      const auto ms = static_cast<int>(std::lround(1000 * at_s));
      return stamp(59 + ms / 1000, ms % 1000) + fmt::format(";{};{}", angle_rad(at_s), torque_nm(at_s));
    });
  };
  // Over a full minute, so that minutes count too.
  const auto of = [](int s) { return fmt::format("{:02}:{:02}", 26 + s / 60, s % 60); };
  constexpr double kFirst = 1795613219.0;  // date -u -d '2026-11-25 13:26:59' +%s
  expect_the_drive(read_text(text([&](int s, int ms) { return fmt::format("2026-11-25T13:{}.{:03}Z", of(s), ms); })),
                   kFirst, 1e-12);
  expect_the_drive(
      read_text(text([&](int s, int ms) { return fmt::format("2026-11-25 14:{},{:03} +01:00", of(s), ms); })), kFirst,
      1e-12);
  expect_the_drive(read_text(text([&](int s, int ms) { return fmt::format("25.11.2026 13:{}.{:03}", of(s), ms); })),
                   kFirst, 1e-12);
  expect_the_drive(read_text(text([&](int s, int ms) { return fmt::format("25-Nov-2026 13:{}.{:03}", of(s), ms); })),
                   kFirst, 1e-12);
  expect_the_drive(read_text(text([&](int s, int ms) { return fmt::format("00:{}.{:03}", of(s), ms); })), 26 * 60 + 59,
                   1e-12);
  expect_the_drive(read_text(text([&](int s, int ms) { return fmt::format("{}.{:03} sec", s, ms); })), 59, 1e-12);
  RecordQuality noticed;  // a date needs no unit
  (void)read_text(text([&](int s, int ms) { return fmt::format("25.11.2026 13:{}.{:03}", of(s), ms); }), {}, &noticed);
  for (const std::string& note : noticed.notes) EXPECT_EQ(note.find("time"), std::string::npos) << note;
}

TEST(LogDialects, WhatIsNoDate) {
  for (const char* text :
       {"", ":", "2026-13-01 00:00:00", "2026-02-30T00:00:00", "25/11/2026 13:26:19", "25:00:00", "12:60", "12:00:61",
        "2026-11-25", "2026-11-25T", "12:00:00x", "12:00:00+1", "1 min", "x sec", "nan s"}) {
    EXPECT_FALSE(seconds_of(text)) << text;
  }
  EXPECT_EQ(seconds_of("2000-02-29T00:00:00Z"), 951782400.0);  // date -u -d 2000-02-29 +%s
}

TEST(LogDialects, NamesWithAnotherUnitThanTheContracts) {
  const auto row = [](double at_s) {
    return fmt::format("{},{},{}", 1000 * at_s, kDegrees * angle_rad(at_s), 1000 * torque_nm(at_s));
  };
  expect_the_drive(read_text(table("time_ms,angle_deg,torque_bar_mnm\n", row)), 0, 1e-12);
  expect_the_drive(read_text(table("Time [ms],Angle (deg),Torque_Bar [mNm]\n", row)), 0, 1e-12);
}

TEST(LogDialects, UnitsOfOtherPlaces) {
  // 1 lbf = 0.45359237 kg * 9.80665 m/s2, 1 ft = 0.3048 m, 1 in = 0.0254 m.
  for (const auto& [unit, in_nm] : std::vector<std::pair<std::string, double>>{{"daNm", 10},
                                                                               {"cNm", 0.01},
                                                                               {"kgf.m", 9.80665},
                                                                               {"lbf-in", 4.4482216152605 * 0.0254},
                                                                               {"in-lb", 4.4482216152605 * 0.0254},
                                                                               {"ft-lb", 4.4482216152605 * 0.3048}}) {
    for (const std::string turns : {"turn", "rev", "Umdrehungen"}) {
      const auto row = [&, in = in_nm](double at_s) {
        return fmt::format("{},{},{}", at_s, angle_rad(at_s) / (2 * std::numbers::pi), torque_nm(at_s) / in);
      };
      const std::string header = fmt::format("time_s,angle [{}],torque_bar [{}]\n", turns, unit);
      expect_the_drive(read_text(table(header, row)), 0, 1e-11);
    }
  }
}

TEST(LogDialects, WhatProgramsWriteWhereThereIsNoNumber) {
  for (const char* word :
       {"#DIV/0!", "#N/A", "#NV", "#BEZUG!", "#NAME?", "-", "--", "1.#QNAN", "-nan(ind)", "NaN", ""}) {
    int rows = 0;
    const std::string text = table("time_s,angle_rad,torque_bar_nm\n", [&](double at_s) {
      const std::string torque = ++rows % 10 == 5 ? word : fmt::format("{}", torque_nm(at_s));
      return fmt::format("{},{},{}", at_s, angle_rad(at_s), torque);
    });
    RecordQuality noticed;
    EXPECT_EQ(read_text(text, {}, &noticed).size(), kRows - kRows / 10) << word;
    EXPECT_EQ(noticed.dropped_rows, kRows / 10) << word;
  }
  EXPECT_THROW(read_text(table("time_s,angle_rad,torque_bar_nm\n", [](double) { return "0,0,#"; })), BadInput);
}

TEST(LogDialects, Counts) {
  const auto row = [](double at_s) {
    return fmt::format("{},{},{}", at_s, (kDegrees * angle_rad(at_s) + 180) / 0.0219, (torque_nm(at_s) - 10) / -0.005);
  };
  const LogFormat format{.columns = parse_columns("angle=enc:deg*0.0219-180,torque_bar=adc:nm*-0.005+10")};
  expect_the_drive(read_text(table("time_s,enc,adc\n", row), format), 0, 1e-10);
}

TEST(LogDialects, RowsThatRepeatTheOneBefore) {
  std::string text = "time_s,torque_bar_nm,angle_rad\n";
  for (std::size_t i = 0; i < kRows; ++i) {
    const std::string row = fmt::format("{},{},{}\n", stamp_s(i), torque_nm(stamp_s(i)), angle_rad(stamp_s(i)));
    text += i % 10 == 3 ? row + row + row : row;
  }
  RecordQuality noticed;
  expect_the_drive(read_text(text, {}, &noticed), 0, 1e-12);
  EXPECT_EQ(noticed.notes, std::vector<std::string>{"24 rows that repeat the one before left out"});
}

TEST(LogDialects, StampsOfTooFewDigitsAreSpread) {
  // 500 Hz with hundredths of a second: five rows a stamp.
  std::string text = "time_s,torque_bar_nm,angle_rad\n";
  for (int i = 0; i < 500; ++i) {
    text += fmt::format("{},{},{}\n", 0.01 * (i / 5), torque_nm(0.002 * i), angle_rad(0.002 * i));
  }
  RecordQuality noticed;
  const Record record = read_text(text, {}, &noticed);
  ASSERT_EQ(record.size(), 500U);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_NEAR(record.time_s[i], 0.002 * static_cast<double>(i), 1e-12) << i;
  ASSERT_EQ(noticed.notes.size(), 1U);
  EXPECT_TRUE(noticed.notes[0].starts_with("400 rows share the stamp of the one before")) << noticed.notes[0];
}

// ---- several clocks ----

/// Samples of one signal: "time,value" a line.
std::string samples(const std::string& header, double first_s, double step_s, std::size_t count,
                    double (*value)(double)) {
  std::string text = header;
  for (std::size_t i = 0; i < count; ++i) {
    const double at_s = first_s + step_s * static_cast<double>(i);
    text += fmt::format("{},{}\n", at_s, value(at_s));
  }
  return text;
}

/// The error of the cubic through four samples `step_s` apart is at most 3/128 step^4 times the fourth derivative
/// between the inner two, and at most step^4/24 times it beside an end (Lagrange's remainder).
double cubic_error(double step_s, double fourth_derivative) { return std::pow(step_s, 4) / 24 * fourth_derivative; }
constexpr double kAngleFourth = 0.3 * 1022.6 + 0.05 * 14641;  // (2 pi .9)^4 = 1022.6, 11^4 = 14641
constexpr double kTorqueFourth = 2.5 * 4451.5;                // (2 pi 1.3)^4 = 4451.5

void expect_on_the_curves(const Record& record, double torque_step_s, double angle_step_s) {
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double at_s = record.time_s[i];
    ASSERT_NEAR(record.torque_bar_nm[i], torque_nm(at_s), 1e-12 + cubic_error(torque_step_s, kTorqueFourth)) << at_s;
    ASSERT_NEAR(record.angle_rad[i], angle_rad(at_s), 1e-12 + cubic_error(angle_step_s, kAngleFourth)) << at_s;
  }
}

TEST(LogDialects, SparseMergedColumns) {
  // 200 Hz of torque, 100 Hz of angle 1.7 ms later, merged by time: no row has both.
  std::string text = "time_s,torque_bar_nm,angle_rad\n";
  for (int i = 0; i < 200; ++i) {
    text += fmt::format("{},{},\n", 0.005 * i, torque_nm(0.005 * i));
    if (i % 2 == 0) text += fmt::format("{},,{}\n", 0.005 * i + 0.0017, angle_rad(0.005 * i + 0.0017));
  }
  RecordQuality noticed;
  const Record record = read_text(text, {}, &noticed);
  EXPECT_EQ(record.size(), 198U);  // from the first angle at 1.7 ms to the last at 991.7 ms
  expect_on_the_curves(record, 0, 0.01);
  ASSERT_EQ(noticed.notes.size(), 2U);
  EXPECT_TRUE(noticed.notes[0].starts_with("most rows lack a value")) << noticed.notes[0];
}

TEST(LogDialects, ASlowColumnBesideAFastOneLosesNothing) {
  // Every stamp of the angle's is one of the torque's: still two clocks.
  std::string text = "time_s,torque_bar_nm,angle_rad\n";
  for (int i = 0; i < 1000; ++i) {
    text += fmt::format("{},{},{}\n", 0.001 * i, torque_nm(0.001 * i),
                        i % 10 == 0 ? fmt::format("{}", angle_rad(0.001 * i)) : "");
  }
  const Record record = read_text(text);
  EXPECT_EQ(record.size(), 991U);
  expect_on_the_curves(record, 0, 0.01);
}

TEST(LogDialects, TwoFilesWithClocksOfTheirOwn) {
  const TemporaryFolder folder;
  const auto torque = folder.file("eps.csv", samples("t,bar\n", 0.2, 0.004, 400, torque_nm));
  const auto angle = folder.file("wheel.csv", samples("t,theta\n", 0.0, 0.01, 200, angle_rad));
  const LogFormat format{.columns = parse_columns("time=t:s,torque_bar=bar:nm,angle=wheel/theta:rad")};
  RecordQuality noticed;
  const Record record = read_log({torque, angle}, format, &noticed);
  EXPECT_EQ(record.size(), 400U);
  EXPECT_EQ(record.channels, kAngleValid | kTorqueBarValid);
  expect_on_the_curves(record, 0, 0.01);
  EXPECT_EQ(noticed.notes, std::vector<std::string>{"2 clocks aligned by their stamps, on the fastest"});
}

TEST(LogDialects, GapsOfOneClockAreGapsAndBesideThemStandsTheCubic) {
  // The angle's clock stops from 0.5 to 0.7 s: no row there, and up to its very edge no straight line.
  const TemporaryFolder folder;
  const auto torque = folder.file("eps.csv", samples("time_s,torque_bar_nm\n", 0.0, 0.003, 333, torque_nm));
  const auto angle = folder.file(
      "wheel.csv", samples("time_s,angle_rad\n", 0.0, 0.01, 51, angle_rad) + samples("", 0.7, 0.01, 30, angle_rad));
  const Record record = read_log({torque, angle});
  for (const double at_s : record.time_s) EXPECT_TRUE(at_s <= 0.5 || at_s >= 0.7) << at_s;
  EXPECT_TRUE(std::ranges::any_of(record.time_s, [](double at_s) { return at_s > 0.49 && at_s <= 0.5; }));
  EXPECT_EQ(gap_free_rows(record).size(), 2U);
  expect_on_the_curves(record, 0, 0.01);
}

TEST(LogDialects, SeveralFilesEachWithItsOwnNameForTheTime) {
  const TemporaryFolder folder;
  const auto torque = folder.file("a.csv", samples("t,x\n", 0.0, 0.01, 100, torque_nm));
  const auto angle = folder.file("b.csv", samples("Zeit,x\n", 0.0, 0.01, 100, angle_rad));
  const LogFormat format{.columns = parse_columns("time=a/t:s,time=b/Zeit:s,torque_bar=a/x:nm,angle=b/x:rad")};
  const Record record = read_log({torque, angle}, format);
  EXPECT_EQ(record.size(), 100U);
  expect_on_the_curves(record, 0, 0);
}

std::string refusal(const std::vector<std::filesystem::path>& logs, const LogFormat& format = {}) {
  try {
    (void)read_log(logs, format);
  } catch (const BadInput& error) {
    std::string text = error.what();
    const std::string folder = logs.front().parent_path().string() + "/";
    for (std::size_t at = 0; (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
    return text;
  }
  return "was read";
}

TEST(LogDialects, FilesThatDoNotFitTogether) {
  const TemporaryFolder folder;
  const auto torque = folder.file("eps.csv", samples("time_s,torque_bar_nm\n", 0.0, 0.01, 100, torque_nm));
  const auto later = folder.file("later.csv", samples("time_s,angle_rad\n", 50.0, 0.01, 100, angle_rad));
  const auto both = folder.file("both.csv", samples("time_s,torque_bar_nm\n", 0.0, 0.01, 100, torque_nm));
  const auto nameless = folder.file("nameless.csv", samples("zeit,angle_rad\n", 0.0, 0.01, 100, angle_rad));
  EXPECT_EQ(refusal({torque, later}),
            "eps.csv: expected clocks that run at the same time, found 0 to 0.99 s and 50 to 50.99 s; check that the "
            "files are of one drive and the units of time are right; clocks that began apart are brought together by "
            "--align");
  EXPECT_EQ(refusal({torque, both}),
            "eps.csv, line 1, column 'torque_bar_nm': expected each column's name once, found it in both.csv too; say "
            "which with --columns torque_bar=eps/torque_bar_nm");
  EXPECT_EQ(refusal({torque, nameless}),
            "eps.csv, line 1: expected a column time_s of nameless.csv, found \"time_s\", \"torque_bar_nm\", in "
            "nameless.csv \"zeit\", \"angle_rad\"; name it with --columns time=nameless/zeit, or see what `steerid "
            "inspect` proposes");
}

TEST(LogDialects, FilesThatAreNotReadAreAnsweredWithTheCommandThatConvertsThem) {
  const TemporaryFolder folder;
  const auto says = [&](const char* name, const std::string& bytes) {
    return refusal({folder.file(name, bytes + std::string(100, '\0'))});
  };
  EXPECT_EQ(says("a.mf4", "MDF     4.10    "),
            "a.mf4: expected a log as CSV, found an MDF file (MF4, MDF); convert it: python3 -c \"import sys, asammdf; "
            "asammdf.MDF(sys.argv[1]).export('csv', filename=sys.argv[2], single_time_base=True)\" a.mf4 a.csv");
  for (const auto& [bytes, words] : std::vector<std::pair<std::string, std::string>>{
           {"MATLAB 5.0 MAT-file, Platform", "found a MAT file; convert it: matlab"},
           {"MATLAB 7.3 MAT-file, Platform", "found a MAT file; convert it: matlab"},
           {"\x89HDF\r\n\x1a\n", "found an HDF5 file; convert it: python3"},
           {"PAR1", "found a Parquet file; convert it: python3"},
           {"#ROSBAG V2.0\n", "found a ROS 1 bag; convert it: mcap convert"},
           {std::string("SQLite format 3\0", 16), "found an SQLite file, as a ROS 2 bag is; convert it: mcap convert"},
           {"PK\x03\x04", "found a ZIP file, as an Excel workbook (xlsx) is; convert it: libreoffice"},
           {"\x1f\x8b\x08", "found a gzip file; convert it: gunzip"}}) {
    EXPECT_NE(says("x.bin", bytes).find(words), std::string::npos) << says("x.bin", bytes);
  }
}

}  // namespace
}  // namespace steerid::test
