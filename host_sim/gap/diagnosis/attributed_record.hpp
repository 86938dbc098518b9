// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a record says beside what is known already: every hypothesis compared, and how probable each is.
#pragma once

#include <vector>

#include "gap/attribution/attribution.hpp"
#include "gap/comparison/comparison.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/preparation/prepared_record.hpp"

namespace steerid {

struct AttributedRecord {
  Comparison comparison;
  AttributionInput input;
  std::vector<double> probability;  ///< in the order of input.all, and that of unknown last
};

/// The likeliest of what was compared.
[[nodiscard]] const Evidence& likeliest(const AttributedRecord& record);

/// `present`: the effects that are known already.
[[nodiscard]] ComparisonSetting comparison_setting(const PreparedRecord& prepared, const Simulation& simulation,
                                                   const DiagnoseOptions& options, std::vector<Effect> present);

/// Beside what the simulation has. A coarse angle's rounding is known once its motion is: the record is prepared anew
/// with the rounding that the best effect's run makes, and compared anew.
[[nodiscard]] AttributedRecord attributed_record(PreparedRecord& prepared, const Simulation& simulation,
                                                 const DiagnoseOptions& options);

/// Beside effects found in it.
[[nodiscard]] AttributedRecord attributed_beside(const PreparedRecord& prepared, const Simulation& simulation,
                                                 const DiagnoseOptions& options, std::vector<Effect> present);

}  // namespace steerid
