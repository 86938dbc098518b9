#include "apps/diagnose_batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "apps/batch_table.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "parallel/work_in_parallel.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;

struct Case {
  std::string name;
  fs::path log;
  fs::path sim;
};

/// Two answers of one name would overwrite each other.
void refuse_equal_names(const std::vector<Case>& sorted, const fs::path& folder) {
  const auto twice = std::ranges::adjacent_find(sorted, {}, &Case::name);
  if (twice == sorted.end()) return;
  const auto again = twice + 1;
  throw bad_input({.file = folder.string(),
                   .expected = "records of different names",
                   .found = fmt::format("{} and {}", twice->log.lexically_relative(folder).string(),
                                        again->log.lexically_relative(folder).string()),
                   .advice = "rename one of them"});
}

/// The table of an earlier batch may lie among the records; a record where it will lie would be overwritten.
bool is_the_table(const fs::path& file, const fs::path& table) {
  std::error_code none;
  if (!fs::equivalent(file, table, none)) return false;
  if (is_batch_table(file)) return true;
  throw bad_input({.file = file.string(),
                   .expected = "the table of an earlier batch, which is written here",
                   .found = "a record",
                   .advice = "rename it or name another --out"});
}

std::vector<Case> cases_in(const fs::path& folder, const fs::path& sim, const fs::path& table) {
  if (!fs::is_directory(folder)) {
    throw BadInput(fmt::format("{}: expected a folder of records; check the path", folder.string()));
  }
  std::vector<Case> cases;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (entry.is_directory() && fs::exists(path / "log.csv")) {
      cases.push_back({path.filename().string(), path / "log.csv", sim.empty() ? path / "sim.json" : sim});
    } else if (entry.is_regular_file() && path.extension() == ".csv" && !is_the_table(path, table)) {
      fs::path own = path;
      cases.push_back({path.stem().string(), path, sim.empty() ? own.replace_extension(".json") : sim});
    }
  }
  if (cases.empty()) {
    throw BadInput(
        fmt::format("{}: expected records, found none; a record is a folder with log.csv and sim.json, or NAME.csv "
                    "beside NAME.json",
                    folder.string()));
  }
  std::ranges::sort(cases, {}, [](const Case& one) { return std::pair(one.name, one.log); });
  refuse_equal_names(cases, folder);
  return cases;
}

void answer(const DiagnosisFiles& files, const DiagnosisRequest& request, BatchRow& row) {
  const auto from = made_from(files, request);
  if (const auto earlier = earlier_answer(files, request, from); !earlier.is_null()) {
    row.ended = BatchRow::Ended::kKept;
    row.answer = cells_of(earlier);
    return;
  }
  remove_answer(files);  // to another question: if there is none to this one, it would pass for it
  const DiagnosisInputs inputs = read_inputs(files, request);
  make_output_folder(files.out);
  DiagnoseOptions options = request.options();
  options.threads = 1;
  row.answer = cells_of(write_diagnosis(diagnosis_of(inputs, files, options), inputs, files, request, from));
}

}  // namespace

void diagnose_batch(const fs::path& folder, const fs::path& sim, const fs::path& out, const DiagnosisRequest& request) {
  (void)request.format();  // an option that cannot be read is no record's fault
  const fs::path table = out / "table.csv";
  const std::vector<Case> cases = cases_in(folder, sim, table);
  make_output_folder(out);
  check_output_file(table);
  std::vector<BatchRow> rows(cases.size());
  {
    Progress progress("diagnosing", cases.size());
    work_in_parallel(
        cases.size(), 0, [&](std::size_t done) { progress.at(done); },
        [&](std::size_t i) {
          const DiagnosisFiles files{cases[i].log, cases[i].sim, out / cases[i].name};
          rows[i] = row_of(cases[i].name, [&](BatchRow& row) { answer(files, request, row); });
          if (!rows[i].error.empty()) remove_answer(files);
        });
  }
  write_batch_table(table, rows);
  fmt::print("{}; table in {}\n", batch_summary(rows), table.string());
  end_as_the_worst(rows, table);
}

}  // namespace steerid
