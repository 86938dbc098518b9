// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid identify LOG.csv`: J, B and C of a record, by the firmware's loop and, on request, by the batch fit.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "apps/commands.hpp"
#include "apps/driver_timeline.hpp"
#include "apps/figures_option.hpp"
#include "apps/identification_table.hpp"
#include "apps/identification_trace.hpp"
#include "apps/identify_folder.hpp"
#include "apps/identify_record.hpp"
#include "apps/json_lines.hpp"
#include "apps/option_kinds.hpp"
#include "apps/over_time.hpp"
#include "apps/plotjuggler_layout.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/whole_file.hpp"
#include "report/figures.hpp"

namespace steerid {
namespace {

struct IdentifyCommand {
  std::filesystem::path log;
  BatchPlace folder;
  bool json_lines = false;
  IdentifyRequest request;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> trace;
  std::optional<std::filesystem::path> layout;
  McapMessages messages = McapMessages::kCdr;
  std::optional<std::filesystem::path> report;
  std::filesystem::path figures;
  bool reports = true;  ///< of the records of a folder
};

void print(const IdentifyCommand& options, const IdentifiedLog& found) {
  fmt::print("{}: {}\n", printable(options.log.filename().string()), found.what);
  for (const std::string& note : found.notes()) fmt::print("note: {}\n", note);
  fmt::print("{}", credibility_lines(found.credibility));
  const auto print_answer = [&](const Identification& answer) {
    fmt::print("\n{}", identification_table(answer));
    if (const auto own = found.own_arm_of(answer)) fmt::print("{}", own_arm_table(*own));
  };
  print_answer(found.recursive.found);
  if (found.batch) print_answer(found.batch->found);
  if (found.over_time) fmt::print("{}", over_time_line(*found.over_time));
  fmt::print("\n{}", driver_lines(found.driver));
}

void identify(const IdentifyCommand& options, FilesOfRun& files) {
  const ReadLog log = read_log(options.log, options.request);
  for (const auto& output : {options.json, options.trace, options.layout, options.report}) {
    if (output) check_output_file(*output);
  }
  const IdentifiedLog found = identify_log(log, options.request);
  print(options, found);
  if (options.json) write_whole_file(*options.json, found.json().dump(2) + "\n");
  if (options.trace) write_trace(*options.trace, found.run, options.messages);
  if (options.layout) write_layout(*options.layout, *options.trace);
  if (options.report) write_identify_page(*options.report, options.log.filename().string(), found);
  if (!options.figures.empty()) {
    report::write_figures(options.figures, identify_page_of(options.log.filename().string(), found),
                          claims_figures(files));
  }
}

void run(const IdentifyCommand& options, FilesOfRun& files) {
  if (!options.folder.folder.empty()) {
    identify_folder(options.folder, options.request, options.reports, files);
  } else if (options.json_lines) {
    (void)options.request.log.format();  // an option that cannot be read is no request's fault
    answer_lines(std::cin, std::cout, [&](const nlohmann::ordered_json& request) {
      return identify_log(read_log(text_of(request, "log"), options.request), options.request).json();
    });
  } else if (!options.log.empty()) {
    identify(options, files);
  } else {
    throw CLI::RequiredError("LOG, --folder or --json-lines");
  }
}

constexpr const char* kFooter =
    "The log is a CSV file with a header; its columns are time_s, angle_rad and of a car torque_bar_nm (torsion bar),\n"
    "torque_rim_nm (hand on the rim), torque_motor_nm and probe_nm, unless --columns says otherwise. The channels "
    "that\n"
    "are there decide the equation. Without bar and rim it is T_driver - T_motor = J th'' + B th' + C th, and one of\n"
    "torque_driver_nm and torque_motor_nm that is absent counts as zero. Any rate of 50 Hz or more, jitter, gaps and "
    "NaN\n"
    "are taken; # starts a comment. A parameter that the record does not excite is said to be so.\n"
    "\n"
    "With --folder every record of a folder is identified, on all cores: folders that hold log.csv, and NAME.csv.\n"
    "DIR/NAME has the answer of each, DIR/table.csv a row a record, DIR/fleet/records.jsonl a JSON line.\n"
    "Records that cannot be used, --list, --shard and answers of an earlier run are as in `steerid diagnose --batch`.\n"
    "\n"
    "Examples:\n"
    "  steerid identify drive.csv --batch --report drive.html\n"
    "  steerid identify emps.csv --columns time=t_s,torque_motor=force_n,angle=position_m --sign torque_motor=-1";

}  // namespace

void add_identify(CLI::App& app) {
  CLI::App* command = app.add_subcommand("identify", "Inertia, damping and stiffness from a record");
  auto options = std::make_shared<IdentifyCommand>();
  CLI::Option* log = reads_file(command->add_option("LOG", options->log, "The record"))->type_name("LOG.csv");
  CLI::Option* folder =
      reads_folder(command->add_option("--folder", options->folder.folder, "A folder of records, in place of LOG"))
          ->type_name("DIR");
  CLI::Option* out = writes_folder(command->add_option("--out", options->folder.out,
                                                       "With --folder: the folder of the answers; made when missing"))
                         ->type_name("DIR");
  add_batch_options(*command, options->folder, *folder);
  command
      ->add_flag("--json-lines", options->json_lines,
                 R"(A request a line on standard input, as {"log":"drive.csv"}; an answer a line on standard output)")
      ->excludes(log)
      ->excludes(folder);
  folder->needs(out)->excludes(log);
  out->needs(folder);
  add_log_options(*command, options->request.log);
  command->get_option("--with")->excludes(folder);
  one_of(command->add_option("--scalar", options->request.scalar, "Arithmetic of the identifier"),
         {"float", "fixed", "double"})
      ->type_name("SCALAR")
      ->capture_default_str();
  command->add_flag("--batch", options->request.batch,
                    "Also fit the whole record at once, and B and C over time where they change");
  one_of(command->add_option("--torque-offset", options->request.torque_offset,
                             "Grant the batch fit and the free runs a constant torque: yes, no, or when there is one"),
         {"auto", "yes", "no"})
      ->type_name("WHEN")
      ->capture_default_str();
  reads_file(
      command->add_option("--wheel", options->request.wheel,
                          "The answer to a record with the hands off: state the driver's own arm, less that wheel"))
      ->type_name("WHEEL.json");
  writes_file(command->add_option("--json", options->json, "Write the answer, machine-readable"))
      ->type_name("OUT.json");
  CLI::Option* trace = writes_file(command->add_option("--trace", options->trace,
                                                       "Write estimate with its 95 % interval and driver's state, a "
                                                       "row a tick; as MCAP where it ends in .mcap"))
                           ->type_name("TRACE.csv");
  add_mcap_messages(*command, options->messages);
  writes_file(command->add_option("--layout", options->layout, "Write a layout with which PlotJuggler opens --trace"))
      ->needs(trace)
      ->type_name("LAYOUT.xml");
  writes_file(command->add_option("--report", options->report, "Write the whole of it as one page"))
      ->type_name("REPORT.html");
  add_figures(*command, options->figures)->excludes(folder);
  command
      ->add_flag_callback(
          "--no-report", [options] { options->reports = false; }, "With --folder: leave out report.html of each record")
      ->needs(folder);
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun& files) { run(*options, files); });
}

}  // namespace steerid
