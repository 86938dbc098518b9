// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The subcommands of `steerid`. Each adds itself, with its options and its help, to the application; it runs when the
// command line names it, and reports by exception only:
//   steerid::BadInput      the data given are not usable           exit code 1
//   CLI::ParseError        the command line is not usable          exit code 2
//   any other exception    a fault of this program                 exit code 3
#pragma once

#include <CLI/CLI.hpp>

namespace steerid {

void add_simulate(CLI::App& app);
void add_inspect(CLI::App& app);
void add_identify(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_merge(CLI::App& app);
void add_study(CLI::App& app);
void add_hil(CLI::App& app);
void add_experiment(CLI::App& app);
void add_template(CLI::App& app);
void add_manual(CLI::App& app);

}  // namespace steerid
