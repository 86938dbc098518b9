// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What `steerid simulate` was asked for, and what its kinds of drive share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/run_loop.hpp"
#include "app/task.hpp"
#include "apps/log_options.hpp"
#include "experiment/multisine_json.hpp"
#include "experiment/signal_point.hpp"
#include "log/progress.hpp"
#include "port/port.hpp"

namespace steerid {

/// The task that simulates a whole column, beside those of experiment/tasks.hpp.
inline constexpr std::string_view kDriveTask = "drive";

struct SimulateOptions {
  std::string task;
  std::string hands = "right_3";
  std::filesystem::path sim;
  std::vector<std::string> effects;
  std::optional<double> duration_s;
  std::uint64_t seed = 1;
  std::optional<std::string> noise;
  std::string probe;  ///< Nm rms, or a file that holds one
  double unmeasured_percent = 0.0;
  std::optional<std::string> eps;
  std::filesystem::path replay;
  LogOptions log;  ///< what is in it
  std::filesystem::path out;
  McapMessages messages = McapMessages::kCdr;

  // Of a whole column.
  std::filesystem::path column;
  std::string manoeuvre = "lane_keeping";
  double steering_rad = 0.1;
  std::string change = "constant";
  std::optional<double> change_to_nm_per_rad;
  double change_at_s = 20;
  double change_over_s = 5;
  std::vector<std::pair<double, double>> releases;
  std::filesystem::path truth;
};

template <class Choices>
std::vector<std::string> names(const Choices& choices) {
  std::vector<std::string> out;
  for (const auto choice : choices) out.emplace_back(name(choice));
  return out;
}

/// The choice called `wanted`, which the option's validator has found to be one of them.
template <class Choices>
auto chosen(const Choices& choices, std::string_view wanted) {
  for (const auto choice : choices) {
    if (name(choice) == wanted) return choice;
  }
  throw std::logic_error("a choice passed its validator but is not known");
}

/// What is wrong with --probe; empty when it is a number or names a file.
[[nodiscard]] std::string probe_complaint(const std::string& text);

/// The probe and how long the drive lasts: as asked for, else as the file of the probe plans it, else as given.
[[nodiscard]] PlannedProbe planned_probe(const SimulateOptions& options, PlannedProbe usual);

/// A back end with a progress bar: everything else about the port is its own.
template <class Simulated>
class WatchedHal : public Simulated {
 public:
  template <class Scenario, class Drive>
  WatchedHal(const Scenario& scenario, Drive& result)
      : Simulated(scenario, &result),
        progress_("simulating", static_cast<std::uint64_t>(scenario.duration_s / kTickS + 0.5)) {}

  Status wait_tick() {
    progress_.at(tick_++);
    return Simulated::wait_tick();
  }

 private:
  Progress progress_;
  std::uint64_t tick_ = 0;
};

/// The drive through the loop that goes on the microcontroller: what it estimates is in the result too.
template <class Drive, class Simulated, class Scenario>
Drive drive_through(const Scenario& scenario) {
  Drive result;
  WatchedHal<Simulated> hal(scenario, result);
  IdentificationTask<float> task;
  if (run_loop(hal, task) != Status::kOk) throw std::logic_error("a simulated drive ended otherwise than by its end");
  return result;
}

/// The record's channels in that order, with `comments`, to --out.
void write_simulated(const SimulateOptions& options, std::initializer_list<Channel> channels, const Record& record,
                     const std::vector<std::string>& comments);

/// An estimate in one line.
[[nodiscard]] std::string estimate_text(const Estimate& estimate);

[[nodiscard]] double rms_of(const std::vector<double>& values);

/// `steerid simulate --task drive`.
void simulate_column(const SimulateOptions& options);

}  // namespace steerid
