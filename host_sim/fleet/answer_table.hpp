// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The table of a run, a row a record: what a person looks at first, and what other tools have read so far.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "fleet/record_facts.hpp"
#include "fleet/shard_file.hpp"
#include "log/csv_writer.hpp"

namespace steerid::fleet {

/// What a command's answers look like in a line of a shard and in the table.
///
/// diagnose: case,verdict,probability,sim_nrmse,refit_nrmse,with_effect_nrmse,floor_nrmse,closed_fraction,error
/// identify: case,inertia_kgm2,inertia_sd_kgm2,inertia_state,...,stiffness_state,free_run_nrmse,doubt,error
struct AnswerKind {
  std::string_view command;
  std::vector<std::string> columns;    ///< header of the table
  std::vector<std::string_view> kept;  ///< fields of the answer's own file that a shard's line has
  std::vector<std::string> (*cells)(const nlohmann::ordered_json& answer);  ///< of the columns between case and error
  RecordFacts (*facts)(const nlohmann::ordered_json& answer);
};

/// Throws BadInput when the command has no fleet.
[[nodiscard]] const AnswerKind& kind_of(std::string_view command);

/// The part of an answer that a fleet needs.
[[nodiscard]] nlohmann::ordered_json digest(const AnswerKind& kind, const nlohmann::ordered_json& answer);

class AnswerTable {
 public:
  AnswerTable(const AnswerKind& kind, const std::filesystem::path& target);
  void add(const RecordLine& line);
  void commit() { csv_.commit(); }

 private:
  const AnswerKind& kind_;
  CsvWriter csv_;
};

/// Whether one of the commands has written this file: by its first line, as a record's is another.
[[nodiscard]] bool is_answer_table(const std::filesystem::path& file);

}  // namespace steerid::fleet
