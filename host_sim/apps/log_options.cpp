// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/log_options.hpp"

#include "apps/option_kinds.hpp"

namespace steerid {

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
                  "s, ms, us, ns; torque in nm, mnm, cnm, knm, lbft; angle in rad, deg, mrad, urad; a slide's in n and "
                  "m. `steerid inspect` prints the line")
      ->type_name("CHANNEL=COLUMN[:UNIT[*SCALE[+OFFSET]]],...");
  command.add_option("--sign", options.sign, "Channels to turn round, as torque_driver=-1; -1 for both torques")
      ->type_name("CHANNEL=-1,...");
  reads_file(command.add_option("--with", options.with,
                                "Further files of the same drive, each with stamps of its own, aligned by them"))
      ->type_name("LOG");
  reads_file(command.add_option("--dbc", options.dbc, "What the frames of a CAN log (candump, ASC, BLF) mean; several"))
      ->type_name("FILE.dbc");
}

}  // namespace steerid
