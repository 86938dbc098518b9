// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid diagnose`: the sim-to-real gap of one record, or of a folder of them.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/diagnose_batch.hpp"
#include "apps/diagnosis_request.hpp"
#include "apps/diagnosis_words.hpp"
#include "apps/figures_option.hpp"
#include "apps/json_lines.hpp"
#include "apps/option_kinds.hpp"
#include "apps/possibilities.hpp"
#include "apps/seed_option.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;

struct DiagnoseCommand {
  std::vector<fs::path> records;
  DiagnosisFiles files;
  BatchPlace batch;
  bool json_lines = false;
  DiagnosisRequest request;
  std::filesystem::path figures;
};

std::string share_text(const gap::BoundedValue& closed) {
  if (!std::isfinite(closed.value)) return "-";
  return fmt::format("{:.0f} % ({})", 100 * closed.value, percent_range(closed.low, closed.high));
}

/// Of a run that diverges there is none.
std::string nrmse_text(double nrmse) { return std::isfinite(nrmse) ? fmt::format("{:.4f}", nrmse) : "-"; }

void print(const gap::Diagnosis& diagnosis) {
  fmt::print("{}\n\n", verdict_sentence(diagnosis));
  const bool several = names_several(diagnosis);
  fmt::print("verdict    {}{}, probability {:.2f}{}\n", diagnosis.verdict,
             several ? fmt::format(" and {} more", diagnosis.causes.size() - 1) : "", probability_of_answer(diagnosis),
             several ? " or more, each" : "");
  if (!diagnosis.equivalent.empty()) {
    fmt::print("equivalent {}\n", fmt::join(diagnosis.equivalent, ", "));
  }
  for (const gap::Cause& cause : diagnosis.causes) {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < cause.effect.values.size(); ++i) {
      values.push_back(fmt::format("{} {:.4g}", cause.effect.type->parameters[i].name, cause.effect.values[i]));
    }
    const std::string change = cause.change == gap::ChangeKind::kAdd ? "" : fmt::format("{} ", name(cause.change));
    fmt::print("{}      {}{} ({}), probability {:.2f}\n", diagnosis.surrogate ? "like " : "cause", change,
               cause.effect.type->id, fmt::join(values, ", "), cause.probability);
  }
  constexpr std::size_t kOthers = 2;
  std::vector<std::string> others;
  for (const Possibility& one : possibilities(diagnosis)) {
    if (!one.named && others.size() < kOthers) others.push_back(fmt::format("{} {:.2f}", one.name, one.probability));
  }
  fmt::print("not named  {}\n", fmt::join(others, ", "));
  const gap::GapSizes& gap = diagnosis.gap;
  fmt::print("nrmse      simulation {}, refitted {}, with the effect {}, noise alone {}; closed {}\n",
             nrmse_text(gap.sim_nrmse), nrmse_text(gap.refit_nrmse), nrmse_text(gap.with_effect_nrmse),
             nrmse_text(gap.floor_nrmse), share_text(gap.closed_fraction));
  if (!diagnosis.where.says.empty()) fmt::print("where      {}\n", diagnosis.where.says);
  if (!diagnosis.next_experiment.why.empty()) fmt::print("next       {}\n", diagnosis.next_experiment.why);
  for (const std::string& note : diagnosis.notes) fmt::print("note       {}\n", note);
}

/// What is known of a simulation by its prediction alone.
void print(const gap::PredictedSimulation& predicted) {
  std::vector<std::string> effects;
  for (const Effect& effect : predicted.simulation.effects) effects.emplace_back(effect.type->id);
  const WheelArm& wheel = predicted.simulation.wheel;
  fmt::print("prediction J {:.4g} kgm2, B {:.4g} Nms/rad, C {:.4g} Nm/rad, {}; misses the prediction by {:.2g} %\n\n",
             wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad,
             effects.empty() ? "no effects" : fmt::format("{}", fmt::join(effects, ", ")),
             100 * predicted.missed_nrmse);
}

void diagnose_one(const DiagnosisFiles& files, const DiagnosisRequest& request) {
  gap::DiagnoseOptions options = request.options();
  const DiagnosisInputs inputs = read_inputs(files, request, options);
  const auto from = made_from(files, request);
  make_output_folder(files.out);
  DiagnosisOutcome outcome;
  {
    Progress progress("diagnosing", 100);
    options.at_part = [&](double part) { progress.at(static_cast<std::uint64_t>(100 * part)); };
    outcome = diagnosis_of(inputs, files, options);
  }
  if (inputs.predicted) print(*inputs.predicted);
  print(outcome.diagnosis);
  write_diagnosis(outcome, inputs, files, request, from);
  if (request.report) fmt::print("report     {}\n", printable((files.out / "report.html").string()));
}

/// One record of a pipe: no file is written but where the request names a folder for its answer.
nlohmann::ordered_json answered(const nlohmann::ordered_json& asked, const DiagnoseCommand& command) {
  DiagnosisFiles files{text_of(asked, "real"), command.files.sim, {}};
  if (asked.contains("pred")) {
    files.pred = text_of(asked, "pred");
  } else if (asked.contains("sim") || files.sim.empty()) {
    files.sim = text_of(asked, "sim");
  }
  gap::DiagnoseOptions options = command.request.options();
  options.threads = 1;  // who pipes to many processes has given each a core
  const DiagnosisInputs inputs = read_inputs(files, command.request, options);
  const auto from = made_from(files, command.request);
  if (!asked.contains("out")) {
    auto answer = answer_json(diagnosis_of(inputs, files, options).diagnosis, files, command.request);
    answer["made_from"] = from;
    return answer;
  }
  files.out = text_of(asked, "out");
  make_output_folder(files.out);
  return write_diagnosis(diagnosis_of(inputs, files, options), inputs, files, command.request, from);
}

