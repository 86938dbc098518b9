// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A fleet's summary as tables, for its page and for other tools.
#pragma once

#include <string>
#include <vector>

#include "fleet/summary.hpp"

namespace steerid::fleet {

/// "add coulomb_friction", "unknown"
[[nodiscard]] std::string words(const Summary::ChangeName& change);

/// Changes of a diagnosis by how common they are: effects first, then none, parameters and unknown.
[[nodiscard]] std::vector<Summary::ChangeName> by_share(const Summary& summary);

/// Written as files, in the order of the page; of those that a command has nothing for, no row:
///   changes     which are in what share of the records
///   quantities  sizes, and J, B and C, over records and vehicles
///   outliers    vehicles that are unlike the others
///   drift       over time and mileage
///   unknown     where unexplained gaps lie
///   refused     why records have no answer, or one that is not credible
[[nodiscard]] std::vector<FleetTable> summary_tables(const Summary& summary);

/// On the page only: the records behind the counts of the tables above, by the keys that their CountOf names.
[[nodiscard]] std::vector<FleetTable> record_tables(const Summary& summary);

}  // namespace steerid::fleet
