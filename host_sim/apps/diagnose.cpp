// `steerid diagnose`: the sim-to-real gap of one record, or of a folder of them.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/diagnosis_page.hpp"
#include "apps/diagnosis_words.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/diagnosis_json.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "log/whole_file.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/simulation.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;

struct DiagnoseCommand {
  fs::path real;
  fs::path sim;
  fs::path out;
  fs::path batch;
  std::string columns;
  std::string sign;
  std::uint64_t seed = 1;
  std::vector<std::string> without;
  bool no_report = false;
};

LogFormat format_of(const DiagnoseCommand& command) {
  LogFormat format;
  if (!command.columns.empty()) format.columns = parse_columns(command.columns);
  if (!command.sign.empty()) format.reversed = parse_sign(command.sign);
  return format;
}

/// A sentence about the record with the record's name in front.
[[noreturn]] void complain_about(const fs::path& log, const BadInput& error) {
  throw BadInput(fmt::format("{}: {}", log.string(), error.what()));
}

Diagnosis diagnosis_of(const fs::path& log, const fs::path& sim, const DiagnoseCommand& command,
                       const DiagnoseOptions& options) {
  const Simulation simulation = Simulation::load(sim);
  RecordQuality seen;
  const Record record = read_log(log, format_of(command), &seen);
  Diagnosis diagnosis;
  try {
    diagnosis = diagnose(record, simulation, options);
  } catch (const BadInput& error) {
    complain_about(log, error);
  }
  diagnosis.notes.insert(diagnosis.notes.begin(), seen.notes.begin(), seen.notes.end());
  return diagnosis;
}

DiagnoseOptions options_of(const DiagnoseCommand& command) {
  DiagnoseOptions options;
  options.seed = command.seed;
  options.without = command.without;
  options.figures = !command.no_report;
  return options;
}

void write_diagnosis(const fs::path& folder, const fs::path& log, const fs::path& sim, const DiagnoseCommand& command,
                     const Diagnosis& diagnosis) {
  make_output_folder(folder);
  if (!command.no_report) {
    report::write_page(folder / "report.html", diagnosis_page({log.filename().string(), sim.filename().string(),
                                                               diagnosis, Simulation::load(sim)}));
  }
  write_whole_file(folder / "sim_with_effect.json", diagnosis.with_effect.to_json());
  write_whole_file(folder / "diagnosis.json", diagnosis_json(diagnosis).dump(2) + "\n");
}

std::string share_text(const BoundedValue& closed) {
  if (!std::isfinite(closed.value)) return "-";
  return fmt::format("{:.0f} % [{:.0f}, {:.0f}]", 100 * closed.value, 100 * closed.low, 100 * closed.high);
}

/// Of a run that diverges there is none.
std::string nrmse_text(double nrmse) { return std::isfinite(nrmse) ? fmt::format("{:.4f}", nrmse) : "-"; }

void print(const Diagnosis& diagnosis) {
  fmt::print("{}\n\n", verdict_sentence(diagnosis));
  fmt::print("verdict    {}, probability {:.2f}\n", diagnosis.verdict, diagnosis.ranking.front().probability);
  for (std::size_t i = 1; i < 3; ++i) {
    fmt::print("           {} {:.2f}\n", diagnosis.ranking[i].id, diagnosis.ranking[i].probability);
  }
  if (!diagnosis.equivalent.empty()) {
    fmt::print("equivalent {}\n", fmt::join(diagnosis.equivalent, ", "));
  }
  for (const Cause& cause : diagnosis.causes) {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < cause.effect.values.size(); ++i) {
      values.push_back(fmt::format("{} {:.4g}", cause.effect.type->parameters[i].name, cause.effect.values[i]));
    }
    fmt::print("{}      {} ({})\n", diagnosis.surrogate ? "like " : "cause", cause.effect.type->id,
               fmt::join(values, ", "));
  }
  const GapSizes& gap = diagnosis.gap;
  fmt::print("nrmse      simulation {}, refitted {}, with the effect {}, floor {}; closed {}\n",
             nrmse_text(gap.sim_nrmse), nrmse_text(gap.refit_nrmse), nrmse_text(gap.with_effect_nrmse),
             nrmse_text(gap.floor_nrmse), share_text(gap.closed_fraction));
  if (!diagnosis.where.says.empty()) fmt::print("where      {}\n", diagnosis.where.says);
  if (!diagnosis.next_experiment.why.empty()) fmt::print("next       {}\n", diagnosis.next_experiment.why);
  for (const std::string& note : diagnosis.notes) fmt::print("note       {}\n", note);
}

void diagnose_one(const DiagnoseCommand& command) {
  Diagnosis diagnosis;
  {
    Progress progress("diagnosing", 100);
    DiagnoseOptions options = options_of(command);
    options.at_part = [&](double part) { progress.at(static_cast<std::uint64_t>(100 * part)); };
    diagnosis = diagnosis_of(command.real, command.sim, command, options);
  }
  write_diagnosis(command.out, command.real, command.sim, command, diagnosis);
  print(diagnosis);
  if (!command.no_report) fmt::print("report     {}\n", (command.out / "report.html").string());
}

/// A record of a batch: a folder with log.csv and sim.json, or NAME.csv beside NAME.json.
struct Case {
  std::string name;
  fs::path log;
  fs::path sim;
};

