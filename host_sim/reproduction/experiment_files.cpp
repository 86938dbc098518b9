// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/experiment_files.hpp"

#include "log/output_folder.hpp"

namespace steerid {

void write_experiment(const std::filesystem::path& folder, const ExperimentResults& results,
                      const nlohmann::ordered_json& program) {
  const std::string json = experiment_json(results, program);
  const std::string html = report::html(experiment_page(results));
  write_together(folder, {{"experiment.json", json}, {"report.html", html}});
}

}  // namespace steerid
