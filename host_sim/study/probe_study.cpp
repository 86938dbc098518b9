// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/probe_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "app/run_loop.hpp"
#include "study/arm_score.hpp"
#include "study/drives_of_cases.hpp"
#include "study/labelled_drive.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

constexpr double kDrive_s = 300;
constexpr std::size_t kFrom = 500;     // rows: 5 s
constexpr std::size_t kStarted = 300;  // rows before which nothing is judged
constexpr std::array kSteering_rad = {0.0, 0.03, 0.1, 0.2};
constexpr std::array kFlat_nm = {1.0, 0.5};
constexpr std::array<double, 3> kAskedClose = {85, 85, 70};  // percent of J, B and C, as in `study column`
constexpr std::size_t kFirstClose = 6;                       // column of the table `probe`

struct Case {
  std::string name;
  std::string probe{};
  double steering_rad = 0.1;
  double flat_nm = 0;  ///< rms; 0: the task's own
  double gain = 1;
  double late_s = 0;
  double motor_limit_nm = 0;  ///< of assist and probe together; 0: the drawn column's
};

struct Answer {
  std::array<ParameterTicks, 3> ticks{};
  double reached_s = std::numeric_limits<double>::infinity();
  double asked_square = 0;  ///< Nm^2, mean
  double felt_square = 0;
};

double mean_square(const std::vector<double>& values, const std::vector<double>* less = nullptr) {
  const std::size_t count = less == nullptr ? values.size() : std::min(values.size(), less->size());
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = less == nullptr ? values[k] : values[k] - (*less)[k];
    sum += x * x;
  }
  return sum / static_cast<double>(count);
}

ColumnDrive driven(const ColumnScenario& scenario) {
  ColumnDrive drive;
  SimulatedColumnHal hal(scenario, &drive);
  IdentificationTask<float> task;
  task.permit_probe(scenario.grant_probe_requests);
  static_cast<void>(run_loop(hal, task));  // it ends with the scenario
  return drive;
}

bool reached(const Estimate& estimate) {
  const auto parameters = parameters_of(estimate);
  return std::all_of(parameters.begin(), parameters.end(),
                     [](const ParameterEstimate& p) { return p.sd_micro < p.value_micro / 10; });
}

Answer answer_of(const Case& what, std::uint64_t seed, std::uint64_t number) {
  ColumnScenario scenario = drawn_scenario(
      {.steering_rad = what.steering_rad, .probe_nm = what.flat_nm, .duration_s = kDrive_s}, seed, number);
  scenario.column.probe_gain = what.gain;
  scenario.column.probe_delay_s = what.late_s;
  if (what.motor_limit_nm > 0) scenario.column.motor_limit_nm = what.motor_limit_nm;
  scenario.grant_probe_requests = what.flat_nm == 0;
  const ColumnDrive drive = driven(scenario);
  scenario.grant_probe_requests = false;
  scenario.drive.probe.rms_nm = 0;
  const ColumnDrive without = driven(scenario);

  Answer answer;
  ArmScore score;
  const std::size_t rows = std::min(drive.estimates.size(), drive.truth.size());
  for (std::size_t k = 0; k < rows; ++k) {
    if (k >= kFrom) score.take(drive.estimates[k], drive.truth[k].arm);
    if (k >= kStarted && std::isinf(answer.reached_s) && reached(drive.estimates[k]))
      answer.reached_s = kTickS * static_cast<double>(k);
  }
  answer.ticks = score.parameters();
  answer.asked_square = mean_square(drive.undisturbed.probe_nm);
  answer.felt_square = mean_square(drive.undisturbed.torque_rim_nm, &without.undisturbed.torque_rim_nm);
  return answer;
}

std::vector<Case> cases_of_probes() {
  std::vector<Case> cases;
  for (const double steering : kSteering_rad) {
    const std::string name = fmt::format("{:g} rad", steering);
    cases.push_back({.name = name, .probe = "the task's own", .steering_rad = steering});
    for (const double flat : kFlat_nm)
      cases.push_back(
          {.name = name, .probe = fmt::format("flat, {:g} Nm", flat), .steering_rad = steering, .flat_nm = flat});
  }
  return cases;
}