std::vector<Case> cases_in(const fs::path& folder, const fs::path& sim) {
  if (!fs::is_directory(folder)) {
    throw BadInput(fmt::format("{}: expected a folder of records; check the path", folder.string()));
  }
  std::vector<Case> cases;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (entry.is_directory() && fs::exists(path / "log.csv")) {
      cases.push_back({path.filename().string(), path / "log.csv", sim.empty() ? path / "sim.json" : sim});
    } else if (entry.is_regular_file() && path.extension() == ".csv") {
      fs::path own = path;
      cases.push_back({path.stem().string(), path, sim.empty() ? own.replace_extension(".json") : sim});
    }
  }
  std::ranges::sort(cases, {}, &Case::name);
  if (cases.empty()) {
    throw BadInput(
        fmt::format("{}: expected records, found none; a record is a folder with log.csv and sim.json, or NAME.csv "
                    "beside NAME.json",
                    folder.string()));
  }
  return cases;
}

/// One row of the batch's table, from what diagnosis.json says or from why there is none.
std::string row_of(const std::string& name, const nlohmann::ordered_json& found, const std::string& error) {
  std::string says = error;
  std::ranges::replace(says, ',', ';');
  std::ranges::replace(says, '"', '\'');
  if (!error.empty()) return fmt::format("{},,,,,,,,{}\n", name, says);
  const auto number = [](const nlohmann::ordered_json& value) {
    return value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : std::string();
  };
  const auto& gap = found.at("gap");
  return fmt::format("{},{},{},{},{},{},{},{},\n", name, found.at("verdict").get<std::string>(),
                     number(found.at("ranking").at(0).at("probability")), number(gap.at("sim_nrmse")),
                     number(gap.at("refit_nrmse")), number(gap.at("with_effect_nrmse")), number(gap.at("floor_nrmse")),
                     number(gap.at("closed_fraction")));
}

/// Found earlier and still newer than the record and its simulation?
bool up_to_date(const fs::path& answer, const Case& one) {
  std::error_code missing;
  const auto written = fs::last_write_time(answer, missing);
  if (missing) return false;
  return written >= fs::last_write_time(one.log, missing) && !missing &&
         written >= fs::last_write_time(one.sim, missing) && !missing;
}

void diagnose_batch(const DiagnoseCommand& command) {
  const std::vector<Case> cases = cases_in(command.batch, command.sim);
  std::vector<std::string> rows(cases.size());
  std::atomic<std::size_t> bad = 0;
  std::atomic<std::size_t> kept = 0;
  {
    Progress progress("diagnosing", cases.size());
    work_in_parallel(
        cases.size(), 0, [&](std::size_t done) { progress.at(done); },
        [&](std::size_t i) {
          const Case& one = cases[i];
          const fs::path folder = command.out / one.name;
          const fs::path answer = folder / "diagnosis.json";
          try {
            if (up_to_date(answer, one)) {
              ++kept;
            } else {
              DiagnoseOptions options = options_of(command);
              options.threads = 1;
              write_diagnosis(folder, one.log, one.sim, command, diagnosis_of(one.log, one.sim, command, options));
            }
            std::ifstream stream(answer);
            rows[i] = row_of(one.name, nlohmann::ordered_json::parse(stream), "");
          } catch (const std::exception& error) {
            ++bad;
            rows[i] = row_of(one.name, {}, error.what());
          }
        });
  }
  std::string table =
      "case,verdict,probability,sim_nrmse,refit_nrmse,with_effect_nrmse,floor_nrmse,closed_fraction,error\n";
  for (const std::string& row : rows) table += row;
  make_output_folder(command.out);
  write_whole_file(command.out / "table.csv", table);
  fmt::print("{} records, {} kept from an earlier run, {} not usable; table in {}\n", cases.size(), kept.load(),
             bad.load(), (command.out / "table.csv").string());
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
    "or NAME.csv beside NAME.json. A record that cannot be used is named in the table and the others go on. What an\n"
    "interrupted run has written is kept; DIR/table.csv has one row a record.\n"
    "\n"
    "Examples:\n"
    "  steerid diagnose --real drive.csv --sim wheel.json --out gap\n"
    "  steerid diagnose --batch drives --out gaps";

}  // namespace

void add_diagnose(CLI::App& app) {
  CLI::App* command = app.add_subcommand("diagnose", "Where simulation and wheel disagree, why, and how far it closes");
  auto options = std::make_shared<DiagnoseCommand>();
  CLI::Option* real = command->add_option("--real", options->real, "The measured record")->type_name("LOG.csv");
  CLI::Option* sim = command->add_option("--sim", options->sim, "The simulated wheel")->type_name("SIM.json");
  CLI::Option* batch =
      command->add_option("--batch", options->batch, "A folder of records, in place of --real")->type_name("DIR");
  command->add_option("--out", options->out, "The folder of the answer; made when missing")
      ->required()
      ->type_name("DIR");
  command->add_option("--columns", options->columns, "Columns of other names or units, as angle=theta:deg")
      ->type_name("CHANNEL=COLUMN[:UNIT],...");
  command->add_option("--sign", options->sign, "Channels to turn round, as torque_driver=-1; -1 for both torques")
      ->type_name("CHANNEL=-1,...");
  command->add_option("--seed", options->seed, "Of the bootstrap")->capture_default_str();
  command->add_option("--without", options->without, "Effects to take out of the library")
      ->delimiter(',')
      ->check(CLI::IsMember(effect_ids()))
      ->type_name("ID,...");
  command->add_flag("--no-report", options->no_report, "Leave out report.html and what only it shows");
  real->needs(sim);
  real->excludes(batch);
  command->footer(kFooter);
  command->callback([options] {
    if (!options->batch.empty()) {
      diagnose_batch(*options);
    } else if (!options->real.empty()) {
      diagnose_one(*options);
    } else {
      throw CLI::RequiredError("--real or --batch");
    }
  });
}

}  // namespace steerid
