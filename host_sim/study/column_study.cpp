// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/column_study.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "identifier/fixed_in_eigen.hpp"
#include "study/arm_score.hpp"
#include "study/drives_of_cases.hpp"
#include "study/labelled_drive.hpp"
#include "study/probe_bound.hpp"

namespace steerid {
namespace {

constexpr std::array<const char*, 3> kSymbols = {"J", "B", "C"};
constexpr std::size_t kFrom = 500;            // rows: 5 s
constexpr std::size_t kThirtySeconds = 2999;  // row
constexpr double kProbe_nm = 1;
constexpr std::array kSteers_rad = {0.03, 0.1, 0.2};
constexpr std::array kSteering_rad = {0.0, 0.03, 0.1, 0.2};
constexpr std::array kProbes_nm = {0.25, 0.5, 1.0};

/// What one drive says.
struct DriveAnswer {
  std::array<ParameterTicks, 3> ticks{};
  std::array<double, 3> reachable{};      ///< share of the ticks
  std::array<double, 3> error_at_30_s{};  ///< over the truth
  std::array<double, 3> bound_at_30_s{};  ///< likewise
  double differing_percent = 0;           ///< fixed point against float
};

/// How likely an estimate at the bound is to lie within 15 % of the truth.
double close_share(double deviation, double truth, std::size_t parameter) {
  const double scale = std::max(truth, ArmScore::kSmall[parameter]);
  return std::erf(ArmScore::kClose * scale / deviation / std::sqrt(2.0));
}

DriveAnswer answer_of(const LabelledDrive& drive, bool in_fixed_too) {
  DriveAnswer answer;
  const std::vector<Estimate> said = estimates_of<float>(drive.record);
  answer.ticks = ticks_from(kFrom, said, drive.truth);

  const auto bound = followed_bound(drive.information, walk_of(drive.truth), Uses::kPast);
  const std::size_t first = kFrom / LabelledDrive::kBlock;
  for (std::size_t block = first; block < bound.size(); ++block) {
    const auto truth = parameters_of(drive.truth[block * LabelledDrive::kBlock]);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      answer.reachable[i] += close_share(bound[block](static_cast<Eigen::Index>(i)), truth[i], i) /
                             static_cast<double>(bound.size() - first);
    }
  }
  const auto truth = parameters_of(drive.truth[kThirtySeconds]);
  const auto estimate = parameters_of(said[kThirtySeconds]);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    answer.error_at_30_s[i] = 1e-6 * estimate[i].value_micro / truth[i] - 1;
    answer.bound_at_30_s[i] = bound[kThirtySeconds / LabelledDrive::kBlock](static_cast<Eigen::Index>(i)) / truth[i];
  }
  if (in_fixed_too) answer.differing_percent = differing_percent(said, estimates_of<Fixed>(drive.record));
  return answer;
}

struct Case {
  std::string name;
  DriveRequest request;
  bool held_out = false;
  bool steers_by_number = false;  ///< steering is that of kSteers_rad in turn
  bool in_fixed_too = false;
};

std::vector<Case> cases_of_arms() {
  std::vector<Case> cases;
  for (const bool held_out : {false, true}) {
    for (const ArmStory story : kAllArmStories) {
      cases.push_back({.name = fmt::format("{}, {}", held_out ? "held out" : "drawn", name(story)),
                       .request = {.story = story, .probe_nm = kProbe_nm},
                       .held_out = held_out,
                       .steers_by_number = true,
                       .in_fixed_too = true});
    }
  }
  return cases;
}

std::vector<Case> cases_of_steering() {
  std::vector<Case> cases;
  for (const double steering : kSteering_rad) {
    for (const double probe : kProbes_nm) {
      cases.push_back({.name = fmt::format("{:g} rad, probe {:g} Nm", steering, probe),
                       .request = {.steering_rad = steering, .probe_nm = probe}});
    }
  }
  return cases;
}

DriveAnswer driven(const Case& what, std::uint64_t seed, std::uint64_t number) {
  DriveRequest request = what.request;
  if (what.steers_by_number) request.steering_rad = kSteers_rad[number % kSteers_rad.size()];
  return answer_of(what.held_out ? held_out_drive(request, seed, number)
                                 : drive_of(drawn_scenario(request, seed, number), Known::kBarAndProbe),
                   what.in_fixed_too);
}

// ---- figures ----

double root_mean_square(const std::vector<DriveAnswer>& answers, auto of) {
  double sum = 0;
  for (const DriveAnswer& one : answers) sum += of(one) * of(one);
  return std::sqrt(sum / static_cast<double>(answers.size()));
}

double mean(const std::vector<DriveAnswer>& answers, auto of) {
  double sum = 0;
  for (const DriveAnswer& one : answers) sum += of(one);
  return sum / static_cast<double>(answers.size());
}

ParameterTicks ticks_of(const std::vector<DriveAnswer>& answers, std::size_t i) {
  ParameterTicks all;
  for (const DriveAnswer& one : answers) all += one.ticks[i];
  return all;
}

