// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid experiment --out DIR`: the study of Lv et al. (2018) on ten virtual drivers, as a page and as numbers.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "apps/commands.hpp"
#include "apps/figures_option.hpp"
#include "apps/made_from.hpp"
#include "apps/option_kinds.hpp"
#include "apps/seed_option.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "reproduction/conclusions.hpp"
#include "reproduction/experiment_files.hpp"

namespace steerid {
namespace {

struct ExperimentOptions {
  std::filesystem::path out;
  ExperimentSettings settings;
  std::filesystem::path figures;
};

void print(const ExperimentResults& results) {
  const ExperimentSettings& settings = results.run.settings;
  fmt::print("experiment    {} virtual drivers, 2 tasks, 6 hand positions, seed {}\n", kSubjects, settings.seed);
  for (const std::string& sentence : conclusions(results)) fmt::print("              {}\n", sentence);
  const DriverStateScore& driver = results.driver_probed;
  fmt::print("driver state  told {:.1f} % of the time, wrong {:.1f} % of that\n", 100 * driver.told_share(driver.state),
             100 * driver.wrong_share(driver.state));
}

void experiment(const ExperimentOptions& options, FilesOfRun& files) {
  make_output_folder(options.out);
  ExperimentResults results;
  {
    Progress progress("experiment", experiment_jobs());
    results = experiment_results(options.settings, [&](std::size_t done) { progress.at(done); });
  }
  print(results);
  write_experiment(options.out, results, program_json());
  write_figures_of_page(options.out / "report.html", options.figures, files);
  fmt::print("written to    {}: report.html, experiment.json\n", printable(options.out.string()));
}

constexpr const char* kFooter =
    "Tables I and II, figures 5 to 10, what the excitation can show, the convergence theory and the driver's state.\n"
    "Any number of cores gives the same files.\n"
    "\n"
    "Example:\n"
    "  steerid experiment --out experiment";

}  // namespace

void add_experiment(CLI::App& app) {
  CLI::App* command = app.add_subcommand("experiment", "The paper's experiment on ten virtual drivers, as a report");
  auto options = std::make_shared<ExperimentOptions>();
  writes_folder(command->add_option("--out", options->out, "The folder of its files; made when missing"))
      ->required()
      ->type_name("DIR");
  add_seed(*command, options->settings.seed);
  number_from(command->add_option("--probe", options->settings.probe_rms_nm,
                                  "The small probe that the second record of each pair adds, Nm rms"),
              0.01, 5.0)
      ->type_name("NM")
      ->capture_default_str();
  number_from(command->add_option("--unmeasured", options->settings.unmeasured_percent,
                                  "Slow torque that no sensor sees, rms in percent of the applied torque's"),
              0.0, 20.0)
      ->type_name("PERCENT")
      ->capture_default_str();
  number_from(command->add_option("--drift", options->settings.stiffness_swing,
                                  "Share by which the driver's stiffness drifts, either way"),
              0.0, 0.5)
      ->type_name("SHARE")
      ->capture_default_str();
  add_figures(*command, options->figures);
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun& files) { experiment(*options, files); });
}

}  // namespace steerid
