// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/validity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "blind/column_drive.hpp"
#include "parallel/work_in_parallel.hpp"
#include "sensors/random.hpp"
#include "study/arm_score.hpp"
#include "study/following.hpp"
#include "study/labelled_drive.hpp"
#include "study/over_kinds.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

constexpr std::array<const char*, 4> kNames = {"all", "J", "B", "C"};
constexpr std::array kWorlds = {"known", "bar"};
constexpr double kFrom_s = 5;
constexpr std::uint64_t kStream = 320;

/// What happens to the record.
enum class Happens : std::uint8_t { kNothing, kFaults, kHidden };

struct Kind {
  std::string name;
  blind::ArmCourse course = blind::ArmCourse::kStays;
  double period_s = 0.01;
  Happens happens = Happens::kNothing;
  bool once = false;  ///< one change in a drive of a minute
};

std::vector<Kind> all_kinds() {
  using blind::ArmCourse;
  std::vector<Kind> kinds = {{"an arm that stays", ArmCourse::kStays},
                             {"C wanders by 15 %", ArmCourse::kWanders},
                             {"braces x1.5 to x4 every 95 s", ArmCourse::kBraces},
                             {"a second hand every 150 s", ArmCourse::kHandsCome},
                             {"B falls by 40 % in 10 min", ArmCourse::kWarmsUp},
                             {"wanders, braces, hands, hands off", ArmCourse::kOrdinary}};
  for (const double period_ms : {6.0, 7.5, 11.0, 12.0, 14.0}) {
    kinds.push_back({fmt::format("stays, samples {:g} ms apart", period_ms), ArmCourse::kStays, 1e-3 * period_ms});
  }
  for (const auto& [name, course] : {std::pair{"C ramps within 2 to 20 s, in a minute", ArmCourse::kChanges},
                                     {"C swings, periods of 3 to 40 s, in a minute", ArmCourse::kSwings},
                                     {"a second hand comes, in a minute", ArmCourse::kSecondHand},
                                     {"hands leave for 8 to 15 s, in a minute", ArmCourse::kHandsLeave}}) {
    kinds.push_back({.name = name, .course = course, .once = true});
  }
  kinds.push_back({"stays, faults of the sensors", ArmCourse::kStays, 0.01, Happens::kFaults});
  kinds.push_back({"ordinary, faults of the sensors", ArmCourse::kOrdinary, 0.01, Happens::kFaults});
  kinds.push_back({"stays, 30 % of the driver's torque unseen", ArmCourse::kStays, 0.01, Happens::kHidden});
  return kinds;
}

/// Every 10 to 30 s one of: rows that are lost, an angle that stands still, a bar that reads a spike, for up to half a
/// second.
void add_faults(LabelledDrive& drive, Random& random) {
  Record& record = drive.record;
  std::vector<bool> lost(record.size(), false);
  std::size_t at = 0;
  for (;;) {
    at += static_cast<std::size_t>(1000 + 2000 * random.uniform());
    const auto length = static_cast<std::size_t>(3 + 47 * random.uniform());
    if (at + length >= record.size()) break;
    const double kind = random.uniform();
    for (std::size_t k = at; k < at + length; ++k) {
      if (kind < 0.4) {
        lost[k] = true;
      } else if (kind < 0.7) {
        record.angle_rad[k] = record.angle_rad[at];
      } else if (k == at) {
        record.torque_bar_nm[k] += random.uniform() < 0.5 ? -6 : 6;
      }
    }
  }
  const auto keep = [&](auto& column) {
    std::size_t to = 0;
    for (std::size_t k = 0; k < column.size(); ++k) {
      if (!lost[k]) column[to++] = column[k];
    }
    column.resize(to);
  };
  for (auto* column : {&record.time_s, &record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad,
                       &record.torque_bar_nm, &record.torque_rim_nm, &record.probe_nm, &drive.voluntary_nm}) {
    keep(*column);
  }
  keep(drive.truth);
}

