// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The `steerid` command: picks the subcommand and turns how it ended into an exit code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <system_error>
#include <vector>

#include "apps/commands.hpp"
#include "log/bad_input.hpp"
#include "log/nearest_word.hpp"
#include "log/standard_output.hpp"
#include "log/unfinished_files.hpp"

namespace {

enum ExitCode : int { kDone = 0, kBadData = 1, kBadUsage = 2, kInternal = 3 };

constexpr const char* kDescription =
    "Inertia, damping and stiffness of a driver's arm on a steering wheel.\n"
    "T_driver - T_motor = J th'' + B th' + C th; angles in rad, torques in Nm, positive counter-clockwise.";

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 the data are not usable, 2 the command line is not usable, 3 a fault of this program.\n"
    "`steerid help COMMAND` explains one command.";

/// The command as far as it was understood, such as "steerid study blind draw": its help explains its options.
std::string understood(const CLI::App* app) {
  std::string words = app->get_name();
  for (auto below = app->get_subcommands(); !below.empty(); below = below.front()->get_subcommands()) {
    words += " " + below.front()->get_name();
  }
  return words;
}

/// What could have stood in the place of an unknown word: commands and options of the command that was understood.
std::vector<std::string> known_words(const CLI::App* app) {
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  std::vector<std::string> words;
  for (const CLI::App* command : app->get_subcommands({})) words.push_back(command->get_name());
  for (const CLI::Option* option : app->get_options()) {
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  }
  return words;
}

/// A word that nobody knows comes first: what seems to be missing as well may be what it was to say.
std::string usage_message(const CLI::App* app, const CLI::Error& error) {
  const std::string command = understood(app);
  const auto unknown = app->remaining(true);
  const std::string says = unknown.empty() ? error.what()
                                           : fmt::format("there is no command or option {}{}", unknown.front(),
                                                         steerid::did_you_mean(unknown.front(), known_words(app)));
  return fmt::format("steerid: {}\nTry `{} --help`.\n", steerid::printable(says), command);
}

int run(int argc, const char* const* argv) {
  CLI::App app{kDescription, "steerid"};
  app.footer(kFooter);
  app.set_version_flag("--version", "steerid " STEERID_VERSION, "Print the version and stop");
  app.require_subcommand(1);
  app.failure_message(usage_message);
  steerid::add_simulate(app);
  steerid::add_inspect(app);
  steerid::add_identify(app);
  steerid::add_diagnose(app);
  steerid::add_merge(app);
  steerid::add_study(app);
  steerid::add_hil(app);
  steerid::add_experiment(app);
  steerid::add_template(app);
  steerid::add_manual(app);
  try {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && words.front() == "help") {  // `steerid help X` is `steerid X --help`
      words.erase(words.begin());
      const auto named = [&](const CLI::App* one) { return words.empty() || one->get_name() == words.front(); };
      if (!app.get_subcommands(named).empty()) words.emplace_back("--help");
    }
    std::ranges::reverse(words);  // as the library wants them
    app.parse(words);
    return kDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadUsage;
  } catch (const steerid::BadOption& error) {
    return app.exit(CLI::ValidationError(error.what())) == 0 ? kDone : kBadUsage;
  }
}

/// Ends as a program does whose output nobody reads any more.
[[noreturn]] void end_by_broken_pipe() {
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
  std::_Exit(kBadData);
}

int complain(int exit_code, const std::string& sentence) {
  fmt::print(stderr, "steerid: {}\n", sentence);
  return exit_code;
}

/// Runs the command and sees that what it printed has arrived.
int run_and_finish(int argc, const char* const* argv) {
  try {
    const int ended = run(argc, argv);
    steerid::finish_printing();
    return ended;
  } catch (const std::system_error&) {
    steerid::finish_printing();  // says so when it was the printing
    throw;
  }
}

}  // namespace

int main(int argc, char** argv) {
  steerid::end_tidily_on_signals();
  try {
    return run_and_finish(argc, argv);
  } catch (const steerid::BadInput& error) {
    return complain(kBadData, error.what());
  } catch (const steerid::ReaderGone&) {
    end_by_broken_pipe();
  } catch (const std::exception& error) {
    return complain(kInternal, fmt::format("internal error: {}", steerid::printable(error.what())));
  } catch (...) {
    return complain(kInternal, "internal error of an unknown kind");
  }
}
