// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Labelled records of a folder: the answers that lie beside them, and what is said of each without them.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace steerid::test
