// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/merge.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <system_error>

#include "fleet/answer_table.hpp"
#include "fleet/shard_set.hpp"
#include "log/bad_input.hpp"
#include "log/input_file.hpp"
#include "log/output_folder.hpp"
#include "log/unfinished_files.hpp"
#include "log/whole_file.hpp"

namespace steerid::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostBytesOfAnswer = std::uint64_t{1} << 28;

/// One file of an answer into the folder of all answers: as a link, since an answer is replaced and never written into.
void bring(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (fs::equivalent(from, to, error)) return;
  const fs::path partial = to.parent_path() / fmt::format(".{}.partial-{}", to.filename().string(), ::getpid());
  const bool linked = link_unfinished(from, partial);
  if (linked && keep_unfinished(partial, to)) return;
  if (linked) remove_unfinished(partial);
  write_whole_file(to, read_whole_file(from, "an answer", kMostBytesOfAnswer));  // as between two disks
}

/// False when the folder of the shard's answers has none of this name.
bool gather(const std::string& name, const fs::path& answers, const fs::path& out) {
  const fs::path from = answers / name;
  std::error_code none;
  if (!fs::is_directory(from, none)) return false;
  if (fs::equivalent(answers, out, none)) return true;
  make_folders(out / name);
  for (const auto& entry : fs::directory_iterator(from)) {
    if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.')) {
      bring(entry.path(), out / name / entry.path().filename());
    }
  }
  return true;
}

/// The line, as a fault of this program where its answer is not what the table needs: it stops no other record.
RecordLine checked(const AnswerKind& kind, const RecordLine& line) {
  if (line.ended != Ended::kAnswered) return line;
  try {
    (void)kind.cells(line.answer);
    return line;
  } catch (const nlohmann::json::exception&) {
    RecordLine refused = line;
    refused.ended = Ended::kFault;
    refused.error = "internal error: the answer lacks what the table needs; run its shard again";
    refused.answer = nullptr;
    return refused;
  }
}

void count(Merged& merged, const RecordLine& line) {
  ++merged.records;
  merged.answered += line.ended == Ended::kAnswered ? 1 : 0;
  merged.unusable += line.ended == Ended::kUnusable ? 1 : 0;
  merged.faults += line.ended == Ended::kFault ? 1 : 0;
}

}  // namespace

Merged merge(const std::vector<fs::path>& shards, const fs::path& out, const MergeOptions& options) {
  ShardSet set(shards);
  if (!options.allow_missing) set.require_all();
  const AnswerKind& kind = kind_of(set.question().command);
  options.at_question(set.question());
  make_output_folder(out / kFleetFolder);
  Merged merged;
  merged.missing_shards = set.missing();
  merged.missing_records = set.question().records_in_all - set.records();
  AnswerTable table(kind, out / "table.csv");
  WholeFile lines(out / kFleetFolder / "records.jsonl");
  set.each([&](const RecordLine& given, const fs::path& answers) {
    const RecordLine line = checked(kind, given);
    table.add(line);
    lines.write(to_line(line));
    count(merged, line);
    if (line.ended == Ended::kAnswered && !gather(line.record.name, answers, out)) ++merged.without_files;
    options.at_record(line, merged.records, set.records());
  });
  table.commit();
  lines.commit();
  return merged;
}

}  // namespace steerid::fleet
