#include "apps/batch_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "log/bad_input.hpp"
#include "log/csv_writer.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;
using Ended = BatchRow::Ended;

constexpr std::size_t kCellsOfAnAnswer = 7;

std::vector<std::string> header() {
  return {"case",        "verdict",         "probability", "sim_nrmse", "refit_nrmse", "with_effect_nrmse",
          "floor_nrmse", "closed_fraction", "error"};
}

std::ptrdiff_t count(const std::vector<BatchRow>& rows, Ended ended) {
  return std::ranges::count(rows, ended, &BatchRow::ended);
}

std::string number(const Json& value) {
  return value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : std::string();
}

void write_row(CsvWriter& csv, const BatchRow& row) {
  csv.cell(row.name);
  for (std::size_t i = 0; i < kCellsOfAnAnswer; ++i) csv.cell(row.answer.empty() ? "" : row.answer.at(i));
  csv.cell(row.error).end_row();
}

}  // namespace

std::vector<std::string> cells_of(const Json& diagnosis) {
  const Json& gap = diagnosis.at("gap");
  return {diagnosis.at("verdict").get<std::string>(),
          number(diagnosis.at("ranking").at(0).at("probability")),
          number(gap.at("sim_nrmse")),
          number(gap.at("refit_nrmse")),
          number(gap.at("with_effect_nrmse")),
          number(gap.at("floor_nrmse")),
          number(gap.at("closed_fraction"))};
}

BatchRow row_of(const std::string& name, const std::function<void(BatchRow&)>& work) {
  BatchRow row{.name = name};
  try {
    work(row);
  } catch (const BadInput& error) {
    row.ended = Ended::kUnusable;
    row.error = error.what();
  } catch (const std::exception& error) {
    row.ended = Ended::kFault;
    row.error = fmt::format("internal error: {}", error.what());
  }
  return row;
}

void write_batch_table(const std::filesystem::path& target, const std::vector<BatchRow>& rows) {
  CsvWriter csv(target, header());
  for (const BatchRow& row : rows) write_row(csv, row);
  csv.commit();
}

bool is_batch_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string first;
  return std::getline(in, first) && first == fmt::format("{}", fmt::join(header(), ","));
}

std::string batch_summary(const std::vector<BatchRow>& rows) {
  std::string text = fmt::format("{} records, {} kept from an earlier run, {} not usable", rows.size(),
                                 count(rows, Ended::kKept), count(rows, Ended::kUnusable));
  if (const auto faults = count(rows, Ended::kFault); faults > 0) {
    text += fmt::format(", {} ended in a fault of this program", faults);
  }
  return text;
}

void end_as_the_worst(const std::vector<BatchRow>& rows, const std::filesystem::path& table) {
  if (const auto faults = count(rows, Ended::kFault); faults > 0) {
    throw std::runtime_error(fmt::format("in {} of {} records; {} says in which", faults, rows.size(), table.string()));
  }
  if (const auto unusable = count(rows, Ended::kUnusable); unusable > 0) {
    throw BadInput(fmt::format("{} of {} records are not usable; {} says why", unusable, rows.size(), table.string()));
  }
}

}  // namespace steerid
