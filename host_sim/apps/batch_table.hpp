// How each record of a batch ended, as DIR/table.csv and as the way the command ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace steerid {

struct BatchRow {
  enum class Ended : std::uint8_t {
    kDiagnosed,
    kKept,      ///< from an earlier run
    kUnusable,  ///< the data are at fault
    kFault,     ///< this program is
  };

  std::string name;
  Ended ended = Ended::kDiagnosed;
  std::vector<std::string> answer = {};  ///< the table's cells from verdict to closed_fraction; empty without an answer
  std::string error = {};                ///< why there is none; after "internal error: " when this program is at fault
};

/// From what diagnosis.json says.
[[nodiscard]] std::vector<std::string> cells_of(const nlohmann::ordered_json& diagnosis);

/// The row that `work` fills in, or that says how it threw.
[[nodiscard]] BatchRow row_of(const std::string& name, const std::function<void(BatchRow&)>& work);

/// case,verdict,probability,sim_nrmse,refit_nrmse,with_effect_nrmse,floor_nrmse,closed_fraction,error
void write_batch_table(const std::filesystem::path& target, const std::vector<BatchRow>& rows);

/// Whether a batch has written this file: by its first line, as a record's is another.
[[nodiscard]] bool is_batch_table(const std::filesystem::path& file);

/// How many ended how, one sentence.
[[nodiscard]] std::string batch_summary(const std::vector<BatchRow>& rows);

/// Throws what makes the command end with the exit code of the worst row: std::runtime_error when this program was at
/// fault, else BadInput when a record was not usable. `table` says more.
void end_as_the_worst(const std::vector<BatchRow>& rows, const std::filesystem::path& table);

}  // namespace steerid
