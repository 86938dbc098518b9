// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/fleet_table.hpp"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "log/csv_writer.hpp"

namespace steerid::fleet {
namespace {

using Json = nlohmann::ordered_json;

struct InCsv {
  CsvWriter& csv;
  void operator()(std::monostate) const { csv.cell(""); }
  void operator()(const std::string& text) const { csv.cell(text); }
  void operator()(double number) const { csv.cell(number); }
  void operator()(const RecordName& record) const { csv.cell(record.name); }
  void operator()(const CountOf& count) const { csv.cell(count.number); }
};

struct InJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(const std::string& text) const { return text; }
  Json operator()(double number) const {
    constexpr double kEveryWholeNumberBelow = 9007199254740992.0;  // 2^53
    if (!std::isfinite(number)) return nullptr;
    const bool whole = number == std::trunc(number) && std::abs(number) < kEveryWholeNumberBelow;
    return whole ? Json(static_cast<std::int64_t>(number)) : Json(number);
  }
  Json operator()(const RecordName& record) const { return record.name; }
  Json operator()(const CountOf& count) const { return (*this)(count.number); }
};

}  // namespace

void write_table(const std::filesystem::path& folder, const FleetTable& table) {
  std::vector<std::string> keys;
  keys.reserve(table.columns.size());
  for (const FleetColumn& column : table.columns) keys.push_back(column.key);
  CsvWriter csv(folder / (table.key + ".csv"), keys);
  WholeFile lines(folder / (table.key + ".jsonl"));
  for (const auto& row : table.rows) {
    Json object = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::visit(InCsv{csv}, row[i]);
      object[keys[i]] = std::visit(InJson{}, row[i]);
    }
    csv.end_row();
    lines.write(object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  csv.commit();
  lines.commit();
}

}  // namespace steerid::fleet
