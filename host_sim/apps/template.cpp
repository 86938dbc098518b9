// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid template sim|column|daemon`: a commented file to begin with. What is in it comes from where the program
// itself takes it (the vocabulary of effects, the column's fields, the daemon's own example), so that it cannot differ.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/commands.hpp"
#include "apps/daemon_template.hpp"
#include "apps/option_kinds.hpp"
#include "log/whole_file.hpp"
#include "plant/column.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

struct TemplateOptions {
  std::string kind;
  std::filesystem::path out = "-";
};

std::string effect_lines(const EffectType& type) {
  std::string text = fmt::format("    // {}\n", type.says);
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  for (const Parameter& parameter : type.parameters) {
    text += fmt::format("    //   {:<28} {} to {}{}; {}\n", parameter.name, parameter.low, parameter.high,
                        parameter.whole ? ", whole" : "", parameter.says);
    parameters[std::string(parameter.name)] = parameter.preset;
  }
  nlohmann::ordered_json effect = {{"effect", type.id}};
  if (!parameters.empty()) effect["parameters"] = parameters;
  return text + fmt::format("    // {}\n\n", effect.dump());
}

std::string sim_template() {
  std::string text =
      "// A simulated wheel, for --sim. Lines that begin with // are comments. Required are the first three numbers; "
      "J\n"
      "// above zero, B and C zero or above. A wheel so stiff beside its inertia that a run would take minutes is "
      "refused.\n"
      "{\n"
      "  \"inertia_kgm2\": 0.11,\n"
      "  \"damping_nms_per_rad\": 1.5,\n"
      "  \"stiffness_nm_per_rad\": 22.7,\n"
      "\n"
      "  // The motor's torque between its samples: \"band_limited\" for a measured one, \"held\" for an EPS that "
      "holds "
      "it.\n"
      "  \"torque_between_samples\": \"band_limited\",\n"
      "\n"
      "  // What the sensors do, for `steerid simulate`: of \"angle\", \"torque_driver\" and \"torque_motor\" lag, "
      "delay, "
      "gain,\n"
      "  // bias, noise, saturation, resolution, dropout and stuck; for all of them jitter and message_loss. Each "
      "takes\n"
      "  // onset_s and length_s.\n"
      "  // \"sensors\": {\"angle\": {\"noise\": {\"sd_rad\": 0.0007}, \"resolution\": {\"step_rad\": 0.0005}}},\n"
      "\n"
      "  // Effects, in the order in which they act on the record. Take the // away before those that the wheel has "
      "and\n"
      "  // part them by commas; a parameter that is left out has the value shown.\n"
      "  \"effects\": [\n";
  for (const EffectType* type : effects()) text += effect_lines(*type);
  return text + "  ]\n}\n";
}

constexpr const char* kFooter =
    "Examples:\n"
    "  steerid template sim --out sim.json\n"
    "  steerid template column --out column.json && steerid simulate --task drive --column column.json --out "
    "drive.csv\n"
    "  steerid template daemon --out /etc/steerid-ecu.json";

}  // namespace

void add_template(CLI::App& app) {
  CLI::App* command = app.add_subcommand("template", "A commented file to begin with: simulation, column or daemon");
  auto options = std::make_shared<TemplateOptions>();
  one_of(command->add_option("KIND", options->kind, "What the file is for"), {"sim", "column", "daemon"})->required();
  writes_file(command->add_option("--out", options->out, "Where it goes; - for standard output"))
      ->type_name("FILE")
      ->capture_default_str();
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun&) {
    const std::string& kind = options->kind;
    write_whole_file(options->out,
                     kind == "sim" ? sim_template() : (kind == "column" ? Column::commented() : kDaemonTemplate));
  });
}

}  // namespace steerid
