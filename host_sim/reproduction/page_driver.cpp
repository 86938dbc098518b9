// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The driver's state as the firmware tells it.
#include <algorithm>

#include "reproduction/page_parts.hpp"

namespace steerid::page {
namespace {

constexpr std::array kStates{"unknown", "hands_off", "relaxed", "braced"};
constexpr std::array kHandCounts{"unknown", "none", "one", "two"};

report::Table confusion(const std::string& title, const std::string& caption, const Confusion& table,
                        const std::array<const char*, 4>& names) {
  report::Table out;
  out.title = title;
  out.caption = caption;
  out.columns = {words("true \\ told")};
  for (const char* one : names) out.columns.push_back({.label = one, .unit = "%", .digits = 3});
  for (std::size_t truth = 1; truth < names.size(); ++truth) {
    const auto& row = table[truth];
    const double all = row[0] + row[1] + row[2] + row[3];
    std::vector<report::Cell> cells{std::string(names[truth])};
    for (const double seconds : row) cells.emplace_back(all > 0 ? 100 * seconds / all : kNothing);
    out.rows.push_back(std::move(cells));
  }
  return out;
}

report::Table detection_table(const DriverStateScore& score) {
  report::Table out;
  out.title = "Time to tell a new state";
  out.caption = "From the change to the first instant at which the new state is told and stays told for a second.";
  out.columns = {words("change"), numbers("changes", "", 3), numbers("told", "", 3), numbers("median", "s", 2),
                 numbers("longest", "s", 3)};
  for (std::size_t from = 0; from < kStates.size(); ++from) {
    for (std::size_t to = 1; to < kStates.size(); ++to) {
      std::vector<double> after;
      std::size_t changes = 0;
      for (const Detection& one : score.detections) {
        if (static_cast<std::size_t>(one.from) != from || static_cast<std::size_t>(one.to) != to) continue;
        ++changes;
        if (one.after_s) after.push_back(*one.after_s);
      }
      if (changes == 0) continue;
      const Spread spread = spread_of(after);
      out.rows.push_back({fmt::format("{} \u2192 {}", from == 0 ? "start" : kStates[from], kStates[to]),
                          fmt::format("{}", changes), fmt::format("{}", after.size()), spread.median, spread.high});
    }
  }
  return out;
}

Spread inertia_of_one_arm(const ExperimentResults& results) {
  std::vector<double> values;
  for (const VirtualSubject& subject : results.run.subjects) {
    for (std::size_t hands = 0; hands < 3; ++hands) values.push_back(subject.passive[hands].inertia_kgm2);
  }
  return spread_of(std::move(values));
}

/// J of both arms over J of one, the median of what was put in.
double second_hand(const ExperimentResults& results) {
  std::vector<double> values;
  for (const VirtualSubject& subject : results.run.subjects) {
    for (std::size_t hands = 0; hands < 3; ++hands) {
      values.push_back(subject.passive[hands + 3].inertia_kgm2 / subject.passive[hands].inertia_kgm2);
    }
  }
  return spread_of(std::move(values)).median;
}

}  // namespace

void add_driver_state(report::Page& page, const ExperimentResults& results) {
  const Spread one_arm = inertia_of_one_arm(results);
  const DriverStateScore& score = results.driver_probed;
  page.parts.push_back(report::Section{
      "The driver's state, for a take-over",
      fmt::format(
          "{} drives of 170 s: braced and relaxed, one hand and both, hands off for 20 s, with a probe of {} Nm "
          "rms and the sensors of a production wheel. The firmware tells a state only of parameters that are "
          "valid at that very tick.",
          score.drives, results.run.settings.probe_rms_nm)});
  page.parts.push_back(confusion(
      "States, all of the time",
      fmt::format(
          "{} of the time a state is told; {} of that time the wrong one. For {} s of {} s the driver's true arm "
          "has the J, B and C that the firmware's limits give to another state.",
          percent(score.told_share(score.state)), percent(score.wrong_share(score.state)), score.overlapping_s,
          170 * score.drives),
      score.state, kStates));
  page.parts.push_back(
      confusion("States, from 5 s after every change on",
                fmt::format("{} of the told time is wrong.", percent(score.wrong_share(score.state_settled))),
                score.state_settled, kStates));
  page.parts.push_back(detection_table(score));
  page.parts.push_back(
      confusion("Number of hands",
                fmt::format("Told in {} of the time, wrong in {} of that. The inertias put in differ by "
                            "a factor of {:.1f} between records of one arm, and both arms from one by "
                            "{:.2f}: the number can be told where a hand comes or leaves during the "
                            "drive, or where no single arm is so heavy.",
                            percent(score.told_share(score.hands)), percent(score.wrong_share(score.hands)),
                            one_arm.high / one_arm.low, second_hand(results)),
                score.hands, kHandCounts));
  page.parts.push_back(confusion(
      "States without a probe",
      fmt::format("The same drives as the paper excites: a state is told {} of the time, and {} of the told time is "
                  "wrong.",
                  percent(results.driver_plain.told_share(results.driver_plain.state)),
                  percent(results.driver_plain.wrong_share(results.driver_plain.state))),
      results.driver_plain.state, kStates));
}

}  // namespace steerid::page
