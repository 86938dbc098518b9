// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/record_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>

#include "fleet/calendar.hpp"
#include "fleet/file_hash.hpp"
#include "log/bad_input.hpp"
#include "log/csv_dialect.hpp"
#include "log/csv_lines.hpp"

namespace steerid::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kColumns = {"record", "sim", "vehicle", "date", "mileage_km"};
enum Column : std::uint8_t { kRecord, kSim, kVehicle, kDate, kMileage };

void sort_by_vehicle(std::vector<ListedRecord>& records) {
  std::ranges::sort(records, {}, [](const ListedRecord& one) { return std::tie(one.vehicle, one.name, one.log); });
}

/// Two answers of one name would overwrite each other.
void refuse_equal_names(const std::vector<ListedRecord>& records, const fs::path& where) {
  std::vector<std::pair<std::string_view, fs::path>> names;
  names.reserve(records.size());
  for (const ListedRecord& one : records) names.emplace_back(one.name, one.log);
  std::ranges::sort(names);
  const auto twice =
      std::ranges::adjacent_find(names, [](const auto& one, const auto& other) { return one.first == other.first; });
  if (twice == names.end()) return;
  throw bad_input({.file = where.string(),
                   .expected = "records of different names",
                   .found = fmt::format("{} and {}", twice->second.string(), (twice + 1)->second.string()),
                   .advice = "rename one of them"});
}

/// A name that leads out of the folder of the answers.
bool leads_out(const std::string& name) { return name.empty() || name == "." || name == ".."; }

/// The record that an entry of a folder is; nothing when it is none. What cannot be looked at, such as a link that
/// leads round to itself, is a record that cannot be used.
std::optional<ListedRecord> record_of(const fs::directory_entry& entry,
                                      const std::function<bool(const fs::path&)>& is_output) {
  const fs::path& path = entry.path();
  const std::string name = path.filename().string();
  std::error_code unknown;
  const fs::file_status status = entry.status(unknown);
  if (fs::is_directory(status)) {
    if (!fs::exists(path / "log.csv", unknown) && !unknown) return std::nullopt;
    return ListedRecord{.name = name, .log = name + "/log.csv", .sim = name + "/sim.json"};
  }
  const bool a_log = path.extension() == ".csv";
  const bool astray = unknown && unknown != std::errc::no_such_file_or_directory;
  if (!astray && (!a_log || fs::is_other(status) || is_output(path))) return std::nullopt;
  const std::string stem = path.stem().string();
  return ListedRecord{.name = stem, .log = name, .sim = stem + ".json"};
}

/// Where the list may not lead: out of the records' folder, and with it out of the folder of the answers.
bool stays_inside(const fs::path& path) {
  return !path.empty() && path.is_relative() && *path.begin() != ".." && *path.begin() != ".";
}

/// The lines of a list below its header.
class ListReader {
 public:
  ListReader(const fs::path& list, const fs::path& folder)
      : name_(list.string()), folder_(folder), in_(list, std::ios::binary), lines_(checked(in_, name_), name_) {
    std::string_view line;
    if (!next_line(line)) complain("", "a header with the column record", "an empty file", "write one");
    separator_ = detect_separator(line);
    CsvCells cells(line, separator_);
    for (std::string_view cell; cells.next(cell);) {
      const auto known = std::ranges::find(kColumns, cell);
      columns_.push_back(static_cast<std::size_t>(known - kColumns.begin()));
    }
    if (std::ranges::find(columns_, std::size_t{kRecord}) == columns_.end()) {
      complain("", "a header with the column record", in_quotes(std::string(line)),
               "the columns are record, sim, vehicle, date and mileage_km");
    }
  }

  bool next(ListedRecord& record) {
    std::string_view line;
    if (!next_line(line)) return false;
    std::array<std::string, kColumns.size()> said;
    CsvCells cells(line, separator_);
    std::size_t at = 0;
    for (std::string_view cell; cells.next(cell); ++at) {
      if (at < columns_.size() && columns_[at] < said.size()) said[columns_[at]] = cell;
    }
    if (cells.broken() || at != columns_.size()) {
      complain("", fmt::format("{} cells", columns_.size()), fmt::format("{}", at), "quote a cell that holds a comma");
    }
    record = listed(said);
    return true;
  }

 private:
  static std::istream& checked(std::ifstream& in, const std::string& name) {
    if (in) return in;
    throw bad_input(
        {.file = name, .expected = "a list of records", .found = "no readable file", .advice = "check the path"});
  }