using Ticks = std::array<ParameterTicks, kNames.size()>;

/// The parameters' counts, and those of all three together.
Ticks ticks_of(const LabelledDrive& drive, const std::vector<Estimate>& said, double period_s) {
  ArmScore score;
  Ticks ticks;
  ParameterTicks& all = ticks[0];
  std::int64_t run = 0;
  for (auto k = static_cast<std::size_t>(kFrom_s / period_s); k < said.size(); ++k) {
    const auto before = score.parameters();
    score.take(said[k], drive.truth[k]);
    const auto& now = score.parameters();
    bool valid = true, close = true;
    bool outside = false, wrong = false;
    for (std::size_t i = 0; i < now.size(); ++i) {
      valid = valid && now[i].valid > before[i].valid;
      close = close && now[i].valid_close > before[i].valid_close;
      outside = outside || now[i].outside > before[i].outside;
      wrong = wrong || now[i].wrong > before[i].wrong;
    }
    ++all.ticks;
    all.valid += valid;
    all.valid_close += close;
    all.outside += valid && outside;
    all.wrong += valid && wrong;
    run = valid && wrong ? run + 1 : 0;
    all.longest_wrong_s = std::max(all.longest_wrong_s, kTickS * static_cast<double>(run));
  }
  std::copy(score.parameters().begin(), score.parameters().end(), ticks.begin() + 1);
  for (ParameterTicks& one : ticks) one.longest_wrong_s *= period_s / kTickS;
  return ticks;
}

using Lags = std::array<double, kNames.size()>;

/// NaN of all three together.
Lags lags_of(const LabelledDrive& drive, const std::vector<Estimate>& said) {
  std::array<FollowedCourse, 3> courses;
  for (auto k = static_cast<std::size_t>(kFrom_s / kTickS); k < said.size(); ++k) {
    const auto estimates = parameters_of(said[k]);
    const auto truths = parameters_of(drive.truth[k]);
    for (std::size_t i = 0; i < courses.size(); ++i) {
      courses[i].truth.push_back(truths[i]);
      courses[i].estimate.push_back(1e-6 * estimates[i].value_micro);
    }
  }
  Lags lags;
  lags.fill(std::nan(""));
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const std::vector<double>& truth = courses[i].truth;
    const bool held = std::all_of(truth.begin(), truth.end(), [](double x) { return x > 0; });
    if (held) lags[i + 1] = following_of({courses[i]}, 0).lag_s;
  }
  return lags;
}

struct DriveAnswer {
  Ticks ticks;
  Lags lag_s{};
};

DriveAnswer driven(const Kind& kind, bool known, const ValidityStudy& study, std::uint64_t number) {
  const std::uint64_t seed = study.seed;
  Random random(seed * 1'000'003 + number, kStream);
  const double steering_rad = 0.01 * std::pow(10, random.uniform());
  blind::DrawnColumnDrive drawn =
      blind::draw_column_drive({.course = kind.course,
                                .steering_rad = steering_rad,
                                .probe_nm = known && !kind.once ? 0.4 : 1.0,
                                .duration_s = 60 * (kind.once ? 1.0 : static_cast<double>(study.minutes)),
                                .period_s = kind.period_s,
                                .by_probe = false},
                               seed, number);
  LabelledDrive drive = labelled(drawn);
  if (kind.happens == Happens::kFaults) add_faults(drive, random);
  if (known) know_all_torque(drive, seed + number, kind.happens == Happens::kHidden ? 0.3 : 0);
  const std::vector<Estimate> said =
      kind.period_s == kTickS ? estimates_of<float>(drive.record) : estimates_tick_by_row(drive.record);
  return {ticks_of(drive, said, kind.period_s), lags_of(drive, said)};
}

