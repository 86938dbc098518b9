// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/batch_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <exception>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/fleet_page.hpp"
#include "apps/made_from.hpp"
#include "apps/option_kinds.hpp"
#include "fleet/answer_table.hpp"
#include "fleet/shard_file.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "log/unfinished_files.hpp"
#include "log/whole_file.hpp"
#include "parallel/work_in_parallel.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;
using fleet::Ended;
using fleet::ListedRecord;
using fleet::RecordLine;

constexpr const char* kTable = "table.csv";

/// The table of an earlier batch may lie among the records; a record where it will lie would be overwritten.
bool is_the_table(const fs::path& file, const fs::path& table) {
  std::error_code none;
  if (!fs::equivalent(file, table, none)) return false;
  if (fleet::is_answer_table(file)) return true;
  throw bad_input({.file = file.string(),
                   .expected = "the table of an earlier batch, which is written here",
                   .found = "a record",
                   .advice = "rename it or name another --out"});
}

/// How often the program has begun with a record and not ended: a number in a file beside its answer. A record that
/// kills the program would otherwise kill every further attempt at its shard. Who interrupts the program takes the file
/// away with it: that is no fault of the record.
class Attempts {
 public:
  static constexpr int kMost = 3;

  explicit Attempts(fs::path out) : folder_(std::move(out)), file_(folder_ / ".attempts") {
    std::ifstream(file_) >> before_;
  }

  [[nodiscard]] bool hopeless() const { return before_ >= kMost; }
  void begin() const {
    make_output_folder(folder_);
    std::error_code none;
    fs::remove(file_, none);
    const int descriptor = open_unfinished(file_, 0666);
    if (descriptor < 0) return;
    const std::string count = std::to_string(before_ + 1);
    (void)!::write(descriptor, count.data(), count.size());
    ::close(descriptor);
  }
  void end() const {
    std::error_code none;
    remove_unfinished(file_);
    fs::remove(folder_, none);  // only when nothing else is in it
  }

 private:
  fs::path folder_;
  fs::path file_;
  int before_ = 0;
};

/// Lines in the order of the records, however they are answered; keeps those that wait for one before them.
class InOrder {
 public:
  explicit InOrder(std::function<void(const RecordLine&)> take) : take_(std::move(take)) {}

  void add(std::size_t index, RecordLine line) {
    const std::lock_guard lock(guard_);
    waiting_.emplace(index, std::move(line));
    for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_; first = waiting_.begin()) {
      take_(first->second);
      waiting_.erase(first);
      ++next_;
    }
  }

 private:
  std::function<void(const RecordLine&)> take_;
  std::mutex guard_;
  std::map<std::size_t, RecordLine> waiting_;
  std::size_t next_ = 0;
};

struct Counts {
  std::size_t records = 0;
  std::size_t kept = 0;
  std::size_t unusable = 0;
  std::size_t faults = 0;

  void add(const RecordLine& line) {
    ++records;
    unusable += line.ended == Ended::kUnusable ? 1 : 0;
    faults += line.ended == Ended::kFault ? 1 : 0;
  }

  [[nodiscard]] std::string summary() const {
    std::string text = fmt::format("{} records, {} kept from an earlier run, {} not usable", records, kept, unusable);
    if (faults > 0) text += fmt::format(", {} ended in a fault of this program", faults);
    return text;
  }

  /// Makes the command end with the exit code of the worst record.
  void end_as_the_worst(const fs::path& table) const {
    if (faults > 0) {
      throw std::runtime_error(fmt::format("in {} of {} records; {} says in which", faults, records, table.string()));
    }
    if (unusable > 0) {
      throw BadInput(fmt::format("{} of {} records are not usable; {} says why", unusable, records, table.string()));
    }
  }
};

class BatchRun {
 public:
  BatchRun(const BatchQuestion& question, const BatchPlace& place)
      : question_(question), place_(place), kind_(fleet::kind_of(question.command)) {
    if (!place.shard.empty()) header_.shard = fleet::parse_shard(place.shard);
    const std::vector<ListedRecord> all = listed();
    header_.command = question.command;
    header_.program = this_program();
    header_.options = question.options;
    header_.records_in_all = all.size();
    header_.list_sha256 = fleet::digest_of(all);
    for (const ListedRecord& one : all) {
      if (header_.shard.holds(one.log)) records_.push_back(one);
    }
    header_.records = records_.size();
  }

