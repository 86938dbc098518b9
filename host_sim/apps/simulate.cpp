// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// steerid simulate: a drive as the sensors of a simulated wheel record it, or the free run of a simulated wheel under
// the torques of a record.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "apps/channel_words.hpp"
#include "apps/commands.hpp"
#include "apps/option_kinds.hpp"
#include "apps/seed_option.hpp"
#include "apps/simulate_options.hpp"
#include "apps/unit_words.hpp"
#include "backend/simulated.hpp"
#include "experiment/drive_task.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/output_folder.hpp"
#include "log/resample.hpp"
#include "log/spikes.hpp"
#include "plant/driving_torques.hpp"
#include "plant/simulation.hpp"
#include "sensors/sensors_json.hpp"

namespace steerid {
namespace {

std::vector<std::string> effect_ids() {
  std::vector<std::string> out;
  for (const EffectType* type : effects()) out.emplace_back(type->id);
  return out;
}

/// The wheel of --sim, or `fallback`; with the effects of --effect behind those of the file.
Simulation simulation(const SimulateOptions& options, const WheelArm& fallback) {
  Simulation sim;
  sim.wheel = fallback;
  if (!options.sim.empty()) sim = Simulation::load(options.sim);
  for (const std::string& id : options.effects) sim.effects.emplace_back(find_effect(id));
  try {
    check_compatible(sim.effects);
  } catch (const BadInput& contradiction) {
    throw CLI::ValidationError("--effect", contradiction.what());
  }
  sim.check_cost(options.sim.empty() ? "the wheel" : options.sim.string());
  return sim;
}

struct Sensors {
  SensorDefects defects;
  std::string_view says;
};

Sensors sensors(const SimulateOptions& options, const Simulation& sim) {
  if (options.noise == "none") return {SensorDefects::none(), "without any defect"};
  if (options.noise == "realistic" || sim.sensors_json.empty()) {
    return {SensorDefects::realistic(), "angle noise 0.7 mrad in steps of 0.5 mrad, torque noise 30 and 9 mNm"};
  }
  return {sensors_from_json(nlohmann::json::parse(sim.sensors_json), options.sim.string()), "as the file states"};
}

Scenario scenario(const SimulateOptions& options, const Simulation& sim, const SensorDefects& defects) {
  Scenario scenario;
  scenario.wheel = sim.wheel;
  scenario.effects = sim.effects;
  scenario.task =
      task_settings(chosen(kAllTasks, options.task), chosen(kAllHandPositions, options.hands), options.seed);
  scenario.task.arm = sim.wheel;
  scenario.task.unmeasured_percent = options.unmeasured_percent;
  const PlannedProbe probe = planned_probe(options, {.multisine = scenario.task.probe, .duration_s = 60});
  scenario.task.probe = probe.multisine;
  scenario.duration_s = probe.duration_s;
  const bool held = options.eps ? *options.eps == "held" : sim.torque_between_samples == TorqueSignal::Between::kHeld;
  scenario.task.eps = held ? EpsTorque::kHeld : EpsTorque::kSmooth;
  scenario.sensors = defects;
  return scenario;
}

std::string effects_text(const std::vector<Effect>& effects) {
  if (effects.empty()) return "none";
  std::vector<std::string> all;
  for (const Effect& effect : effects) {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < effect.values.size(); ++i) {
      values.push_back(fmt::format("{} {}", effect.type->parameters[i].name, effect.values[i]));
    }
    all.push_back(fmt::format("{} ({})", effect.type->id, fmt::join(values, ", ")));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

/// What makes the log repeatable, for its head and for the terminal.
std::vector<std::string> description(const SimulateOptions& options, const Scenario& scenario, std::string_view says) {
  const std::string_view eps = scenario.task.eps == EpsTorque::kHeld
                                   ? "held: the motor torque of a sample acts until the next sample"
                                   : "band-limited: the torques are smooth signals sampled at the stamps";
  return {fmt::format("simulated  {}, hands {}, {} s at 100 Hz, seed {}", options.task, options.hands,
                      scenario.duration_s, options.seed),
          fmt::format("wheel      J {:g} kg m2, B {:g} Nms/rad, C {:g} Nm/rad{}", scenario.wheel.inertia_kgm2,
                      scenario.wheel.damping_nms_per_rad, scenario.wheel.stiffness_nm_per_rad,
                      options.sim.empty() ? "" : ", from " + printable(options.sim.filename().string())),
          fmt::format("effects    {}", effects_text(scenario.effects)),
          fmt::format("torques    {}", eps),
          fmt::format("probe      {:g} Nm rms, {:g} to {:g} Hz; unmeasured torque {} % of the applied",
                      scenario.task.probe.rms_nm, scenario.task.probe.low_hz, scenario.task.probe.high_hz,
                      scenario.task.unmeasured_percent),
          fmt::format("sensors    {}; no anti-alias filter", says)};
}

void simulate_drive(const SimulateOptions& options) {
  const WheelArm nominal = nominal_arm(chosen(kAllTasks, options.task), chosen(kAllHandPositions, options.hands));
  const Simulation sim = simulation(options, nominal);
  const Sensors chain = sensors(options, sim);
  const Scenario what = scenario(options, sim, chain.defects);
  check_output_file(options.out);
  const auto result = drive_through<SimulatedDrive, SimulatedHal>(what);
  const auto lines = description(options, what, chain.says);
  write_simulated(options, {Channel::kTime, Channel::kTorqueDriver, Channel::kTorqueMotor, Channel::kAngle},
                  result.measured, lines);
  fmt::print("{}\n", fmt::join(lines, "\n"));
  fmt::print("rms        driver {:.3f} Nm, motor {:.3f} Nm, angle {:.4f} rad\n",
             rms_of(result.measured.torque_driver_nm), rms_of(result.measured.torque_motor_nm),
             rms_of(result.measured.angle_rad));
  fmt::print("identified {}, by the firmware's loop along the way\n", estimate_text(result.estimates.back()));
  fmt::print("log        {}, {} rows\n", printable(options.out.string()), result.measured.size());
}

/// A record of pieces that are too short for an even grid runs as well: of it less is told.
std::vector<std::string> replay_notes(const Record& record, const RecordQuality& seen) {
  try {
    return read_notes(resample_100hz(record).record, seen);
  } catch (const BadInput&) {
    return seen.notes;
  }
}

void replay_record(const SimulateOptions& options) {
  Simulation sim = simulation(options, {});
  if (options.eps) {
    sim.torque_between_samples =
        *options.eps == "held" ? TorqueSignal::Between::kHeld : TorqueSignal::Between::kBandLimited;
  }
  RecordQuality seen;
  Record record = options.log.read(options.replay, &seen);
  std::vector<std::string> notes = replay_notes(record, seen);
  if (std::string words = driving_words(record); !words.empty()) notes.push_back(std::move(words));
  record = with_driving_torques(std::move(record));
  const std::string spikes = mend_spikes(record).note();  // as the diagnosis does, whose runs these reproduce
  if (!spikes.empty()) notes.push_back(spikes);
  check_output_file(options.out);
  const std::vector<double> angle_rad = free_run(sim, record);
  const auto table = open_table(
      options.out,
      {.what = "prediction", .columns = {"time_s", "angle_rad"}, .comments = notes, .messages = options.messages});
  double squares = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!std::isfinite(angle_rad[i])) {
      throw BadInput(
          fmt::format("{}: expected a wheel that stays finite under the torques of {}, it diverges at {} s; "
                      "check signs and units, and the effects that soften the wheel",
                      options.sim.string(), options.replay.string(), record.time_s[i]));
    }
    const double error = record.angle_rad[i] - angle_rad[i];
    squares += error * error;
    table->cell(record.time_s[i], 6).cell(angle_rad[i], 9).end_row();
  }
  table->commit();
  for (const std::string& note : notes) fmt::print("note       {}\n", note);
  fmt::print("free run   of {} under the torques of {}\n", printable(options.sim.string()),
             printable(options.replay.string()));
  fmt::print("effects    {}\n", effects_text(sim.effects));
  fmt::print("rms        angle {:.4f} rad, measured less predicted {:.5f} rad\n", rms_of(angle_rad),
             std::sqrt(squares / static_cast<double>(record.size())));
  fmt::print("prediction {}, {} rows\n", printable(options.out.string()), record.size());
}

/// The options of --task drive alone.
std::vector<const CLI::Option*> add_column_options(CLI::App& command, SimulateOptions& options) {
  const double longest_s = 86'400;
  std::vector<const CLI::Option*> all;
  const auto add = [&](CLI::Option* option, const char* type) { all.push_back(option->type_name(type)); };
  add(reads_file(command.add_option("--column", options.column, "drive: the steering column; the usual one without")),
      "COLUMN.json");
  add(one_of(command.add_option("--manoeuvre", options.manoeuvre, "drive: what beside lane keeping"),
             names(kAllManoeuvres))
          ->capture_default_str(),
      "WHICH");
  add(number_from(command.add_option("--steering", options.steering_rad,
                                     "drive: the angle that lane keeping means, rms; 0 holds still"),
                  0, 2)
          ->capture_default_str(),
      "RAD");
  add(one_of(command.add_option("--change", options.change, "drive: how the arm's stiffness changes"),
             names(kAllArmCourses))
          ->capture_default_str(),
      "HOW");
  add(number_from(command.add_option("--change-to", options.change_to_nm_per_rad, "drive: to what"), 0.1, 1000),
      "NM_PER_RAD");
  add(number_from(command.add_option("--change-at", options.change_at_s, "drive: from when on"), 0, longest_s)
          ->capture_default_str(),
      "S");
  add(number_from(
          command.add_option("--change-over", options.change_over_s, "drive: within what time, or the swing's period"),
          0.01, longest_s)
          ->capture_default_str(),
      "S");
  add(number_from(
          command.add_option("--release", options.releases, "drive: the hands leave at S for S; may be repeated"), 0,
          longest_s),
      "S S");
  add(writes_file(command.add_option("--truth", options.truth,
                                     "drive: write J, B, C above the bar and the driver's torque, a row a sample")),
      "TRUTH.csv");
  return all;
}

/// Those of the other tasks alone.
std::vector<const CLI::Option*> options_of_wheels(const CLI::App& command) {
  return {command.get_option("--effect"), command.get_option("--unmeasured"), command.get_option("--eps")};
}

void refuse_options(const std::vector<const CLI::Option*>& others, bool column) {
  for (const CLI::Option* option : others) {
    if (option->count() == 0) continue;
    throw BadOption(column ? fmt::format("{} is no option of --task drive; what the column is like stands in the file "
                                         "of --column",
                                         option->get_name())
                           : fmt::format("{} is an option of --task drive only", option->get_name()));
  }
}

}  // namespace

