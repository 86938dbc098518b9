// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// steerid-ecu [--config FILE] [--dry-run | --make-safe | --help | --version]
#include <getopt.h>

#include <array>
#include <cstdio>
#include <exception>
#include <string>

#include "linux_ecu/config.hpp"
#include "linux_ecu/daemon.hpp"
#include "linux_ecu/guard.hpp"
#include "linux_ecu/journal.hpp"
#include "linux_gpiod/failure.hpp"

namespace {

using namespace steerid::linux_ecu;

constexpr const char* kUsage =
    "steerid-ecu: identifies the driver's arm on the wheel, 100 times a second, beside an EPS on CAN\n"
    "\n"
    "  --config FILE   the config file; /etc/steerid-ecu.json when not given\n"
    "  --dry-run       open all that the config names, say whether it is there, and end\n"
    "  --make-safe     drive the outputs to their safe levels, and end\n"
    "  --version       print the version, and end\n"
    "\n"
    "Exit codes: 0 done, 1 something that the config names cannot be had, 2 bad usage, 3 the loop failed.\n";

enum class Job : char { kRun, kDryRun, kMakeSafe, kHelp, kVersion, kBadUsage };

Job parse(int argc, char** argv, std::string& config) {
  const std::array<option, 6> options{{{"config", required_argument, nullptr, 'c'},
                                       {"dry-run", no_argument, nullptr, 'd'},
                                       {"make-safe", no_argument, nullptr, 's'},
                                       {"help", no_argument, nullptr, 'h'},
                                       {"version", no_argument, nullptr, 'v'},
                                       {nullptr, 0, nullptr, 0}}};
  Job job = Job::kRun;
  for (int option = 0; (option = getopt_long(argc, argv, "", options.data(), nullptr)) != -1;) {
    if (option == 'c') config = optarg;
    if (option == 'd') job = Job::kDryRun;
    if (option == 's') job = Job::kMakeSafe;
    if (option == 'h') job = Job::kHelp;
    if (option == 'v') job = Job::kVersion;
    if (option == '?') return Job::kBadUsage;
  }
  return optind < argc ? Job::kBadUsage : job;
}

int make_safe(const Config& config) {
  const std::string reason = drive_safe_levels(config);
  if (reason.empty()) {
    log(Level::kInfo, "the outputs are at their safe levels");
  } else {
    log(Level::kError, "not every output could be driven to its safe level: %s", reason.c_str());
  }
  return reason.empty() ? 0 : 1;
}

int run(Job job, const std::string& path) {
  if (job == Job::kBadUsage) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  if (job == Job::kHelp || job == Job::kVersion) {
    std::puts(job == Job::kHelp ? kUsage : STEERID_VERSION);
    return 0;
  }
  const Config config = read_config(path);
  if (job == Job::kMakeSafe) return make_safe(config);
  if (job == Job::kRun) return run_daemon(config);
  dry_run(config);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::string config = "/etc/steerid-ecu.json";
    const Job job = parse(argc, argv, config);
    return run(job, config);
  } catch (const steerid::linux_gpiod::Failure& failure) {
    log(Level::kError, "%s", failure.what());
    return 1;
  } catch (const std::exception& error) {
    log(Level::kError, "internal error: %s", error.what());
    return 3;
  }
}
