// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid hil LOG.csv`: a record through an ECU, emulated or real, compared bit for bit with the in-process run.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/identification.hpp"
#include "apps/log_options.hpp"
#include "apps/made_from.hpp"
#include "apps/option_kinds.hpp"
#include "apps/seed_option.hpp"
#include "apps/unit_words.hpp"
#include "hil/hil_run.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "log/resample.hpp"
#include "log/whole_file.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

struct HilOptions {
  std::filesystem::path log;
  LogOptions format;
  std::string emulate;
  std::filesystem::path port;
  std::filesystem::path firmware;
  bool real_time = false;
  hil::WireFaults faults;
  std::optional<std::filesystem::path> json;
};

/// Beside the running command: build/firmware/steerid-an386.elf.
std::filesystem::path default_image(const std::string& board) {
  std::error_code none;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", none);
  return self.parent_path() / "firmware" / fmt::format("steerid-{}.elf", board);
}

hil::ByteChannel line_to(const HilOptions& options) {
  if (!options.port.empty()) return hil::ByteChannel::open_port(options.port);
  const auto image = options.firmware.empty() ? default_image(options.emulate) : options.firmware;
  return hil::ByteChannel::start_emulator("mps2-" + options.emulate, image);
}

const char* board_name(const link::Identity& identity) {
  return identity.board == link::Board::kMps2An385 ? "mps2-an385" : "mps2-an386";
}

const char* cause_name(link::ResetCause cause) {
  switch (cause) {
    case link::ResetCause::kPowerOn:
      return "power_on";
    case link::ResetCause::kWatchdog:
      return "watchdog";
    case link::ResetCause::kRequested:
      return "asked_for";
  }
  return "unknown";
}

Json parameter_json(const ParameterEstimate& published) {
  const IdentifiedParameter parameter = from_published(published);
  const bool known = published.sd_micro != INT32_MAX;
  return {
      {"value", parameter.value}, {"sd", known ? Json(parameter.sd) : Json(nullptr)}, {"state", name(parameter.state)}};
}

Json estimate_json(const Estimate& estimate) {
  return {{"inertia_kgm2", parameter_json(estimate.inertia)},
          {"damping_nms_per_rad", parameter_json(estimate.damping)},
          {"stiffness_nm_per_rad", parameter_json(estimate.stiffness)}};
}

Json result_json(const HilOptions& options, const hil::Ecu& ecu, const hil::HilResult& result,
                 const std::vector<std::string>& notes) {
  Json json = {{"schema", "steerid.hil/1"},
               {"board", board_name(ecu.identity())},
               {"scalar", ecu.identity().number == link::Number::kFixed ? "fixed" : "float"},
               {"samples", result.ticks},
               {"bit_identical", result.bit_identical()},
               {"different", result.different},
               {"estimate", estimate_json(result.last)}};
  Json& differences = json["differences"] = Json::array();
  for (const hil::Difference& d : result.differences) {
    differences.push_back(
        {{"tick", d.tick}, {"ecu", estimate_json(d.ecu)}, {"in_process", estimate_json(d.in_process)}});
  }
  json["wire"] = {{"lost", result.lost},
                  {"damaged", result.damaged},
                  {"delayed", result.delayed},
                  {"frames_refused_by_ecu", result.health.frames_damaged},
                  {"frames_refused_by_host", ecu.damaged()}};
  Json& resets = json["resets"] = Json::array();
  for (const hil::Recovery& r : result.recoveries) {
    resets.push_back({{"at_s", r.at_s},
                      {"cause", cause_name(r.cause)},
                      {"restored", r.restored},
                      {"valid_again_after_s", r.valid_again_s ? Json(*r.valid_again_s) : Json(nullptr)}});
  }
  json["deadlines"] = {{"ticks", result.health.ticks},
                       {"late", result.health.late},
                       {"missed", result.health.missed},
                       {"overrun", result.health.overrun},
                       {"longest_step_us", result.health.longest_step_us}};
  json["notes"] = notes;
  json["input"] = input_json(options.log);
  json["options"] = {{"columns", options.format.columns},     {"sign", options.format.sign},
                     {"lose", options.faults.lose},           {"damage", options.faults.damage},
                     {"delay", options.faults.delay},         {"delay_ticks", options.faults.delay_ticks},
                     {"reset_at_s", options.faults.resets_s}, {"seed", options.faults.seed},
                     {"real_time", options.real_time}};
  json["program"] = program_json();
  return json;
}