void add_simulate(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "simulate", "Record a simulated drive, or run a simulated wheel freely on the torques of a record");
  auto options = std::make_shared<SimulateOptions>();
  std::vector<std::string> tasks = names(kAllTasks);
  tasks.emplace_back(kDriveTask);
  CLI::Option* task = one_of(command->add_option("--task", options->task,
                                                 "What is driven; drive has a whole column, with a torsion bar"),
                             std::move(tasks))
                          ->type_name("TASK");
  one_of(command->add_option("--hands", options->hands, "Where the hands are; sets J, B, C unless --sim does"),
         names(kAllHandPositions))
      ->type_name("HANDS")
      ->capture_default_str();
  CLI::Option* sim =
      reads_file(command->add_option("--sim", options->sim, "The simulated wheel"))->type_name("SIM.json");
  one_of(command->add_option("--effect", options->effects, "Adds an effect at its presets; may be repeated"),
         effect_ids())
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("ID");
  number_from(
      command->add_option("--duration", options->duration_s, "Seconds; 60 unless the probe's file says otherwise"), 1.0,
      86'400.0)
      ->type_name("S");
  add_seed(*command, options->seed);
  one_of(command->add_option("--noise", options->noise, "The sensors; without it those of --sim, else realistic ones"),
         {"realistic", "none"})
      ->type_name("WHICH");
  reads_file(
      command->add_option("--probe", options->probe,
                          "Multisine from the motor: Nm rms (1.5 for probe, 1 for drive, else none), or the file "
                          "of a probe such as the diagnosis.json that proposes it"))
      ->check(CLI::Validator(probe_complaint, ""))
      ->type_name("NM|FILE");
  number_from(command->add_option("--unmeasured", options->unmeasured_percent,
                                  "Slow torque that no sensor sees, rms in percent of the applied torque's"),
              0.0, 100.0)
      ->type_name("PERCENT")
      ->capture_default_str();
  one_of(command->add_option("--eps", options->eps,
                             "The motor torque between samples; without it as --sim says, else smooth"),
         {"smooth", "held"})
      ->type_name("HOW");
  CLI::Option* replay =
      reads_file(command->add_option("--replay", options->replay, "A record whose torques drive the wheel of --sim"))
          ->needs(sim)
          ->type_name("LOG.csv");
  add_log_options(*command, options->log);
  for (const char* option : {"--columns", "--sign", "--with", "--align", "--dbc"})
    command->get_option(option)->needs(replay);
  writes_file(command->add_option("--out", options->out, "The log, or with --replay the predicted angle; .mcap too"))
      ->required()
      ->type_name("OUT.csv");
  add_mcap_messages(*command, options->messages);
  task->excludes(replay);
  const std::vector<const CLI::Option*> of_columns = add_column_options(*command, *options);
  runs(*command, [options, command, of_columns](FilesOfRun&) {
    const bool column = options->task == kDriveTask;
    refuse_options(column ? options_of_wheels(*command) : of_columns, column);
    if (!options->replay.empty()) {
      replay_record(*options);
    } else if (column) {
      simulate_column(*options);
    } else if (!options->task.empty()) {
      simulate_drive(*options);
    } else {
      throw CLI::RequiredError("--task or --replay");
    }
  });
}

}  // namespace steerid
