// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which records a fleet has, and what is known of each beside its samples: by looking into a folder, or by a list.
//
// A list is CSV with a header; only `record` has to be there, and # starts a comment:
//
//   record,sim,vehicle,date,mileage_km
//   2026/a17.csv,models/sedan.json,VIN042,2026-05-01T13:45,10412.5
//
//   record      a log, or a folder that holds log.csv; from the records' folder
//   sim         its simulation, from the records' folder; without one sim.json beside log.csv, NAME.json beside
//   NAME.csv vehicle     any word; records of one vehicle belong together date        ISO 8601 mileage_km  of the
//   vehicle when it was recorded
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace steerid::fleet {

struct ListedRecord {
  std::string name;  ///< of its answer's folder, with '/' where the list names records in folders of folders
  std::string log;   ///< from the records' folder, with '/'
  std::string sim;
  std::string vehicle = {};  ///< empty where nobody says
  std::string date = {};
  std::optional<double> mileage_km = {};
};

/// The records directly in `folder`: folders that hold log.csv, and NAME.csv; by name. `is_output` tells a table that a
/// command has written there earlier. Throws BadInput when there is none, and when two have one name.
[[nodiscard]] std::vector<ListedRecord> records_in(const std::filesystem::path& folder,
                                                   const std::function<bool(const std::filesystem::path&)>& is_output);

/// The records of `list`, by vehicle and then by name. Whether a record is there is seen when it is its turn. Throws
/// BadInput naming the line of the list.
[[nodiscard]] std::vector<ListedRecord> records_on(const std::filesystem::path& list,
                                                   const std::filesystem::path& folder);

/// SHA-256 of all that the list says: two runs that agree on it mean the same records.
[[nodiscard]] std::string digest_of(const std::vector<ListedRecord>& records);

}  // namespace steerid::fleet
