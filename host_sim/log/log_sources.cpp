// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The formats that logs come in. A new one is a file with a class, and a line here.
#include <array>
#include <fstream>
#include <iostream>
#include <utility>

#include "log/bad_input.hpp"
#include "log/blf.hpp"
#include "log/can_source.hpp"
#include "log/can_text.hpp"
#include "log/csv_source.hpp"
#include "log/foreign_file.hpp"
#include "log/input_file.hpp"
#include "log/log_source.hpp"
#include "log/mcap_reader.hpp"
#include "log/mcap_source.hpp"
#include "log/peeked_stream.hpp"

namespace steerid {
namespace {

struct Format {
  bool (*recognises)(std::string_view first_bytes);
  std::unique_ptr<LogSource> (*open)(OpenedLog log);
};

bool anything(std::string_view) { return true; }

// The first that recognises the bytes reads the file.
constexpr std::array kFormats = {
    Format{is_candump, open_candump}, Format{is_asc, open_asc},   Format{is_blf, open_blf},
    Format{is_mcap, open_mcap},       Format{anything, open_csv},
};

}  // namespace

std::unique_ptr<LogSource> open_log(OpenedLog log) {
  auto peeked = std::make_unique<PeekedStream>(std::move(log.in));
  const std::string first_bytes(peeked->first_bytes());
  if (const auto foreign = foreign_file(first_bytes, log.name)) {
    throw bad_input({.file = log.name,
                     .expected = "a log as CSV",
                     .found = foreign->kind,
                     .advice = "convert it: " + foreign->command});
  }
  log.in = std::move(peeked);
  for (const Format& format : kFormats) {
    if (format.recognises(first_bytes)) return format.open(std::move(log));
  }
  throw bad_input({.file = log.name, .expected = "a log", .found = in_quotes(first_bytes)});
}

std::unique_ptr<LogSource> open_log(const std::filesystem::path& path, const std::vector<std::filesystem::path>& dbc) {
  if (path == "-") {
    return open_log({.in = std::make_unique<std::istream>(std::cin.rdbuf()), .name = "standard input", .dbc = dbc});
  }
  check_input_file(path, "a log");
  std::error_code unknown;
  auto in = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*in) throw bad_input({.file = path.string(), .expected = "a readable file", .advice = "check its permissions"});
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  return open_log({.in = std::move(in), .name = path.string(), .bytes_in_all = unknown ? 0 : size, .dbc = dbc});
}

}  // namespace steerid
