// The `steerid` command: picks the subcommand and turns how it ended into an exit code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "apps/commands.hpp"
#include "log/bad_input.hpp"

namespace {

enum ExitCode : int { kDone = 0, kBadData = 1, kBadUsage = 2, kInternal = 3 };

constexpr const char* kDescription =
    "Inertia, damping and stiffness of a driver's arm on a steering wheel.\n"
    "T_driver - T_motor = J th'' + B th' + C th; angles in rad, torques in Nm, positive counter-clockwise.";

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 the data are not usable, 2 the command line is not usable, 3 a fault of this program.\n"
    "`steerid COMMAND --help` explains one command.";

/// The command as far as it was understood, such as "steerid study blind draw": its help explains its options.
std::string understood(const CLI::App* app) {
  std::string words = app->get_name();
  for (auto below = app->get_subcommands(); !below.empty(); below = below.front()->get_subcommands()) {
    words += " " + below.front()->get_name();
  }
  return words;
}

/// A word that nobody knows comes first: what seems to be missing as well may be what it was to say.
std::string usage_message(const CLI::App* app, const CLI::Error& error) {
  const std::string command = understood(app);
  const auto unknown = app->remaining(true);
  const std::string says =
      unknown.empty() ? error.what() : fmt::format("there is no command or option {}", unknown.front());
  return fmt::format("steerid: {}\nTry `{} --help`.\n", says, command);
}

int run(int argc, const char* const* argv) {
  CLI::App app{kDescription, "steerid"};
  app.footer(kFooter);
  app.set_version_flag("--version", "steerid " STEERID_VERSION, "Print the version and stop");
  app.require_subcommand(1);
  app.failure_message(usage_message);
  steerid::add_simulate(app);
  steerid::add_identify(app);
  steerid::add_diagnose(app);
  steerid::add_study(app);
  steerid::add_hil(app);
  steerid::add_experiment(app);
  try {
    app.parse(argc, argv);
    return kDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadUsage;
  } catch (const steerid::BadOption& error) {
    return app.exit(CLI::ValidationError(error.what())) == 0 ? kDone : kBadUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const steerid::BadInput& error) {
    std::fprintf(stderr, "steerid: %s\n", error.what());
    return kBadData;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "steerid: internal error: %s\n", error.what());
    return kInternal;
  } catch (...) {
    std::fputs("steerid: internal error of an unknown kind\n", stderr);
    return kInternal;
  }
}