const std::vector<FoundColumn>& shares() {
  static const std::vector<FoundColumn> kShares = {word_column("drives", "drives"),
                                                   word_column("parameter", "parameter"),
                                                   number_column("close_percent", "valid and close", "%"),
                                                   number_column("reachable_percent", "reachable", "%"),
                                                   number_column("valid_percent", "valid", "%"),
                                                   number_column("covered_percent", "valid ones covered", "%"),
                                                   number_column("wrong_percent", "valid and wrong", "%"),
                                                   number_column("wrong_of_valid_percent", "of the valid ones", "%"),
                                                   number_column("longest_wrong_s", "longest", "s"),
                                                   number_column("rmse_30_s_percent", "RMSE at 30 s", "%"),
                                                   number_column("bound_30_s_percent", "bound", "%"),
                                                   number_column("rmse_over_bound", "over the bound", "")};
  return kShares;
}

std::vector<FoundTable> empty_tables() {
  return {{"arms",
           "A probe of 1 Nm, a driver who steers: what becomes of the arm",
           "Shares of all ticks after 5 s. RMSE and bound in percent of the truth, over the drives.",
           shares(),
           {}},
          {"steering", "Arms that stay, drawn: steering and probe", "As above.", shares(), {}},
          {"alike",
           "Fixed point against float on the drives above",
           "A tick differs when a state does, or a value by more than a tenth of its standard deviation.",
           {word_column("drives", "drives"), number_column("differing_percent", "ticks that differ", "%")},
           {}}};
}

void add_shares(FoundTable& table, const Case& what, const std::vector<DriveAnswer>& answers) {
  for (std::size_t i = 0; i < kSymbols.size(); ++i) {
    const ParameterTicks all = ticks_of(answers, i);
    const double rmse = root_mean_square(answers, [&](const DriveAnswer& one) { return one.error_at_30_s[i]; });
    const double bound = root_mean_square(answers, [&](const DriveAnswer& one) { return one.bound_at_30_s[i]; });
    const double over =
        root_mean_square(answers, [&](const DriveAnswer& one) { return one.error_at_30_s[i] / one.bound_at_30_s[i]; });
    table.rows.push_back({what.name, std::string(kSymbols[i]), all.valid_close_percent(),
                          100 * mean(answers, [&](const DriveAnswer& one) { return one.reachable[i]; }),
                          all.valid_percent(), all.covered_percent(), all.wrong_percent(), all.wrong_of_valid_percent(),
                          all.longest_wrong_s, 100 * rmse, 100 * bound, over});
  }
}

void ask(Findings& found, const Case& what, const std::vector<DriveAnswer>& answers) {
  using Limit = AskedFigure::Limit;
  constexpr std::array kAskedClose = {85.0, 85.0, 70.0};
  for (std::size_t i = 0; i < kSymbols.size(); ++i) {
    const ParameterTicks all = ticks_of(answers, i);
    const std::string of = fmt::format("{}, {}", what.name, kSymbols[i]);
    if (what.request.story == ArmStory::kStays) {
      found.asked.push_back(
          {of + ": valid and within 15 %", "%", all.valid_close_percent(), kAskedClose[i], Limit::kAtLeast});
      if (i == 2) {
        found.asked.push_back(
            {of + ": RMSE after 30 s over the bound", "",
             root_mean_square(answers,
                              [&](const DriveAnswer& one) { return one.error_at_30_s[i] / one.bound_at_30_s[i]; }),
             1.5});
      }
    }
    found.asked.push_back({of + ": valid and wrong", "%", all.wrong_percent(), 2});
  }
}

report::Bars share_chart(const FoundTable& arms) {
  report::Bars bars;
  bars.title = "Valid and within 15 %, a probe of 1 Nm, a driver who steers";
  bars.value = {.label = "share of ticks after 5 s", .unit = "%"};
  report::BarSeries close{.name = "valid and close", .meaning = report::Meaning::kModel};
  report::BarSeries reachable{.name = "reachable", .meaning = report::Meaning::kReference};
  for (const auto& row : arms.rows) {
    bars.categories.push_back(std::get<std::string>(row[1]) + ", " + std::get<std::string>(row[0]));
    close.values.push_back(std::get<double>(row[2]));
    reachable.values.push_back(std::get<double>(row[3]));
  }
  bars.series = {close, reachable};
  return bars;
}

}  // namespace

Findings run_column_study(const ColumnStudy& study, const StudyProgress& at) {
  std::vector<Case> cases = cases_of_arms();
  const std::size_t arms = cases.size();
  for (Case& one : cases_of_steering()) cases.push_back(std::move(one));
  const auto answers = answers_of_drives<DriveAnswer>(
      cases, study.drives, at, [&](const Case& one, std::size_t number) { return driven(one, study.seed, number); });

  Findings found;
  found.study = "column";
  found.title = "The arm of a driver who steers, from torsion bar and probe";
  found.how = fmt::format(
      "{} drives of 60 s a case, seed {}; the flashed task in float. Drawn: the project's own column. Held out: "
      "another "
      "column, driver, road and sensors, integrated by another method, on which nothing is tuned.",
      study.drives, study.seed);
  found.command = fmt::format("steerid study column --drives {} --seed {}", study.drives, study.seed);
  found.tables = empty_tables();
  for (std::size_t k = 0; k < cases.size(); ++k) {
    add_shares(found.tables[k < arms ? 0 : 1], cases[k], answers[k]);
    if (k >= arms) continue;
    ask(found, cases[k], answers[k]);
    found.tables[2].rows.push_back(
        {cases[k].name, mean(answers[k], [](const DriveAnswer& one) { return one.differing_percent; })});
  }
  found.charts.push_back(share_chart(found.tables[0]));
  return found;
}

}  // namespace steerid
