// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The files of the experiment: report.html for readers, experiment.json for programs. Each appears whole or not at all,
// and nothing is written before both are made.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "report/page.hpp"
#include "reproduction/experiment_results.hpp"

namespace steerid {

/// {"schema":"steerid.experiment/1", "program":`program`, ...}: every number behind the tables and figures of the page.
[[nodiscard]] std::string experiment_json(const ExperimentResults& results, const nlohmann::ordered_json& program);
[[nodiscard]] report::Page experiment_page(const ExperimentResults& results);

/// Makes `folder` when it is missing. Throws BadInput when it cannot be written.
void write_experiment(const std::filesystem::path& folder, const ExperimentResults& results,
                      const nlohmann::ordered_json& program);

}  // namespace steerid
