// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid study NAME --out DIR`: a Monte Carlo study of the estimators, as files and as a table on the terminal.
#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/made_from.hpp"
#include "apps/option_kinds.hpp"
#include "apps/seed_option.hpp"
#include "apps/study_blind.hpp"
#include "apps/study_findings.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "study/closed_loop.hpp"
#include "study/study_files.hpp"

namespace steerid {
namespace {

/// The Monte Carlo studies of the estimators on steady drives and of the closed loop.
struct StudyOptions {
  std::string name;
  std::filesystem::path out;
  std::size_t drives = 500;
  std::uint64_t seed = 1;
};

nlohmann::ordered_json made_by(const StudyOptions& options) {
  return {{"options", {{"drives", options.drives}, {"seed", options.seed}}}, {"program", program_json()}};
}

StudyPlan plan_called(const std::string& name) {
  for (const StudyPlan& plan : all_studies()) {
    if (plan.name == name) return plan;
  }
  throw std::logic_error("a study passed its validator but is not known");
}

std::string covered(const ParameterScore& p) { return p.coverage ? fmt::format("{:.1f}", 100 * *p.coverage) : "-"; }

void print(const StudyResult& result) {
  fmt::print("{}; {} drives a case, seed {}\n\n", result.plan.title, result.drives, result.seed);
  fmt::print("{:24}{:>28}{:>28}{:>26}{:>10}{:>11}\n", "", "bias in %: J       B       C",
             "RMSE/bound: J       B       C", "covers %: J      B      C", "NEES", "restarted");
  for (const CaseResult& one : result.cases) {
    fmt::print("{}, {}\n", one.what.wheel, one.what.noise);
    for (std::size_t m = 0; m < one.scores.size(); ++m) {
      const MethodScore& s = one.scores[m];
      const auto& [j, b, c] = s.parameters;
      fmt::print("  {:22}{:>12.3f}{:>8.3f}{:>8.3f}{:>14.3g}{:>8.3g}{:>8.3g}{:>12}{:>7}{:>7}{:>10}{:>11}\n",
                 name(result.plan.methods[m]), j.bias_percent, b.bias_percent, c.bias_percent, j.ratio, b.ratio,
                 c.ratio, covered(j), covered(b), covered(c), s.nees ? fmt::format("{:.3g}", *s.nees) : "-",
                 s.restarted);
    }
  }
}

constexpr const char* kClosedLoop = "closed_loop";

/// Mean and standard error of a bias, "-0.12 +- 0.04".
std::string bias_text(const ClosedLoopBias& bias, int i) {
  return fmt::format("{:.2f} +- {:.2f}", bias.percent(i), bias.error_percent(i));
}

void closed_loop_study(const StudyOptions& options) {
  make_output_folder(options.out);
  ClosedLoopStudy result;
  {
    Progress progress(kClosedLoop, closed_loop_cases().size() * options.drives);
    result = run_closed_loop_study(options.drives, options.seed, [&](std::size_t done) { progress.at(done); });
  }
  fmt::print("Bias in % of J, B, C; {} drives a case, seed {}\n\n", result.drives, result.seed);
  for (const ClosedLoopResult& one : result.results) {
    fmt::print("{}, {:g} Nm unmeasured, probe of {:g} Nm rms\n", one.what.name, one.what.unmeasured_nm,
               one.what.probe_rms_nm);
    const auto line = [](const char* method, const ClosedLoopBias& bias) {
      fmt::print("  {:20}{:>18}{:>18}{:>18}\n", method, bias_text(bias, 0), bias_text(bias, 1), bias_text(bias, 2));
    };
    line("recursive", one.recursive);
    if (one.what.probe_rms_nm > 0) line("probe as instrument", one.probe);
    fmt::print("  {:20}{:>17.0f}%{:>17.0f}%{:>17.0f}%\n", "ends valid in", 100 * one.valid_share(0),
               100 * one.valid_share(1), 100 * one.valid_share(2));
  }
  write_closed_loop(options.out, result, made_by(options));
  fmt::print("\nwritten to {}: {name}.csv, {name}.json, {name}.html\n", printable(options.out.string()),
             fmt::arg("name", kClosedLoop));
}

void monte_carlo_study(const StudyOptions& options) {
  if (options.name == kClosedLoop) {
    closed_loop_study(options);
    return;
  }
  const StudyPlan plan = plan_called(options.name);
  make_output_folder(options.out);
  StudyResult result;
  {
    Progress progress(plan.name, plan.cases.size() * options.drives);
    result = run_study(plan, options.drives, options.seed, 0, [&](std::size_t done) { progress.at(done); });
  }
  print(result);
  write_study(options.out, result, made_by(options));
  fmt::print("\nwritten to {}: {name}.csv, {name}.json, {name}.html\n", printable(options.out.string()),
             fmt::arg("name", plan.name));
}

void study(const FindingsOptions& options) {
  const std::vector<std::string> with_findings = findings_studies();
  if (std::find(with_findings.begin(), with_findings.end(), options.name) != with_findings.end()) {
    findings_study(options);
    return;
  }
  if (options.hours || options.changes || options.minutes || options.updates || options.unmeasured_percent ||
      options.angle_offset_rad)
    throw CLI::ValidationError(options.name, "this study has --drives only");
  StudyOptions monte_carlo{options.name, options.out, 500, options.seed};
  monte_carlo.drives = options.drives.value_or(monte_carlo.drives);
  monte_carlo_study(monte_carlo);
}

constexpr const char* kFooter =
    "efficiency   bias, error over the Cramer-Rao bound and coverage of six methods, on three arms at two noise "
    "levels\n"
    "uncertainty  coverage and NEES of the project's own methods under white noise, resolution and unmeasured torque\n"
    "column       the arm of a driver who steers, from torsion bar and probe, on drawn and on held-out columns\n"
    "probe        what the task's own probe costs and reaches, beside one of a fixed size; delivered late or clipped\n"
    "closed_loop  bias by a driver who answers to the angle, and what the probe as instrument makes of it\n"
    "excitation   what is called valid on drives that show some parameters, all or none, against the information\n"
    "tracking     drift over minutes that show nothing, time to follow another arm, false resets; ramps, steps, "
    "swings\n"
    "hands        how soon hands off is told, and how often falsely, beside a threshold on the torsion bar\n"
    "friction     what dry friction above the torsion bar costs, and what is left once the task knows its size\n"
    "validity     hours of drawn drives: how much of what is called valid is wrong, by what the arm does\n"
    "faults       every defect of a sensor or the bus: how long it misleads, how soon the estimate is right again\n"
    "soak         millions of updates in float and fixed point, and hours of exactly nothing\n"
    "\n"
    "column, tracking, hands, validity, faults and soak say of every figure that was set out to be reached whether it "
    "is met.\n"
    "\n"
    "A drive depends on the seed and its number only: any number of cores gives the same files.\n"
    "\n"
    "Example:\n"
    "  steerid study efficiency --drives 500 --out study";

}  // namespace

void add_study(CLI::App& app) {
  CLI::App* command = app.add_subcommand("study", "How good the estimators are, over hundreds of seeded drives");
  auto options = std::make_shared<FindingsOptions>();
  std::vector<std::string> names;
  for (const StudyPlan& plan : all_studies()) names.push_back(plan.name);
  names.emplace_back(kClosedLoop);
  for (const std::string& name : findings_studies()) names.push_back(name);
  one_of(command->add_option("NAME", options->name, "The study"), names)->type_name("NAME");
  writes_folder(command->add_option("--out", options->out, "The folder of its files; made when missing"))
      ->type_name("DIR");
  whole_from(
      command->add_option("--drives", options->drives,
                          "Drives in each case: 500; tracking and hands 100, column 48, probe 12, faults 20 of each "
                          "defect, validity 12 of ten minutes; excitation 1000 in all"),
      10, 100'000)
      ->type_name("COUNT");
  whole_from(command->add_option("--hours", options->hours,
                                 "tracking: hours of mixed driving in each case; hands: of held wheels; 20"),
             1, 10'000)
      ->type_name("COUNT");
  whole_from(command->add_option("--changes", options->changes,
                                 "tracking: drives of each kind of change of the arm, 24; 0 for none"),
             0, 10'000)
      ->type_name("COUNT");
  whole_from(command->add_option("--minutes", options->minutes,
                                 "validity: length of a drive, 10; those of a single change last one minute"),
             1, 600)
      ->type_name("COUNT");
  whole_from(command->add_option("--updates", options->updates, "soak: of each kind of number, 20000000"), 10'000,
             100'000'000'000)
      ->type_name("COUNT");
  number_from(command->add_option("--unmeasured", options->unmeasured_percent,
                                  "faults: slow torque that no sensor sees, in percent of the probe's rms, 0"),
              0.0, 50.0)
      ->type_name("PERCENT");
  number_from(command->add_option("--angle-offset", options->angle_offset_rad,
                                  "tracking: by which the angle's sensor is off in the drives of a change, 0"),
              -0.5, 0.5)
      ->type_name("RAD");
  add_seed(*command, options->seed);
  command->footer(kFooter);
  add_study_blind(*command);
  command->require_subcommand(0, 1);
  runs(*command, [options, command](FilesOfRun&) {
    if (!command->get_subcommands().empty()) return;
    if (options->name.empty()) throw CLI::RequiredError("NAME");
    if (options->out.empty()) throw CLI::RequiredError("--out");
    study(*options);
  });
}

}  // namespace steerid
