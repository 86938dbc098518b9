// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What one record's answer tells about the fleet, whichever command gave it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace steerid::fleet {

/// Something that the record has with a probability.
struct ChangeFact {
  std::string effect;      ///< "coulomb_friction"; also "none", "parameters" and "unknown"
  std::string change;      ///< "add", "resize", "remove"; empty for the three
  double probability = 0;  ///< in [0, 1]
  double prior = 0;        ///< under which it was given
};

/// A number that the record was given, such as "inertia_kgm2" or "coulomb_friction level_nm".
struct QuantityFact {
  std::string name;
  double value = 0;
};

/// Where an unexplained gap lies; `axis` is empty where nobody says.
struct PlaceFact {
  std::string axis;  ///< "frequency"
  std::string unit;  ///< "Hz"
  double low = 0;
  double high = 0;
};

struct RecordFacts {
  std::vector<ChangeFact> changes;
  std::vector<QuantityFact> quantities;
  double closed = 0;  ///< share of the gap; NaN where there is none
  bool unknown = false;
  PlaceFact unexplained;
  std::string doubt;  ///< why an identification is not credible; empty where it is
};

/// Of a line of diagnose or identify. What a damaged or older answer lacks is left out.
///
/// diagnose: the probability of a change is that of "inclusion", or where the answer has none that of the verdict in
/// "ranking", as an effect to add. Its prior is "prior" of the entry where it says so, else one over the number of
/// entries: all are equally likely, and one is expected. Sizes are those of the named causes, but none of a surrogate.
[[nodiscard]] RecordFacts facts_of_diagnosis(const nlohmann::ordered_json& answer);
[[nodiscard]] RecordFacts facts_of_identification(const nlohmann::ordered_json& answer);

}  // namespace steerid::fleet