void diagnose_lines(const DiagnoseCommand& command) {
  (void)command.request.log.format();  // an option that cannot be read is no request's fault
  answer_lines(std::cin, std::cout, [&](const auto& asked) { return answered(asked, command); });
}

std::vector<std::string> effect_ids() {
  std::vector<std::string> ids;
  for (const EffectType* type : effects()) ids.emplace_back(type->id);
  return ids;
}

constexpr const char* kFooter =
    "Writes DIR/report.html, DIR/diagnosis.json and DIR/sim_with_effect.json, which `steerid simulate --replay` "
    "loads.\n"
    "\n"
    "With --batch every record of a folder is diagnosed, on all cores: either folders that hold log.csv and sim.json,\n"
    "or NAME.csv beside NAME.json; with --sim that one file is the simulation of every record, and their own are not\n"
    "looked at. --list names records of the folder, their simulations, vehicles, dates and mileages.\n"
    "DIR/table.csv has one row a record, DIR/fleet/records.jsonl one JSON line. A record that cannot be used is named\n"
    "there and the others go on; the command then ends with 1. An answer that is there already is kept when this\n"
    "program made it with the same options from the same files, so that an interrupted run can be gone on with.\n"
    "--shard K/N answers one of N parts, on any machine; `steerid merge` brings them together.\n"
    "\n"
    "Examples:\n"
    "  steerid diagnose --real drive.csv --sim wheel.json --out gap\n"
    "  steerid diagnose --real drive.csv --pred my_simulators_angle.csv --out gap\n"
    "  steerid diagnose --real monday.csv --real tuesday.csv --sim wheel.json --out gap\n"
    "  steerid diagnose --batch drives --out gaps";

}  // namespace

void add_diagnose(CLI::App& app) {
  CLI::App* command = app.add_subcommand("diagnose", "Where simulation and wheel disagree, why, and how far it closes");
  auto options = std::make_shared<DiagnoseCommand>();
  CLI::Option* real =
      reads_file(command->add_option("--real", options->records,
                                     "The measured record; several of one wheel are diagnosed together, "
                                     "each with a --real of its own"))
          ->type_name("LOG.csv")
          ->allow_extra_args(false);
  CLI::Option* sim = reads_file(command->add_option("--sim", options->files.sim,
                                                    "The simulated wheel; with --batch that of every record"))
                         ->type_name("SIM.json");
  CLI::Option* pred =
      reads_file(command->add_option("--pred", options->files.pred,
                                     "In place of --sim: the angle that your own simulator takes under the record's "
                                     "torques, columns time_s and angle_rad"))
          ->type_name("PRED.csv")
          ->excludes(sim);
  CLI::Option* batch =
      reads_folder(command->add_option("--batch", options->batch.folder, "A folder of records, in place of --real"))
          ->type_name("DIR");
  add_batch_options(*command, options->batch, *batch);
  CLI::Option* out =
      writes_folder(command->add_option("--out", options->files.out, "The folder of the answer; made when missing"))
          ->type_name("DIR");
  command
      ->add_flag("--json-lines", options->json_lines,
                 R"(A request a line on standard input, as {"real":"drive.csv","sim":"sim.json"}; an answer a line on )"
                 "standard output")
      ->excludes(real)
      ->excludes(batch)
      ->excludes(out);
  add_log_options(*command, options->request.log);
  command->get_option("--with")->needs(real);
  add_seed(*command, options->request.seed, "Of the bootstrap");
  one_of(command->add_option("--without", options->request.without, "Effects to take out of the library"), effect_ids())
      ->delimiter(',')
      ->type_name("ID,...");
  number_from(command->add_option("--time-limit", options->request.time_limit_s,
                                  "After so long a record is answered with what is known of it by then"),
              0, 86400)
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_flag_callback(
      "--no-report", [options] { options->request.report = false; }, "Leave out report.html and what only it shows");
  add_figures(*command, options->figures)->needs(real)->excludes("--no-report");
  real->excludes(batch);
  pred->needs(real);
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun& files) {
    if (options->json_lines) {
      diagnose_lines(*options);
      return;
    }
    if (options->files.out.empty()) throw CLI::RequiredError("--out");
    if (!options->batch.folder.empty()) {
      options->batch.out = options->files.out;
      diagnose_batch(options->batch, options->files.sim, options->request, files);
    } else if (!options->records.empty()) {
      options->files.log = options->records.front();
      options->files.further.assign(options->records.begin() + 1, options->records.end());
      if (!options->files.further.empty() && !options->files.pred.empty()) {
        throw CLI::ExcludesError("--pred", "more than one --real");
      }
      if (options->files.simulated().empty()) throw CLI::RequiredError("--sim or --pred");
      for (const fs::path& file : answer_files(options->files.out, options->request)) files.writes(file, "--out");
      diagnose_one(options->files, options->request);
      write_figures_of_page(options->files.out / "report.html", options->figures, files);
    } else {
      throw CLI::RequiredError("--real or --batch");
    }
  });
}

}  // namespace steerid
