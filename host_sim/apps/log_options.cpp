// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/log_options.hpp"

#include <fmt/format.h>

#include <utility>

#include "apps/option_kinds.hpp"
#include "fit/clock_lag.hpp"
#include "fit/unit_check.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/resample.hpp"

namespace steerid {
namespace {

constexpr double kMostLagS = 2;  // that a lag is looked for

/// Of what is identified from.
std::uint8_t channels_of_file(const RecordQuality& seen, std::size_t file) {
  unsigned bits = 0;
  for (const Channel channel : kAllChannels) {
    const ReadChannel& read = seen.channel(channel);
    if (!read.column.empty() && read.file == file) bits |= valid_bit(channel);
  }
  return static_cast<std::uint8_t>(bits);
}

std::string moved_words(double moved_s) {
  return moved_s == 0 ? "left as it is" : fmt::format("moved by {:+.3f} s", moved_s);
}

std::string lag_words(const std::string& file, const ClockLag& lag, double moved_s) {
  if (!lag.shown) {
    return fmt::format("{}: no lag within {:g} s explains more of the torque than its stamps do; {}", printable(file),
                       kMostLagS, moved_words(moved_s));
  }
  return fmt::format(
      "{}: moved by {:+.3f} s, by which a wheel explains the most of the torque ({:.2g} % of its power is left, {:.2g} "
      "% "
      "without)",
      printable(file), moved_s, 100 * lag.unexplained, 100 * lag.unexplained_as_is);
}

/// Of a record whose driver moves the wheel by a torque that nobody measured.
std::string no_lag_words(const std::string& file, double moved_s) {
  return fmt::format(
      "{}: {}, and how late it is beyond that cannot be told: the driver's own torque, which is in no file, moves bar "
      "and angle as a lag would; a rim transducer beside the bar, or one clock for all, tells it",
      printable(file), moved_words(moved_s));
}

}  // namespace

LogFormat LogOptions::format() const {
  LogFormat format;
  if (!columns.empty()) format.columns = parse_columns(columns);
  if (!sign.empty()) format.reversed = parse_sign(sign);
  format.dbc = dbc;
  return format;
}

std::vector<std::filesystem::path> LogOptions::files(const std::filesystem::path& log) const {
  std::vector<std::filesystem::path> all = {log};
  all.insert(all.end(), with.begin(), with.end());
  return all;
}

Record LogOptions::read(const std::filesystem::path& log, RecordQuality* noticed) const {
  return read(files(log), format(), noticed);
}

Record LogOptions::read(const std::vector<std::filesystem::path>& files, LogFormat format,
                        RecordQuality* noticed) const {
  if (!align || files.size() < 2) return read_log(files, format, noticed);
  format.start_together = true;
  RecordQuality seen;
  Record record = read_log(files, format, &seen);
  std::vector<std::string> notes;
  for (std::size_t file = 1; file < files.size(); ++file) {
    const std::uint8_t channels = channels_of_file(seen, file);
    if (channels == 0) continue;
    format.moved_s = seen.moved_s;
    format.start_together = false;
    if (!tells_delays(record)) {
      notes.push_back(no_lag_words(files[file].string(), seen.moved_s[file]));
      continue;
    }
    const ClockLag lag = clock_lag(resample_100hz(record).record, channels, kMostLagS);
    if (lag.shown) format.moved_s[file] -= lag.late_s;
    notes.push_back(lag_words(files[file].string(), lag, format.moved_s[file]));
    record = read_log(files, format, &seen);
  }
  seen.notes.insert(seen.notes.end(), notes.begin(), notes.end());
  if (noticed != nullptr) *noticed = std::move(seen);
  return record;
}

void add_mcap_messages(CLI::App& command, McapMessages& messages) {
  one_of(command.add_option_function<std::string>(
             "--mcap-messages",
             [&messages](const std::string& word) {
               messages = word == "json" ? McapMessages::kJson : McapMessages::kCdr;
             },
             "Where a written file ends in .mcap: its messages as ROS 2 has them (cdr) or as JSON"),
         {"cdr", "json"})
      ->type_name("HOW");
}

void add_log_options(CLI::App& command, LogOptions& options) {
  command
      .add_option("--columns", options.columns,
                  "Columns of other names or units, as angle=theta:deg, of counts as angle=enc:deg*0.0219-180. Time in "
                  "s, ms, us, ns; torque in nm, mnm, cnm, danm, knm, lbft, lbin, kgfm; angle in rad, deg, mrad, urad, "
                  "turn; a slide's in n and "
                  "m. `steerid inspect` prints the line")
      ->type_name("CHANNEL=COLUMN[:UNIT[*SCALE[+OFFSET]]],...");
  command.add_option("--sign", options.sign, "Channels to turn round, as torque_driver=-1; -1 for both torques")
      ->type_name("CHANNEL=-1,...");
  reads_file(command.add_option("--with", options.with,
                                "Further files of the same drive, each with stamps of its own, aligned by them"))
      ->type_name("LOG");
  command.add_flag("--align", options.align,
                   "Move the clocks of further files by the lag that explains the torques best, within 2 s of their "
                   "stamps, or of a common start where they share no time");
  reads_file(command.add_option("--dbc", options.dbc, "What the frames of a CAN log (candump, ASC, BLF) mean; several"))
      ->type_name("FILE.dbc");
}

}  // namespace steerid
