// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/arm_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "identifier/fixed_in_eigen.hpp"
#include "study/arm_score.hpp"
#include "study/drives_of_cases.hpp"
#include "study/following.hpp"
#include "study/labelled_drive.hpp"
#include "study/over_kinds.hpp"
#include "study/probe_bound.hpp"

namespace steerid {
namespace {

constexpr std::array<const char*, 3> kSymbols = {"J", "B", "C"};
constexpr double kAt_s = 20;
constexpr double kAfter_s = 15;
constexpr double kSteering_rad = 0.1;
constexpr double kStrongest_nm = 4;

/// A change as factors of the usual arm and wheel; J and B stay where theirs is 1, B follows C where it is 0.
struct Change {
  std::string name;
  ArmCourse course = ArmCourse::kRamp;
  double length_s = 0;
  double stiffness = 1;
  double damping = 1;
  double inertia = 1;
  double from_stiffness = 1;  ///< of the drawn C, before

  /// From its start on until the arm is as it stays, or for a swing as long as it is looked at.
  [[nodiscard]] double lasts_s() const {
    if (course == ArmCourse::kThereAndBack) return 2 * length_s;
    return course == ArmCourse::kSwing ? std::max(40.0, 1.5 * length_s) : length_s;
  }
};

Change ramp(double stiffness, double within_s) {
  return {fmt::format("C x{:g} within {:g} s", stiffness, within_s), within_s > 0 ? ArmCourse::kRamp : ArmCourse::kStep,
          std::max(within_s, kTickS), stiffness, 0};
}

Change there_and_back(double stiffness, double within_s) {
  return {fmt::format("C x{:g} within {:g} s and back", stiffness, within_s), ArmCourse::kThereAndBack, within_s,
          stiffness, 0};
}

Change swing(double depth, double period_s) {
  Change change{fmt::format("C swings by {:g} %, {:g} s", 100 * depth, period_s), ArmCourse::kSwing, period_s,
                (1 + depth) / (1 - depth), 0};
  change.from_stiffness = 1 - depth;
  return change;
}

std::vector<Change> all_changes() {
  std::vector<Change> all;
  for (const double within_s : {0.0, 0.3, 1.0, 2.0, 5.0, 20.0, 60.0}) all.push_back(ramp(2, within_s));
  for (const double stiffness : {1.33, 5.0, 0.5}) {
    for (const double within_s : {0.3, 5.0, 20.0}) all.push_back(ramp(stiffness, within_s));
  }
  for (const double within_s : {2.0, 10.0, 30.0}) all.push_back(there_and_back(2, within_s));
  for (const double stiffness : {3.0, 5.0}) all.push_back(there_and_back(stiffness, 20));
  for (const auto& [depth, period_s] :
       {std::pair{0.2, 8.0}, {0.2, 20.0}, {0.2, 60.0}, {0.5, 8.0}, {0.5, 15.0}, {0.5, 60.0}, {0.8, 30.0}}) {
    all.push_back(swing(depth, period_s));
  }
  for (const double within_s : {0.3, 30.0}) {
    all.push_back({fmt::format("B x2 within {:g} s", within_s), ArmCourse::kRamp, within_s, 1, 2});
  }
  all.push_back({"B x2 and C x2 within 5 s", ArmCourse::kRamp, 5, 2, 2});
  all.push_back({"a second hand: J x1.15, B x1.3, C x1.3", ArmCourse::kRamp, 0.3, 1.3, 1.3, 1.15});
  return all;
}

ColumnScenario scenario_of(const Change& change, const ArmChangesStudy& study, std::uint64_t number) {
  ColumnScenario scenario = drawn_scenario({.duration_s = kAt_s + change.lasts_s() + kAfter_s}, study.seed, number);
  scenario.sensors.wheel.angle.bias.offset = study.angle_offset_rad;
  DriveSettings& drive = scenario.drive;
  WheelArm& arm = drive.arm;
  arm.stiffness_nm_per_rad *= change.from_stiffness;
  drive.change = {.course = change.course,
                  .stiffness_nm_per_rad = change.stiffness * arm.stiffness_nm_per_rad,
                  .at_s = kAt_s,
                  .length_s = change.length_s,
                  .inertia_kgm2 = change.inertia * arm.inertia_kgm2};
  if (change.damping > 0) drive.change.damping_nms_per_rad = change.damping * arm.damping_nms_per_rad;
  const double stiffest = std::max(1.0, change.stiffness) * arm.stiffness_nm_per_rad;
  drive.steering_rad = std::min(kSteering_rad, kStrongest_nm / stiffest);
  return scenario;
}

/// What one drive says, in one of the two worlds.
struct DriveAnswer {
  std::array<ParameterTicks, 3> ticks{};
  std::array<FollowedCourse, 3> course;
  std::array<double, 3> bound_square{};  ///< of the smoother's deviation over the truth, mean over the ticks judged
  double differing_percent = 0;
};

DriveAnswer answer_of(const LabelledDrive& drive) {
  DriveAnswer answer;
  const std::vector<Estimate> said = estimates_of<float>(drive.record);
  const auto first = static_cast<std::size_t>(std::llround(kAt_s / kTickS));
  ArmScore score;
  for (std::size_t k = first; k < said.size(); ++k) {
    score.take(said[k], drive.truth[k]);
    const auto estimates = parameters_of(said[k]);
    const auto truths = parameters_of(drive.truth[k]);
    for (std::size_t i = 0; i < truths.size(); ++i) {
      answer.course[i].truth.push_back(truths[i]);
      answer.course[i].estimate.push_back(1e-6 * estimates[i].value_micro);
    }
  }
  answer.ticks = score.parameters();
  const auto bound = followed_bound(drive.information, walk_of(drive.truth), Uses::kPastAndFuture);
  const std::size_t from = first / LabelledDrive::kBlock;
  for (std::size_t block = from; block < bound.size(); ++block) {
    const auto truths = parameters_of(drive.truth[block * LabelledDrive::kBlock]);
    for (std::size_t i = 0; i < truths.size(); ++i) {
      const double relative = bound[block](static_cast<Eigen::Index>(i)) / truths[i];
      answer.bound_square[i] += relative * relative / static_cast<double>(bound.size() - from);
    }
  }
  answer.differing_percent = differing_percent(said, estimates_of<Fixed>(drive.record));
  return answer;
}

using OfDrive = std::array<DriveAnswer, 2>;  // known, bar
constexpr std::array kWorlds = {"known", "bar"};

OfDrive answers_of(const Change& change, const ArmChangesStudy& study, std::uint64_t number) {
  const ColumnScenario scenario = scenario_of(change, study, number);
  return {answer_of(drive_of(scenario, Known::kAllTorque)), answer_of(drive_of(scenario, Known::kBarAndProbe))};
}

FoundTable changes_table() {
  return {
      "changes",
      "An arm that changes: states and errors from its start until 15 s after its end",
      "Known: all torque is measured. Bar: torsion bar and probe, a driver who steers. Errors over the truth. "
      "Settled: after the change has ended, until within 15 % to stay.",
      {word_column("change", "change"), word_column("torque", "torque"), word_column("parameter", "parameter"),
       number_column("valid_percent", "valid", "%"), number_column("wrong_of_valid_percent", "of these wrong", "%"),
       number_column("longest_wrong_s", "longest", "s"), number_column("covered_percent", "covered", "%"),
       number_column("total_percent", "total error", "%"), number_column("bias_percent", "bias", "%"),
       number_column("random_percent", "random", "%"), number_column("bound_percent", "bound", "%"),
       number_column("total_over_bound", "over the bound", ""), number_column("vaf_percent", "VAF", "%"),
       number_column("lag_s", "lag", "s"), number_column("rise_s", "rise", "s"),
       number_column("truth_rise_s", "truth's rise", "s"), number_column("settled_median_s", "settled, median", "s"),
       number_column("settled_p90_s", "90 % below", "s")},
      {}};
}

struct Row {
  ParameterTicks ticks;
  Following following;
  double bound = 0;
};

Row row_of(const Change& change, const std::vector<OfDrive>& drives, std::size_t world, std::size_t i) {
  Row row;
  std::vector<FollowedCourse> courses;
  double square = 0;
  std::size_t shortest = drives.front()[world].course[i].truth.size();
  for (const OfDrive& drive : drives) shortest = std::min(shortest, drive[world].course[i].truth.size());
  for (const OfDrive& drive : drives) {
    row.ticks += drive[world].ticks[i];
    courses.push_back(drive[world].course[i]);
    courses.back().truth.resize(shortest);  // a lost message is a row less
    courses.back().estimate.resize(shortest);
    square += drive[world].bound_square[i] / static_cast<double>(drives.size());
  }
  row.following = following_of(courses, change.lasts_s());
  row.bound = std::sqrt(square);
  return row;
}

void add(Findings& found, const Change& change, const std::vector<OfDrive>& drives) {
  FoundTable& changes = found.tables[found.tables.size() - 2];
  FoundTable& alike = found.tables.back();
  for (std::size_t world = 0; world < kWorlds.size(); ++world) {
    double differing = 0;
    for (const OfDrive& drive : drives) {
      differing += drive[world].differing_percent / static_cast<double>(drives.size());
    }
    alike.rows.push_back({change.name, std::string(kWorlds[world]), differing});
    for (std::size_t i = 0; i < kSymbols.size(); ++i) {
      const Row row = row_of(change, drives, world, i);
      const Following& f = row.following;
      changes.rows.push_back({change.name, std::string(kWorlds[world]), std::string(kSymbols[i]),
                              row.ticks.valid_percent(), row.ticks.wrong_of_valid_percent(), row.ticks.longest_wrong_s,
                              row.ticks.covered_percent(), 100 * f.total, 100 * f.bias, 100 * f.random, 100 * row.bound,
                              f.total / row.bound, 100 * f.accounted, f.lag_s, f.rise_s, f.truth_rise_s,
                              f.settled_median_s, f.settled_p90_s});
    }
  }
}

/// Of C, over all changes of 5 s and more, and over the faster ones: the worst, and in how many cases it is met.
void ask(Findings& found, const std::vector<Change>& changes, std::size_t drives) {
  const auto of_c = [&](const Change& change, const char* world, const char* key) {
    return found.figure("changes", fmt::format("{}, {}, C", change.name, world), key);
  };
  using Limit = AskedFigure::Limit;
  for (const char* world : kWorlds) {
    double lag = 0, total = 0, over = 0, settled = 0;
    double covered = std::nan("");  // nothing is valid
    for (const Change& change : changes) {
      if (change.stiffness == 1) continue;
      if (change.length_s < 5) {
        settled = std::max(settled, of_c(change, world, "settled_median_s"));
        continue;
      }
      lag = std::max(lag, of_c(change, world, "lag_s"));
      total = std::max(total, of_c(change, world, "total_percent"));
      over = std::max(over, of_c(change, world, "total_over_bound"));
      const double share = of_c(change, world, "covered_percent");
      covered = std::fmin(covered, share);  // leaves out what is NaN
    }
    const std::string torque = world == kWorlds[0] ? "all torque known" : "from the bar";
    found.asked.push_back(
        {"lag of C, changes of 5 s and more, worst kind, " + torque, "s", lag, 1, Limit::kAtMost, drives});
    if (world == kWorlds[0]) {
      found.asked.push_back({"error of C (NRMSE), changes of 5 s and more, worst kind, " + torque, "%", total, 5,
                             Limit::kAtMost, drives});
    } else {
      found.asked.push_back({"error of C over the smoother's bound, changes of 5 s and more, worst kind, " + torque, "",
                             over, 1.5, Limit::kAtMost, drives});
    }
    found.asked.push_back({"valid ticks of C covered, changes of 5 s and more, worst kind, " + torque, "%", covered, 92,
                           Limit::kAtLeast, drives});
    found.asked.push_back({"C within 15 % after a change of 2 s and less, median, worst kind, " + torque, "s", settled,
                           1.5, Limit::kAtMost, drives});
  }
}

}  // namespace

std::size_t arm_change_jobs(const ArmChangesStudy& study) { return all_changes().size() * study.drives; }

void add_arm_changes(Findings& found, const ArmChangesStudy& study, const StudyProgress& at) {
  const std::vector<Change> changes = all_changes();
  const auto answers = answers_of_drives<OfDrive>(
      changes, study.drives, at,
      [&](const Change& change, std::size_t number) { return answers_of(change, study, number); });
  found.tables.push_back(changes_table());
  found.tables.push_back({"alike",
                          "Fixed point against float on the same drives",
                          "A tick differs when a state does, or a value by more than a tenth of its deviation.",
                          {word_column("change", "change"), word_column("torque", "torque"),
                           number_column("differing_percent", "ticks that differ", "%")},
                          {}});
  for (std::size_t k = 0; k < changes.size(); ++k) add(found, changes[k], answers[k]);
  found.tables.push_back(over_kinds(found.tables[found.tables.size() - 2]));
  ask(found, changes, study.drives);
}

}  // namespace steerid
