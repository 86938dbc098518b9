// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The kinds of options that the commands have, each understood and refused in one place, whichever command asks.
//
//   number_from     a decimal number that is finite and in range
//   whole_from      a whole number in range, decimal
//   one_of          one of some words; a wrong one is answered with the nearest
//   reads_file      a file that is read: never overwritten by the same run
//   writes_file     a file that is written, "-" for standard output
//   reads_folder, writes_folder   likewise, a folder
//
//   command->add_option("--sim", options->sim, "...") becomes reads_file(command->add_option("--sim", ...))
//
// A command sets what it does by runs(), which sees first that its files keep out of each other's way, and gives it
// --quiet. What it writes into a folder it names itself, by FilesOfRun::writes(), before it works.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/files_of_run.hpp"

namespace steerid {

CLI::Option* number_from(CLI::Option* option, double low, double high);
CLI::Option* whole_from(CLI::Option* option, std::uint64_t low, std::uint64_t high);
CLI::Option* one_of(CLI::Option* option, std::vector<std::string> words);

CLI::Option* reads_file(CLI::Option* option);
CLI::Option* reads_folder(CLI::Option* option);
CLI::Option* writes_file(CLI::Option* option);
CLI::Option* writes_folder(CLI::Option* option);

/// What an option's text is, for whoever lists the options.
enum class OptionKind : std::uint8_t { kFlag, kText, kNumber, kWord, kFile, kFolder };
[[nodiscard]] OptionKind kind_of(const CLI::Option& option);

/// The words of one_of(); none for other options.
[[nodiscard]] std::vector<std::string> words_of(const CLI::Option& option);

/// A whole decimal text that is a finite number within the limits.
[[nodiscard]] bool is_number_from(std::string_view text, double low, double high);

/// What `command` does once its options are understood; options of the commands above and below it are looked at too.
void runs(CLI::App& command, std::function<void(FilesOfRun&)> work);

/// --quiet alone, for a command whose work another one does.
void add_quiet(CLI::App& command);

}  // namespace steerid