  bool next_line(std::string_view& line) {
    while (lines_.next(line)) {
      const std::size_t first = line.find_first_not_of(" \t");
      if (first != std::string_view::npos && line[first] != '#') return true;
    }
    return false;
  }

  [[noreturn]] void complain(std::string_view column, std::string expected, std::string found,
                             std::string advice) const {
    throw bad_input({.file = name_,
                     .line = lines_.number(),
                     .column = std::string(column),
                     .expected = std::move(expected),
                     .found = std::move(found),
                     .advice = std::move(advice)});
  }

  [[nodiscard]] ListedRecord listed(const std::array<std::string, kColumns.size()>& said) const {
    const fs::path path = fs::path(said[kRecord]).lexically_normal();
    const fs::path sim = fs::path(said[kSim]).lexically_normal();
    if (!stays_inside(path) || leads_out(path.stem().string())) {
      complain("record", "a path within the folder of the records", in_quotes(said[kRecord]),
               "name it from that folder");
    }
    ListedRecord out;
    const bool is_folder = fs::is_directory(folder_ / path) || !path.has_extension();
    const fs::path log = is_folder ? path / "log.csv" : path;
    const bool in_its_own = log.filename() == "log.csv" && log.has_parent_path();
    fs::path own = log;
    out.name = (in_its_own ? log.parent_path() : fs::path(log).replace_extension()).generic_string();
    out.log = log.generic_string();
    out.sim = sim.empty()
                  ? (in_its_own ? log.parent_path() / "sim.json" : own.replace_extension(".json")).generic_string()
                  : sim.generic_string();
    out.vehicle = said[kVehicle];
    out.date = said[kDate];
    if (!out.date.empty() && !days_of(out.date)) {
      complain("date", "a date such as 2026-05-01 or 2026-05-01T13:45", in_quotes(out.date), "write it so");
    }
    out.mileage_km = mileage(said[kMileage]);
    return out;
  }

  [[nodiscard]] std::optional<double> mileage(const std::string& text) const {
    if (text.empty()) return std::nullopt;
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && stop == text.data() + text.size() && std::isfinite(value)) return value;
    complain("mileage_km", "a number", in_quotes(text), "leave the cell empty where nobody knows");
  }

  std::string name_;
  fs::path folder_;
  std::ifstream in_;
  CsvLines lines_;
  char separator_ = ',';
  std::vector<std::size_t> columns_;  // of the header's cells: the place in kColumns, or its size
};

}  // namespace

std::vector<ListedRecord> records_in(const fs::path& folder, const std::function<bool(const fs::path&)>& is_output) {
  std::error_code unknown;
  if (!fs::is_directory(folder, unknown)) {
    throw BadInput(fmt::format("{}: expected a folder of records; check the path", folder.string()));
  }
  fs::directory_iterator entries(folder, unknown);
  if (unknown) {
    throw BadInput(fmt::format("{}: expected a folder that can be read, found \"{}\"; check its permissions",
                               folder.string(), unknown.message()));
  }
  std::vector<ListedRecord> records;
  for (const auto& entry : entries) {
    auto one = record_of(entry, is_output);
    if (!one) continue;
    if (leads_out(one->name)) {
      throw bad_input({.file = entry.path().string(),
                       .expected = "a record whose name can be that of its answer's folder",
                       .found = in_quotes(one->name),
                       .advice = "rename it"});
    }
    records.push_back(std::move(*one));
  }
  if (records.empty()) {
    throw BadInput(
        fmt::format("{}: expected records, found none; a record is a folder with log.csv and sim.json, or NAME.csv "
                    "beside NAME.json",
                    folder.string()));
  }
  sort_by_vehicle(records);
  refuse_equal_names(records, folder);
  return records;
}

std::vector<ListedRecord> records_on(const fs::path& list, const fs::path& folder) {
  ListReader reader(list, folder);
  std::vector<ListedRecord> records;
  for (ListedRecord record; reader.next(record);) records.push_back(record);
  if (records.empty()) {
    throw bad_input({.file = list.string(),
                     .expected = "a record a line below the header",
                     .found = "none",
                     .advice = "name some"});
  }
  sort_by_vehicle(records);
  refuse_equal_names(records, list);
  return records;
}

std::string digest_of(const std::vector<ListedRecord>& records) {
  std::string all;
  for (const ListedRecord& one : records) {
    const std::string mileage = one.mileage_km ? fmt::format("{}", *one.mileage_km) : "";
    for (const std::string& part : {one.name, one.log, one.sim, one.vehicle, one.date, mileage}) {
      all += part;
      all += '\0';  // a path holds none
    }
  }
  return sha256(all);
}

}  // namespace steerid::fleet
