// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/friction_study.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "study/arm_score.hpp"
#include "study/drives_of_cases.hpp"
#include "study/hands_drive.hpp"
#include "study/labelled_drive.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

constexpr std::array kFriction_nm = {0.0, 0.05, 0.1, 0.2, 0.3};
constexpr std::size_t kFrom = 500;  // rows: 5 s

struct Answer {
  std::array<ParameterTicks, 3> arm{};
  ToldRelease release;
  HeldWheel held;
};

std::vector<WheelFriction> all_cases() {
  std::vector<WheelFriction> cases;
  for (const double size_nm : kFriction_nm) {
    cases.push_back({size_nm, 0});
    if (size_nm > 0) cases.push_back({size_nm, size_nm});
  }
  return cases;
}

std::array<ParameterTicks, 3> arm_of(const WheelFriction& friction, std::uint64_t seed, std::uint64_t number) {
  const LabelledDrive drive =
      held_out_drive({.steering_rad = 0.05, .wheel_friction_nm = friction.there_nm}, seed, number);
  return ticks_from(kFrom, estimates_of<float>(drive.record, friction.told_nm), drive.truth);
}

std::vector<report::Cell> row_of(const WheelFriction& friction, const std::vector<Answer>& answers) {
  ParameterTicks damping;
  std::vector<double> told_s;
  double never = 0, nobody = 0, told = 0;
  std::array<double, 2> alarmed_s{};  // by an arm, by two fingers
  std::array<double, 2> held_s{};
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const Answer& one = answers[k];
    damping += one.arm[1];
    told_s.push_back(one.release.told_after_s[0][0]);
    never += std::isinf(told_s.back()) ? 1 : 0;
    for (const std::size_t ticks : one.release.ticks) nobody += static_cast<double>(ticks);
    told += static_cast<double>(one.release.ticks[static_cast<std::size_t>(DriverState::kHandsOff)]);
    alarmed_s[by_two_fingers(k)] += one.held.alarmed_s[0][0];
    held_s[by_two_fingers(k)] += kHandsDrive_s - kHandsSettling_s;
  }
  return {fmt::format("{:g} Nm", friction.there_nm),
          std::string(friction.told_nm > 0 ? "yes" : "no"),
          damping.valid_percent(),
          damping.valid_close_percent(),
          damping.wrong_of_valid_percent(),
          quantile(told_s, 0.5),
          100 * never / static_cast<double>(answers.size()),
          100 * told / nobody,
          100 * alarmed_s[0] / held_s[0],
          100 * alarmed_s[1] / held_s[1]};
}

}  // namespace

Findings run_friction_study(const FrictionStudy& study, const StudyProgress& at) {
  const std::vector<WheelFriction> cases = all_cases();
  const auto answers =
      answers_of_drives<Answer>(cases, study.drives, at, [&](const WheelFriction& friction, std::size_t number) {
        return Answer{arm_of(friction, study.seed, number), held_out_release(study.seed, number, friction),
                      held_wheel(study.seed, number, friction)};
      });

  Findings found;
  found.study = "friction";
  found.title = "Dry friction above the torsion bar, and a task that is told of it";
  found.how = fmt::format(
      "{} arms that stay (probe of 1 Nm rms) and as many releases (0.5 Nm) by the held-out generator, and held wheels "
      "(0.5 Nm) of the project's column, for every size of friction, seed {}; the flashed task in float.",
      study.drives, study.seed);
  found.command = fmt::format("steerid study friction --drives {} --seed {}", study.drives, study.seed);
  FoundTable table{
      "friction",
      "The arm's damping and hands off",
      "Close: B valid and within 15 %. Wrong: outside the 95 % interval and more than a tenth off, of the "
      "valid ticks. Nobody told: from 6 s after the hands have left until they are back. In false alarm: "
      "share of the time that somebody holds the wheel.",
      {word_column("friction", "friction"), word_column("told_of_it", "told of it"),
       number_column("B_valid_percent", "B valid", "%"), number_column("B_close_percent", "valid and close", "%"),
       number_column("B_wrong_of_valid_percent", "of valid wrong", "%"),
       number_column("median_s", "hands off told after, median", "s"),
       number_column("missed_percent", "not at all", "%"), number_column("nobody_told_percent", "nobody told", "%"),
       number_column("false_arm_percent", "in false alarm, an arm", "%"),
       number_column("false_fingers_percent", "in false alarm, two fingers", "%")},
      {}};
  for (std::size_t k = 0; k < cases.size(); ++k) table.rows.push_back(row_of(cases[k], answers[k]));
  found.tables.push_back(std::move(table));
  return found;
}

}  // namespace steerid
