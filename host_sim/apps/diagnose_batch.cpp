#include "apps/diagnose_batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
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

/// A name that leads out of the folder of the answers.
bool leads_out(const std::string& name) { return name.empty() || name == "." || name == ".."; }

/// The record that an entry of the folder is; nothing when it is none. What cannot be looked at, such as a link that
/// leads round to itself, is a record that cannot be used.
std::optional<Case> case_of(const fs::directory_entry& entry, const fs::path& sim, const fs::path& table) {
  const fs::path& path = entry.path();
  std::error_code unknown;
  const fs::file_status status = entry.status(unknown);
  if (fs::is_directory(status)) {
    if (!fs::exists(path / "log.csv", unknown) && !unknown) return std::nullopt;
    return Case{path.filename().string(), path / "log.csv", sim.empty() ? path / "sim.json" : sim};
  }
  const bool a_log = path.extension() == ".csv";
  const bool astray = unknown && unknown != std::errc::no_such_file_or_directory;
  if (!astray && (!a_log || fs::is_other(status) || is_the_table(path, table))) return std::nullopt;
  fs::path own = path;
  return Case{path.stem().string(), path, sim.empty() ? own.replace_extension(".json") : sim};
}

std::vector<Case> cases_in(const fs::path& folder, const fs::path& sim, const fs::path& table) {
  std::error_code unknown;
  if (!fs::is_directory(folder, unknown)) {
    throw BadInput(fmt::format("{}: expected a folder of records; check the path", folder.string()));
  }
  std::vector<Case> cases;
  fs::directory_iterator entries(folder, unknown);
  if (unknown) {
    throw BadInput(fmt::format("{}: expected a folder that can be read, found \"{}\"; check its permissions",
                               folder.string(), unknown.message()));
  }
  for (const auto& entry : entries) {
    auto one = case_of(entry, sim, table);
    if (!one) continue;
    if (leads_out(one->name)) {
      throw bad_input({.file = one->log.string(),
                       .expected = "a record whose name can be that of its answer's folder",
                       .found = in_quotes(one->name),
                       .advice = "rename it"});
    }
    cases.push_back(std::move(*one));
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

/// No answer lies where a record does, nor two in one place.
void claim(const std::vector<Case>& cases, const fs::path& out, const DiagnosisRequest& request, FilesOfRun& files) {
  for (const Case& one : cases) {
    files.reads(one.log, "--batch");
    files.reads(one.sim, "--batch");
    if (one.log.filename() == "log.csv") files.reads(one.log.parent_path(), "--batch");
  }
  for (const Case& one : cases) {
    files.writes(out / one.name, "--out");
    for (const fs::path& file : answer_files(out / one.name, request)) files.writes(file, "--out");
  }
}

void answer(const DiagnosisFiles& files, const DiagnosisRequest& request, BatchRow& row) {
  if (const auto earlier = earlier_answer(files, request); !earlier.is_null()) {
    row.ended = BatchRow::Ended::kKept;
    row.answer = cells_of(earlier);
    return;
  }
  remove_answer(files);  // to another question: if there is none to this one, it would pass for it
  const DiagnosisInputs inputs = read_inputs(files, request);
  const auto from = made_from(files, request);
  make_output_folder(files.out);
  DiagnoseOptions options = request.options();
  options.threads = 1;
  row.answer = cells_of(write_diagnosis(diagnosis_of(inputs, files, options), inputs, files, request, from));
}

}  // namespace

void diagnose_batch(const fs::path& folder, const fs::path& sim, const fs::path& out, const DiagnosisRequest& request,
                    FilesOfRun& files_of_run) {
  (void)request.format();  // an option that cannot be read is no record's fault
  const fs::path table = out / "table.csv";
  const std::vector<Case> cases = cases_in(folder, sim, table);
  claim(cases, out, request, files_of_run);
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
  fmt::print("{}; table in {}\n", batch_summary(rows), printable(table.string()));
  end_as_the_worst(rows, table);
}

}  // namespace steerid