  void run(FilesOfRun& files) {
    claim(files);
    const bool whole = place_.shard.empty();
    const fs::path folder = place_.out / fleet::kFleetFolder;
    const fs::path lines = folder / fleet::shard_file_name(header_.shard);
    fs::path table = place_.out / kTable;
    if (!whole) (table = lines).replace_extension(".csv");
    make_output_folder(place_.out);
    make_output_folder(folder);
    check_output_file(table);
    fs::remove(lines);  // of an earlier run: where it is, the shard is done
    answer_all(lines, whole ? fs::path() : table);
    if (whole) {
      (void)merge_with_report({lines}, place_.out);
      fs::remove(lines);
    }
    fmt::print("{}; table in {}\n", counts_.summary(), printable(table.string()));
    counts_.end_as_the_worst(table);
  }

 private:
  /// No answer lies where a record does, nor two in one place.
  void claim(FilesOfRun& files) const {
    for (const ListedRecord& one : records_) {
      const fs::path log = place_.folder / one.log;
      for (const fs::path& file : question_.inputs(one)) files.reads(file, "the folder of records");
      if (log.filename() == "log.csv") files.reads(log.parent_path(), "the folder of records");
    }
    for (const ListedRecord& one : records_) {
      files.writes(place_.out / one.name, "--out");
      for (const fs::path& file : question_.outputs(place_.out / one.name)) files.writes(file, "--out");
    }
  }

  [[nodiscard]] std::vector<ListedRecord> listed() const {
    if (!place_.list.empty()) return fleet::records_on(place_.list, place_.folder);
    const fs::path table = place_.out / kTable;
    return fleet::records_in(place_.folder, [&](const fs::path& file) { return is_the_table(file, table); });
  }

  /// The table of the shard goes where `table` says; nowhere when that is empty.
  void answer_all(const fs::path& lines, const fs::path& table) {
    WholeFile out(lines);
    out.write(to_line(header_));
    std::unique_ptr<fleet::AnswerTable> csv;
    if (!table.empty()) csv = std::make_unique<fleet::AnswerTable>(kind_, table);
    InOrder in_order([&](const RecordLine& line) {
      out.write(to_line(line));
      if (csv) csv->add(line);
      counts_.add(line);
    });
    Progress progress(question_.label, records_.size());
    work_in_parallel(
        records_.size(), place_.threads, [&](std::size_t done) { progress.at(done); },
        [&](std::size_t i) { in_order.add(i, answered(records_[i])); });
    if (csv) csv->commit();
    out.commit();
    counts_.kept = kept_;
  }

  RecordLine answered(const ListedRecord& record) {
    RecordLine line{.record = record, .ended = Ended::kAnswered, .error = {}, .made_from = nullptr, .answer = nullptr};
    const fs::path out = place_.out / record.name;
    const Attempts attempts(out);
    try {
      if (attempts.hopeless()) {
        throw std::runtime_error(fmt::format("the program died {} times at this record", Attempts::kMost));
      }
      attempts.begin();
      RecordAnswer given = question_.answer(record, out);
      line.answer = fleet::digest(kind_, given.answer);
      line.made_from = std::move(given.made_from);
      if (given.kept) ++kept_;
    } catch (const BadInput& error) {
      line.ended = Ended::kUnusable;
      line.error = error.what();
    } catch (const std::exception& error) {
      line.ended = Ended::kFault;
      line.error = fmt::format("internal error: {}", error.what());
    }
    if (line.ended != Ended::kAnswered) question_.remove(out);
    attempts.end();
    return line;
  }

  const BatchQuestion& question_;
  const BatchPlace& place_;
  const fleet::AnswerKind& kind_;
  fleet::ShardHeader header_;
  std::vector<ListedRecord> records_;
  std::atomic<std::size_t> kept_ = 0;
  Counts counts_;
};

}  // namespace

void add_batch_options(CLI::App& command, BatchPlace& place, CLI::Option& folder) {
  reads_file(
      command.add_option("--list", place.list, "Which records of the folder, and their vehicles, dates and mileages"))
      ->needs(&folder)
      ->type_name("LIST.csv");
  command.add_option("--shard", place.shard, "One of N parts of the records, for `steerid merge`")
      ->needs(&folder)
      ->type_name("K/N");
  whole_from(command.add_option("--threads", place.threads, "Records at the same time; 0: one a core"), 0, 1024)
      ->needs(&folder)
      ->type_name("COUNT")
      ->capture_default_str();
}

void run_batch(const BatchQuestion& question, const BatchPlace& place, FilesOfRun& files) {
  BatchRun(question, place).run(files);
}

}  // namespace steerid
