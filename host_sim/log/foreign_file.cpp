// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/foreign_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <filesystem>

namespace steerid {
namespace {

struct Kind {
  std::string_view bytes;
  std::string_view kind;
  std::string_view command;  ///< {0}: the file, {1}: it without its ending, as a shell takes them
};

using namespace std::string_view_literals;

constexpr std::string_view kByAsammdf =
    "python3 -c \"import sys, asammdf; asammdf.MDF(sys.argv[1]).export('csv', filename=sys.argv[2], "
    "single_time_base=True)\" {0} {1}.csv";
constexpr std::string_view kByMatlab = "matlab -batch \"load {0}; writetable(TABLE, '{1}.csv')\" with its table's name";
constexpr std::string_view kByHdf =
    "python3 -c \"import sys, pandas; pandas.read_hdf(sys.argv[1]).to_csv(sys.argv[2], index=False)\" {0} {1}.csv";
constexpr std::string_view kByParquet =
    "python3 -c \"import sys, pandas; pandas.read_parquet(sys.argv[1]).to_csv(sys.argv[2], index=False)\" {0} {1}.csv";
constexpr std::string_view kByFeather =
    "python3 -c \"import sys, pandas; pandas.read_feather(sys.argv[1]).to_csv(sys.argv[2], index=False)\" {0} {1}.csv";
constexpr std::string_view kByTdms =
    "python3 -c \"import sys, nptdms; nptdms.TdmsFile(sys.argv[1]).as_dataframe().to_csv(sys.argv[2], index=False)\" "
    "{0} {1}.csv";
/// Of ROS 1 that is an MCAP file whose messages are refused with the command below.
constexpr std::string_view kByMcap = "mcap convert {0} {1}.mcap";
/// `mcap cat --json` decodes ROS 1, protobuf and JSON; a line a message.
constexpr std::string_view kByMcapCat =
    "mcap cat {0} --topics {1} --json | python3 -c \"import json, sys, pandas; pandas.json_normalize([json.loads(line) "
    "for "
    "line in sys.stdin]).to_csv(sys.argv[1], index=False)\" {2}";
constexpr std::string_view kByOffice = "libreoffice --headless --convert-to csv {0}";

constexpr std::array kKinds = {
    Kind{"MDF     "sv, "an MDF file (MF4, MDF)", kByAsammdf},
    Kind{"UnFinMF "sv, "an unfinished MDF file (MF4)", kByAsammdf},
    Kind{"MATLAB 7.3 MAT-file"sv, "a MAT file", kByMatlab},
    Kind{"MATLAB 5.0 MAT-file"sv, "a MAT file", kByMatlab},
    Kind{"\x89HDF\r\n\x1a\n"sv, "an HDF5 file", kByHdf},
    Kind{"PAR1"sv, "a Parquet file", kByParquet},
    Kind{"ARROW1"sv, "an Arrow (Feather) file", kByFeather},
    Kind{"#ROSBAG V2.0"sv, "a ROS 1 bag", kByMcap},
    Kind{"SQLite format 3\0"sv, "an SQLite file, as a ROS 2 bag is", kByMcap},
    Kind{"PK\x03\x04"sv, "a ZIP file, as an Excel workbook (xlsx) is", kByOffice},
    Kind{"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"sv, "an old Excel workbook (xls)", kByOffice},
    Kind{"TDSm"sv, "a TDMS file", kByTdms},
    Kind{"\x1f\x8b"sv, "a gzip file", "gunzip {0}"},
    Kind{"\x28\xb5\x2f\xfd"sv, "a zstd file", "zstd -d {0}"},
    Kind{"BZh9"sv, "a bzip2 file", "bunzip2 {0}"},
    Kind{"\xfd"
         "7zXZ\0"sv,
         "an xz file", "unxz {0}"},
};

std::string in_shell_quotes(std::string_view text) {
  if (text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./") ==
      std::string_view::npos) {
    return std::string(text);
  }
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::optional<ForeignFile> foreign_file(std::string_view first_bytes, std::string_view name) {
  for (const Kind& kind : kKinds) {
    if (!first_bytes.starts_with(kind.bytes)) continue;
    const std::string whole = in_shell_quotes(name);
    const std::string without_ending = in_shell_quotes(std::filesystem::path(name).replace_extension().string());
    return ForeignFile{std::string(kind.kind), fmt::format(fmt::runtime(kind.command), whole, without_ending)};
  }
  return std::nullopt;
}

std::string mcap_to_csv(std::string_view file, std::string_view topic) {
  const std::string without_ending = std::filesystem::path(file).replace_extension().string();
  return fmt::format(fmt::runtime(kByMcapCat), in_shell_quotes(file), in_shell_quotes(topic),
                     in_shell_quotes(without_ending + ".csv"));
}

}  // namespace steerid
