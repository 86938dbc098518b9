// `steerid identify LOG.csv`: J, B and C of a record, by the firmware's loop and, on request, by the batch fit.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/answers.hpp"
#include "apps/commands.hpp"
#include "apps/firmware_run.hpp"
#include "apps/first_look.hpp"
#include "apps/identification_json.hpp"
#include "apps/identification_table.hpp"
#include "apps/identification_trace.hpp"
#include "apps/identify_page.hpp"
#include "apps/option_kinds.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/output_folder.hpp"
#include "log/resample.hpp"
#include "log/spikes.hpp"
#include "log/whole_file.hpp"
#include "report/page.hpp"

namespace steerid {
namespace {

struct IdentifyOptions {
  std::filesystem::path log;
  std::string columns;
  std::string sign;
  std::string scalar = "float";
  bool batch = false;
  std::string torque_offset = "auto";
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> trace;
  std::optional<std::filesystem::path> report;
};

Scalar scalar_of(const std::string& text) {
  if (text == "double") return Scalar::kDouble;
  return text == "fixed" ? Scalar::kFixed : Scalar::kFloat;
}

std::optional<bool> offset_of(const std::string& text) {
  if (text == "auto") return std::nullopt;
  return text == "yes";
}

LogFormat format_of(const IdentifyOptions& options) {
  LogFormat format;
  if (!options.columns.empty()) format.columns = parse_columns(options.columns);
  if (!options.sign.empty()) format.reversed = parse_sign(options.sign);
  return format;
}

/// One sentence on how long the record is and what was done to it.
std::string summary(const Record& record, const RecordQuality& seen, const Resampled& resampled) {
  std::string text = fmt::format("{:.1f} s, {} rows at {:.4g} Hz", record.time_s.back() - record.time_s.front(),
                                 seen.rows, 1.0 / seen.median_period_s);
  if (resampled.filtered) {
    text += ", filtered and resampled to 100 Hz";
  } else if (!resampled.untouched) {
    text += ", put on an even grid of 100 Hz";
  }
  if (!seen.gaps.empty()) text += fmt::format(", {} gap{}", seen.gaps.size(), seen.gaps.size() == 1 ? "" : "s");
  if (seen.dropped_rows > 0) text += fmt::format(", {} incomplete rows left out", seen.dropped_rows);
  return text;
}

void identify(const IdentifyOptions& options) {
  const Scalar scalar = scalar_of(options.scalar);
  RecordQuality seen;
  const Record logged = read_log(options.log, format_of(options), &seen);
  const Resampled resampled = resample_100hz(logged);
  const Record& record = resampled.record;
  for (const auto& output : {options.json, options.trace, options.report}) {
    if (output) check_output_file(*output);
  }

  const FirstLook look = first_look(record, offset_of(options.torque_offset));
  const FirmwareRun run = run_firmware(record, scalar, look.units);
  Answer recursive = recursive_answer(record, run, look.torque_offset);
  std::optional<BatchAnswer> batch;
  std::string spikes;
  if (options.batch) {
    Record mended = logged;  // the firmware has to live with spikes; a fit of the whole record has not
    spikes = mend_spikes(mended).note();
    batch = batch_answer(spikes.empty() ? record : resample_100hz(mended).record, look.torque_offset);
  }
  if (!look.doubt.empty()) {
    recursive.found.doubt = look.doubt;  // its states are the firmware's, and stay
    if (batch) disbelieve(batch->answer.found, look.doubt);
  }

  const std::string what = summary(logged, seen, resampled);
  fmt::print("{}: {}\n", printable(options.log.filename().string()), what);
  for (const std::string& note : seen.notes) fmt::print("note: {}\n", note);
  if (resampled.restamped) fmt::print("note: {}\n", kRestamped);
  for (const std::string& note : look.notes) fmt::print("note: {}\n", note);
  if (!spikes.empty()) fmt::print("note: for the batch fit {}\n", spikes);
  if (!look.doubt.empty()) fmt::print("not to be believed: {}\n", look.doubt);
  if (run.units.parameter() != 1.0) {
    fmt::print("note: this is no steering wheel; the firmware counts its torque in {:g} Nm and its angle in {:g} rad\n",
               run.units.torque_nm, run.units.angle_rad);
  }
  fmt::print("\n{}", identification_table(recursive.found));
  if (batch) fmt::print("\n{}", identification_table(batch->answer.found));

  if (options.json) {
    std::optional<Identification> batch_found;
    if (batch) batch_found = batch->answer.found;
    write_whole_file(*options.json, identification_json(recursive.found, batch_found).dump(2) + "\n");
  }
  if (options.trace) write_trace(*options.trace, run);
  if (options.report) {
    report::write_page(*options.report,
                       identify_page({options.log.filename().string(), what, record, run, recursive, batch}));
  }
}

constexpr const char* kFooter =
    "The log is a CSV file with a header; its columns are time_s, torque_driver_nm, torque_motor_nm and angle_rad\n"
    "unless --columns says otherwise. A torque that is absent counts as zero. Any rate of 50 Hz or more, jitter, gaps\n"
    "and NaN are taken; # starts a comment. A parameter that the record does not excite is said to be so.\n"
    "\n"
    "Examples:\n"
    "  steerid identify drive.csv --batch --report drive.html\n"
    "  steerid identify emps.csv --columns time=t_s,torque_motor=force_n,angle=position_m --sign torque_motor=-1";

}  // namespace

void add_identify(CLI::App& app) {
  CLI::App* command = app.add_subcommand("identify", "Inertia, damping and stiffness from a record");
  auto options = std::make_shared<IdentifyOptions>();
  reads_file(command->add_option("LOG", options->log, "The record"))->required()->type_name("LOG.csv");
  command->add_option("--columns", options->columns, "Columns of other names or units, as angle=theta:deg")
      ->type_name("CHANNEL=COLUMN[:UNIT],...");
  command->add_option("--sign", options->sign, "Channels to turn round, as torque_driver=-1; -1 for both torques")
      ->type_name("CHANNEL=-1,...");
  one_of(command->add_option("--scalar", options->scalar, "Arithmetic of the identifier"), {"float", "fixed", "double"})
      ->type_name("SCALAR")
      ->capture_default_str();
  command->add_flag("--batch", options->batch, "Also fit the whole record at once, by Gauss-Newton");
  one_of(command->add_option("--torque-offset", options->torque_offset,
                             "Grant the batch fit and the free runs a constant torque: yes, no, or when there is one"),
         {"auto", "yes", "no"})
      ->type_name("WHEN")
      ->capture_default_str();
  writes_file(command->add_option("--json", options->json, "Write the answer, machine-readable"))
      ->type_name("OUT.json");
  writes_file(command->add_option("--trace", options->trace, "Write estimate and driver's state, a row a tick"))
      ->type_name("TRACE.csv");
  writes_file(command->add_option("--report", options->report, "Write the whole of it as one page"))
      ->type_name("REPORT.html");
  command->footer(kFooter);
  runs(*command, [options](FilesOfRun&) { identify(*options); });
}

}  // namespace steerid
