// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/shard_set.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <queue>
#include <set>
#include <string>
#include <system_error>
#include <tuple>

#include "log/bad_input.hpp"

namespace steerid::fleet {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> tables_in(const fs::path& given) {
  std::error_code none;  // a place that cannot be looked at, such as a link to itself, holds no shard
  if (fs::is_regular_file(given, none)) return {given};
  std::vector<fs::path> found;
  const fs::path folder = given / kFleetFolder;
  if (fs::is_directory(folder, none)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("shard_") && name.ends_with(".jsonl")) found.push_back(entry.path());
    }
  }
  if (found.empty()) {
    throw bad_input({.file = given.string(),
                     .expected = "the --out of a run with --shard",
                     .found = "no finished shard",
                     .advice = "run the shard to its end first"});
  }
  std::ranges::sort(found);
  return found;
}

bool same_bytes(const fs::path& one, const fs::path& other) {
  if (fs::file_size(one) != fs::file_size(other)) return false;
  std::ifstream a(one, std::ios::binary);
  std::ifstream b(other, std::ios::binary);
  return std::equal(std::istreambuf_iterator<char>(a), {}, std::istreambuf_iterator<char>(b));
}

/// What the two were asked differently; empty where they agree.
std::string difference(const ShardHeader& one, const ShardHeader& other) {
  if (one.command != other.command) return fmt::format("{} beside {}", other.command, one.command);
  if (one.shard.of != other.shard.of) return fmt::format("{} shards beside {}", other.shard.of, one.shard.of);
  if (one.program != other.program) return "answers of another program";
  if (one.options != other.options) {
    for (const auto& [key, value] : one.options.items()) {
      const auto its = other.options.find(key);
      if (its == other.options.end() || *its != value) {
        return fmt::format("{} {} beside {}", key, its == other.options.end() ? "null" : its->dump(), value.dump());
      }
    }
    return "other options";
  }
  if (one.list_sha256 != other.list_sha256 || one.records_in_all != other.records_in_all) {
    return fmt::format("another list of records ({} beside {})", other.records_in_all, one.records_in_all);
  }
  return {};
}

auto place(const RecordLine& line) { return std::tie(line.record.vehicle, line.record.name); }

}  // namespace

ShardSet::ShardSet(const std::vector<fs::path>& given) {
  for (const fs::path& one : given) {
    for (const fs::path& table : tables_in(one)) add(table);
  }
  std::set<std::size_t> there;
  for (const Source& source : readers_) {
    there.insert(source.reader.header().shard.number);
    records_ += source.reader.header().records;
  }
  for (std::size_t number = 1; number <= question().shard.of; ++number) {
    if (!there.contains(number)) missing_.push_back(number);
  }
}

void ShardSet::add(const fs::path& file) {
  ShardReader reader(file);
  const Shard& shard = reader.header().shard;
  for (const Source& source : readers_) {
    const ShardReader& earlier = source.reader;
    if (const std::string differs = difference(earlier.header(), reader.header()); !differs.empty()) {
      throw bad_input({.file = file.string(),
                       .expected = fmt::format("a shard of the same run as {}", earlier.file().string()),
                       .found = differs,
                       .advice = "run it again, or merge shards of one run only"});
    }
    if (earlier.header().shard.number != shard.number) continue;
    if (same_bytes(earlier.file(), file)) return;
    throw bad_input({.file = file.string(),
                     .expected = fmt::format("the same answers as in {}", earlier.file().string()),
                     .found = "other ones",
                     .advice = fmt::format("keep one of the two tables of shard {}", shard.text())});
  }
  readers_.push_back({std::move(reader), {}, false});
}

void ShardSet::require_all() const {
  if (missing_.empty()) return;
  const ShardHeader& run = question();
  throw BadInput(fmt::format("shard{} {} of {} {} missing, with {} of {} records; run {} again with --shard K/{}",
                             missing_.size() == 1 ? "" : "s", fmt::join(missing_, ", "), run.shard.of,
                             missing_.size() == 1 ? "is" : "are", run.records_in_all - records_, run.records_in_all,
                             missing_.size() == 1 ? "it" : "them", run.shard.of));
}

void ShardSet::advance(Source& source) {
  source.more = source.reader.next(source.line);
  if (!source.more || source.reader.header().shard.holds(source.line.record.log)) return;
  throw bad_input({.file = source.reader.file().string(),
                   .expected = fmt::format("records of shard {}", source.reader.header().shard.text()),
                   .found = in_quotes(source.line.record.log),
                   .advice = "run the shard again"});
}

void ShardSet::each(const std::function<void(const RecordLine&, const fs::path&)>& take) {
  const auto later = [](const Source* one, const Source* other) { return place(one->line) > place(other->line); };
  std::priority_queue<Source*, std::vector<Source*>, decltype(later)> next(later);
  for (Source& source : readers_) {
    advance(source);
    if (source.more) next.push(&source);
  }
  while (!next.empty()) {
    Source& source = *next.top();
    next.pop();
    if (!next.empty() && place(next.top()->line) == place(source.line)) {
      throw bad_input({.file = source.reader.file().string(),
                       .expected = "records that no other shard has",
                       .found = in_quotes(source.line.record.name),
                       .advice = fmt::format("compare with {}", next.top()->reader.file().string())});
    }
    take(source.line, source.reader.file().parent_path().parent_path());
    advance(source);
    if (source.more) next.push(&source);
  }
}

}  // namespace steerid::fleet
