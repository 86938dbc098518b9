// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Labelled records of a folder: the answers that lie beside them, and what is said of each without them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "log/log_reader.hpp"

namespace steerid::test {

/// FOLDER/key.json: a label and more for each record's name.
inline nlohmann::json labels_of(const std::filesystem::path& folder) {
  nlohmann::json key;
  std::ifstream(folder / "key.json") >> key;
  return key;
}

/// Of FOLDER/cases/NAME, by one thread and without figures: many of them are asked at once.
inline gap::Diagnosis diagnosis_of(const std::filesystem::path& folder, const std::string& name) {
  gap::DiagnoseOptions options;
  options.threads = 1;
  options.figures = false;
  const auto at = folder / "cases" / name;
  return diagnose(read_log(at / "log.csv"), Simulation::load(at / "sim.json"), options);
}

/// With STEERID_FEW_RECORDS set, a build that is too slow for all records keeps those that are named. Whether it did:
/// what holds of every record is tested then, and a count of right answers means nothing.
template <class Labelled>
bool keep_few(std::vector<Labelled>& all, const std::set<std::string>& named) {
  if (std::getenv("STEERID_FEW_RECORDS") == nullptr) return false;
  std::erase_if(all, [&](const Labelled& one) { return !named.contains(one.name); });
  return true;
}

}  // namespace steerid::test