void print(const hil::Ecu& ecu, const hil::HilResult& result) {
  fmt::print("{}, {}: {} estimates\n", board_name(ecu.identity()),
             ecu.identity().number == link::Number::kFixed ? "fixed point" : "float", result.ticks);
  if (result.lost + result.damaged + result.delayed > 0) {
    fmt::print("on the wire: {} samples lost, {} damaged, {} delayed; the ECU refused {} frames\n", result.lost,
               result.damaged, result.delayed, result.health.frames_damaged);
  }
  for (const hil::Recovery& r : result.recoveries) {
    fmt::print(
        "reset at {:g} s ({}): {}, {}\n", r.at_s, cause_name(r.cause),
        r.restored ? "restored from its saved estimate" : "from nothing",
        r.valid_again_s ? fmt::format("valid again after {:g} s", *r.valid_again_s) : std::string("not valid again"));
  }
  if (result.bit_identical()) {
    fmt::print("bit for bit what this process estimates\n");
  } else {
    fmt::print("{} estimates differ from this process, the first at tick {}\n", result.different,
               result.differences.empty() ? 0 : result.differences.front().tick);
  }
  const auto line = [](const char* title, const ParameterEstimate& p, const char* unit) {
    fmt::print("  {:<12} {:>12.6g} {:>11.3g}  {:<8} {}\n", title, p.value_micro * 1e-6, p.sd_micro * 1e-6, unit,
               name(p.state));
  };
  line("inertia J", result.last.inertia, "kg m2");
  line("damping B", result.last.damping, "Nms/rad");
  line("stiffness C", result.last.stiffness, "Nm/rad");
}

void hil_command(const HilOptions& options) {
  if (options.emulate.empty() == options.port.empty()) throw BadOption("give either --emulate or --port");
  const bool faulty = options.faults.lose + options.faults.damage + options.faults.delay > 0;
  if (options.faults.lose + options.faults.damage + options.faults.delay > 1) {
    throw BadOption("--lose, --damage and --delay together must not exceed 100 %");
  }
  if (options.real_time && (faulty || !options.faults.resets_s.empty())) {
    throw BadOption("--real-time knows no faults; leave it out");
  }
  RecordQuality seen;
  const Record record = resample_100hz(options.format.read(options.log, &seen), options.log.string()).record;
  const std::vector<std::string> notes = read_notes(record, seen);
  if (options.json) check_output_file(*options.json);
  hil::Ecu ecu(line_to(options));
  // A real ECU has lived before; it begins as a new one does.
  if (!options.port.empty()) ecu.reset(false);
  hil::HilResult result;
  {
    Progress progress("driving the ECU", record.size());
    result = options.real_time ? hil::run_in_real_time(ecu, record, progress)
                               : hil::run_as_fast_as_it_goes(ecu, record, options.faults, progress);
  }
  print(ecu, result);
  for (const std::string& note : notes) fmt::print("note: {}\n", note);
  if (options.json) write_whole_file(*options.json, result_json(options, ecu, result, notes).dump(2) + "\n");
}

constexpr const char* kFooter =
    "The emulated boards are Arm's MPS2 with a Cortex-M4F (an386, float) and a Cortex-M3 (an385, fixed point); they\n"
    "need qemu-system-arm. A real ECU speaks the protocol of docs/link_protocol.md at 921600 baud; it is reset first\n"
    "and told to forget its saved estimate, as a new one begins. A sample that comes late takes the place of its\n"
    "tick's own.\n"
    "With --real-time two samples may share a tick on a busy machine; the ECU takes the newer one, and the estimates\n"
    "then differ. Estimates that differ are no failure of the command: \"bit_identical\" of --json says so.\n"
    "\n"
    "Examples:\n"
    "  steerid hil --emulate an386 drive.csv --json hil.json\n"
    "  steerid hil --emulate an385 drive.csv --lose 2 --damage 2 --reset-at 30";

}  // namespace

void add_hil(CLI::App& app) {
  CLI::App* command = app.add_subcommand("hil", "A record through an ECU, compared with this process");
  auto options = std::make_shared<HilOptions>();
  reads_file(command->add_option("LOG", options->log, "The record"))->required()->type_name("LOG.csv");
  add_log_options(*command, options->format);
  one_of(command->add_option("--emulate", options->emulate, "Start an emulated ECU"), {"an386", "an385"})
      ->type_name("BOARD");
  command->add_option("--port", options->port, "Use the ECU on this serial port")->type_name("PATH");
  reads_file(command->add_option("--firmware", options->firmware, "Another image for the emulated ECU"))
      ->type_name("IMAGE.elf");
  command->add_flag("--real-time", options->real_time, "Ticks by the ECU's timer, samples every 10 ms");
  const auto share = [command](const char* option, double& into, const char* text) {
    number_from(command->add_option_function<double>(
                    option, [&into](double percent) { into = percent / 100; }, text),
                0.0, 100.0)
        ->type_name("PERCENT");
  };
  share("--lose", options->faults.lose, "Lose so many of the samples on the wire");
  share("--damage", options->faults.damage, "Damage so many");
  share("--delay", options->faults.delay, "Deliver so many late");
  whole_from(command->add_option("--delay-ticks", options->faults.delay_ticks, "By how many ticks"), 1, 1000)
      ->type_name("TICKS")
      ->capture_default_str();
  number_from(command->add_option("--reset-at", options->faults.resets_s, "Reset the ECU in mid-drive"), 0.0, 1e6)
      ->type_name("SECONDS");
  add_seed(*command, options->faults.seed, "Of the faults");
  writes_file(command->add_option("--json", options->json, "Write the result, machine-readable"))
      ->type_name("OUT.json");
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun&) { hil_command(*options); });
}

}  // namespace steerid
