// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One question asked of many records: of a folder or of a list, whole or one shard of it, on all cores. What is asked
// is the command's (diagnose --batch, identify --folder); this is how it is gone through.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/files_of_run.hpp"
#include "fleet/record_list.hpp"
#include "fleet/shard.hpp"

namespace steerid {

/// Which records, and where the answers go.
struct BatchPlace {
  std::filesystem::path folder;
  std::filesystem::path list;  ///< empty: every record of the folder
  std::filesystem::path out;
  std::string shard;     ///< as --shard has it; empty: all of them
  unsigned threads = 0;  ///< 0: one a core
};

/// --list, --shard and --threads of `command`; each needs `folder`, the option that names the records' folder.
void add_batch_options(CLI::App& command, BatchPlace& place, CLI::Option& folder);

/// What one record has been answered.
struct RecordAnswer {
  nlohmann::ordered_json made_from;  ///< {"log":{"bytes":,"sha256":},..}
  nlohmann::ordered_json answer;     ///< as in the answer's file
  bool kept = false;                 ///< from an earlier run
};

struct BatchQuestion {
  std::string command;             ///< "diagnose" or "identify"
  nlohmann::ordered_json options;  ///< all that an answer hangs on beside program and files
  std::string label;               ///< of the progress bar
  /// Answers one record into the folder `out`. Called from several threads.
  std::function<RecordAnswer(const fleet::ListedRecord&, const std::filesystem::path& out)> answer;
  /// The files that answer() reads of a record, and those that it writes into `out`.
  std::function<std::vector<std::filesystem::path>(const fleet::ListedRecord&)> inputs;
  std::function<std::vector<std::filesystem::path>(const std::filesystem::path& out)> outputs;
  /// Takes away what answer() has written into `out` earlier.
  std::function<void(const std::filesystem::path& out)> remove;
};

/// Answers every record into a folder of place.out of the record's name, and writes place.out/table.csv; of a shard
/// place.out/fleet/shard_K_of_N.jsonl and .csv, for `steerid merge`. Without a shard what `steerid merge` writes is
/// written, too. A record that cannot be used keeps no other from being answered; neither does one at which this
/// program has died three times.
///
/// Throws BadOption when an answer would lie where a record does, BadInput when there is nothing to answer, nowhere to
/// write, or when a record was not usable; and std::runtime_error when this program was at fault in one.
void run_batch(const BatchQuestion& question, const BatchPlace& place, FilesOfRun& files);

}  // namespace steerid