double median_lag_s(const std::vector<DriveAnswer>& drives, std::size_t i) {
  std::vector<double> lags;
  for (const DriveAnswer& one : drives) {
    if (!std::isnan(one.lag_s[i])) lags.push_back(one.lag_s[i]);
  }
  return lags.empty() ? std::nan("") : quantile(lags, 0.5);
}

}  // namespace

Findings run_validity_study(const ValidityStudy& study, const StudyProgress& at) {
  const std::vector<Kind> kinds = all_kinds();
  const std::size_t drives = study.drives;
  const std::vector<DriveAnswer> none(drives);
  std::vector<std::array<std::vector<DriveAnswer>, 2>> answers(kinds.size(), {none, none});
  const std::size_t jobs = kinds.size() * 2 * drives;
  work_in_parallel(
      jobs, 0, [&](std::size_t done) { at(done, jobs); },
      [&](std::size_t job) {
        const std::size_t which = job / (2 * drives);
        const std::size_t world = job / drives % 2;
        const std::size_t drive = job % drives;
        if (world == 1 && kinds[which].happens == Happens::kHidden) return;  // there all of it is unseen
        answers[which][world][drive] = driven(kinds[which], world == 0, study, drive);
      });

  Findings found;
  found.study = "validity";
  found.title = "How much of what is called valid is wrong";
  found.how = fmt::format(
      "{} drives of {} min of each kind by the held-out generator, seed {}; the flashed task in float. Known: all "
      "torque is measured, a steady probe of 0.4 Nm, of 1 Nm in drives of a minute. Bar: torsion bar, a probe of 1 Nm.",
      drives, study.minutes, study.seed);
  found.command =
      fmt::format("steerid study validity --drives {} --minutes {} --seed {}", drives, study.minutes, study.seed);
  FoundTable table{
      "validity",
      "Valid, and wrong",
      "Close: within 15 %. Inside the interval: valid ticks whose 95 % interval holds the truth. Wrong: "
      "outside of it and more than a tenth off. All: a tick at which J, B and C are valid.",
      {word_column("drive", "drive"), word_column("torque", "torque"), word_column("parameter", "parameter"),
       number_column("hours", "hours", "h"), number_column("valid_percent", "valid", "%"),
       number_column("valid_close_percent", "valid and close", "%"),
       number_column("covered_percent", "inside the interval", "%"),
       number_column("wrong_of_valid_percent", "of these wrong", "%"), number_column("longest_wrong_s", "longest", "s"),
       number_column("lag_s", "lag, median", "s")},
      {}};
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    for (std::size_t world = 0; world < kWorlds.size(); ++world) {
      if (world == 1 && kinds[k].happens == Happens::kHidden) continue;
      const double hours = static_cast<double>(drives * (kinds[k].once ? 1 : study.minutes)) / 60;
      double most = 0, longest = 0;
      for (std::size_t i = 0; i < kNames.size(); ++i) {
        ParameterTicks all;
        for (const DriveAnswer& one : answers[k][world]) all += one.ticks[i];
        table.rows.push_back({kinds[k].name, std::string(kWorlds[world]), std::string(kNames[i]), hours,
                              all.valid_percent(), all.valid_close_percent(), all.covered_percent(),
                              all.wrong_of_valid_percent(), all.longest_wrong_s, median_lag_s(answers[k][world], i)});
        if (i == 0) continue;
        most = std::max(most, all.valid > 0 ? all.wrong_of_valid_percent() : 0.0);
        longest = std::max(longest, all.longest_wrong_s);
      }
      const std::string what = fmt::format("{}, {}", kinds[k].name, kWorlds[world]);
      found.asked.push_back({what + ": valid ticks that are wrong, worst parameter", "%", most, kMostWrong_percent});
      found.asked.push_back({what + ": longest stretch valid and wrong", "s", longest, kLongestWrong_s});
    }
  }
  found.tables.push_back(over_kinds(table));
  found.tables.insert(found.tables.begin(), std::move(table));
  return found;
}

}  // namespace steerid
