// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid merge`: the shards of a run, brought together.
#include "fleet/merge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "apps/commands.hpp"
#include "apps/figures_option.hpp"
#include "apps/fleet_page.hpp"
#include "apps/option_kinds.hpp"
#include "log/bad_input.hpp"
#include "log/progress.hpp"

namespace steerid {
namespace {

struct MergeCommand {
  std::vector<std::filesystem::path> shards;
  std::filesystem::path out;
  bool allow_missing = false;
  std::filesystem::path figures;
};

void merge(const MergeCommand& command, FilesOfRun& files) {
  fleet::Merged merged;
  {
    std::optional<Progress> progress;
    merged =
        merge_with_report(command.shards, command.out, command.allow_missing, [&](std::size_t done, std::size_t of) {
          if (!progress) progress.emplace("merging", of);
          progress->at(done);
        });
  }
  write_figures_of_page(command.out / fleet::kFleetFolder / "report.html", command.figures, files);
  fmt::print("{} records, {} answered, {} not usable", merged.records, merged.answered, merged.unusable);
  if (merged.faults > 0) fmt::print(", {} ended in a fault of this program", merged.faults);
  fmt::print("; table in {}\n", printable((command.out / "table.csv").string()));
  if (!merged.missing_shards.empty()) {
    fmt::print("missing: shards {}, with {} records\n", fmt::join(merged.missing_shards, ", "), merged.missing_records);
  }
  if (merged.without_files > 0) {
    fmt::print("note: of {} records only the lines of their shards are here, not their own answers\n",
               merged.without_files);
  }
}

constexpr const char* kFooter =
    "A SHARD is the --out of `steerid diagnose --batch` or `steerid identify --folder` with --shard K/N, one a shard "
    "or\n"
    "one for all of them. DIR gets the files that one machine would have written for all records, byte for byte, "
    "however\n"
    "large N is; with DIR/fleet/report.html, a page of what the records have in common, and its tables as CSV and "
    "JSON\n"
    "lines beside it. Shards of another program, of other options or of another list of records are refused; missing "
    "ones "
    "are\n"
    "named. Records that were refused are in DIR/table.csv with the reason, and do not change the exit code.\n"
    "\n"
    "Example:\n"
    "  steerid diagnose --batch drives --out part1 --shard 1/2\n"
    "  steerid diagnose --batch drives --out part2 --shard 2/2\n"
    "  steerid merge part1 part2 --out gaps";

}  // namespace

void add_merge(CLI::App& app) {
  CLI::App* command = app.add_subcommand("merge", "Bring the shards of many records' answers together");
  auto options = std::make_shared<MergeCommand>();
  reads_folder(command->add_option("SHARD", options->shards, "Folders of answers, or the tables in them"))
      ->required()
      ->type_name("SHARD...");
  writes_folder(command->add_option("--out", options->out, "The folder of all answers; made when missing"))
      ->required()
      ->type_name("DIR");
  command->add_flag("--allow-missing", options->allow_missing, "Merge what is there although shards are missing");
  add_figures(*command, options->figures);
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun& files) { merge(*options, files); });
}

}  // namespace steerid