std::vector<Case> cases_of_delivery() {
  return {{.name = "as asked"},
          {.name = "5 ms late", .late_s = 0.005},
          {.name = "15 ms late", .late_s = 0.015},
          {.name = "30 ms late", .late_s = 0.03},
          {.name = "half of it", .gain = 0.5},
          {.name = "clipped: motor of 1.5 Nm", .motor_limit_nm = 1.5},
          {.name = "30 ms late, 0.7 of it, motor of 2 Nm", .gain = 0.7, .late_s = 0.03, .motor_limit_nm = 2}};
}

// ---- figures ----

std::vector<FoundColumn> columns(bool with_probe) {
  std::vector<FoundColumn> all = {word_column("case", with_probe ? "driver steers" : "delivered")};
  if (with_probe) all.push_back(word_column("probe", "probe"));
  for (FoundColumn& one : std::vector<FoundColumn>{
           number_column("reached_s", "deviations below a tenth after, median", "s"),
           number_column("never_percent", "never", "%"), number_column("asked_nm", "asked for, rms", "Nm"),
           number_column("felt_nm", "felt at the rim, rms", "Nm"),
           number_column("J_close_percent", "J valid and close", "%"),
           number_column("B_close_percent", "B valid and close", "%"),
           number_column("C_close_percent", "C valid and close", "%"),
           number_column("J_wrong_percent", "J valid and wrong", "%"),
           number_column("B_wrong_percent", "B valid and wrong", "%"),
           number_column("C_wrong_percent", "C valid and wrong", "%")})
    all.push_back(std::move(one));
  return all;
}

void add_row(FoundTable& table, const Case& what, const std::vector<Answer>& answers) {
  std::vector<double> times;
  std::array<ParameterTicks, 3> ticks{};
  double asked = 0;
  double felt = 0;
  double never = 0;
  const auto count = static_cast<double>(answers.size());
  for (const Answer& one : answers) {
    times.push_back(one.reached_s);
    never += std::isinf(one.reached_s) ? 100 / count : 0;
    asked += one.asked_square / count;
    felt += one.felt_square / count;
    for (std::size_t i = 0; i < ticks.size(); ++i) ticks[i] += one.ticks[i];
  }
  std::vector<report::Cell> row = {what.name};
  if (!what.probe.empty()) row.emplace_back(what.probe);
  for (const double x : {quantile(times, 0.5), never, std::sqrt(asked), std::sqrt(felt)}) row.emplace_back(x);
  for (const ParameterTicks& of : ticks) row.emplace_back(of.valid_close_percent());
  for (const ParameterTicks& of : ticks) row.emplace_back(of.wrong_percent());
  table.rows.push_back(std::move(row));
}

}  // namespace

Findings run_probe_study(const ProbeStudy& study, const StudyProgress& at) {
  std::vector<Case> cases = cases_of_probes();
  const std::size_t probes = cases.size();
  for (Case& one : cases_of_delivery()) cases.push_back(std::move(one));
  const auto answers = answers_of_drives<Answer>(
      cases, study.drives, at, [&](const Case& one, std::size_t number) { return answer_of(one, study.seed, number); });

  Findings found;
  found.study = "probe";
  found.title = "What the task's own probe costs and reaches";
  found.how = fmt::format(
      "{} drives of 300 s a case, seed {}; drawn columns, arms that stay, the flashed task in float. Shares are of the "
      "ticks after 5 s.",
      study.drives, study.seed);
  found.command = fmt::format("steerid study probe --drives {} --seed {}", study.drives, study.seed);
  found.tables = {{"probe", "The task's own probe beside a flat one that is always there", "", columns(true), {}},
                  {"delivered",
                   "The task's own probe, by how the EPS delivers it; a driver of 0.1 rad rms",
                   "",
                   columns(false),
                   {}}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    FoundTable& table = found.tables[k < probes ? 0 : 1];
    add_row(table, cases[k], answers[k]);
    if (k >= probes || cases[k].flat_nm > 0 || cases[k].steering_rad == 0) continue;
    for (std::size_t i = 0; i < kAskedClose.size(); ++i) {
      const std::size_t column = kFirstClose + i;
      found.asked.push_back({fmt::format("{}: {}", cases[k].name, table.columns[column].shown.label), "%",
                             std::get<double>(table.rows.back()[column]), kAskedClose[i], AskedFigure::Limit::kAtLeast,
                             study.drives});
    }
  }
  return found;
}

}  // namespace steerid
