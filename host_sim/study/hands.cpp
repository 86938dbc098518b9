// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/hands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "parallel/work_in_parallel.hpp"
#include "sensors/random.hpp"
#include "study/labelled_drive.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

constexpr double kDrive_s = 60;
constexpr double kProbe_nm = 0.5;
constexpr double kFilter_hz = 1;
constexpr double kSameAlarm_s = 5;
constexpr double kGrace_s = 1;      // after the hands are back a detector may still say that they are not
constexpr double kSettling_s = 10;  // after the start
constexpr double kAllowed_s = 15;
constexpr std::array kThresholds_nm = {0.3, 0.5, 0.7, 1.0};
constexpr std::array kHolds_s = {0.0, 0.5, 1.0, 2.0, 4.0, 8.0, 12.0};
constexpr std::array<std::size_t, 3> kShownHolds = {1, 3, 5};  // of a threshold, in the table
constexpr std::size_t kDetectors = 1 + kThresholds_nm.size();  // the task first
constexpr std::uint64_t kHandsStream = 310;

std::string detector_name(std::size_t detector) {
  return detector == 0 ? "steerid" : fmt::format("bar below {:g} Nm", kThresholds_nm[detector - 1]);
}

// ---- drives ----

enum class Held : std::uint8_t { kRelease, kHolds, kBraces };

ColumnScenario scenario_of(Held held, std::uint64_t seed, std::uint64_t number) {
  ColumnScenario scenario = drawn_scenario({.probe_nm = kProbe_nm, .duration_s = kDrive_s}, seed, number);
  Random random(seed * 1'000'003 + number, kHandsStream);
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  Column& column = scenario.column;
  column.aligning_stiffness_nm_per_rad = between(2, 25);
  if (number % 2 == 1) {
    column.road_rms_nm = between(1, 2.5);
    column.road_corner_hz = 8;
  }
  DriveSettings& drive = scenario.drive;
  drive.steering_rad = std::min(drive.steering_rad, between(0.01, 0.1));
  if (held == Held::kRelease) drive.releases = {{.at_s = between(18, 25), .length_s = kAllowed_s}};
  if (held == Held::kHolds && number % 4 >= 2) {
    drive.arm = {column.wheel_inertia_kgm2 + between(0.003, 0.01),
                 column.wheel_damping_nms_per_rad + between(0.05, 0.2), between(0.8, 3)};
    drive.steering_rad = between(0.01, 0.1);
  }
  if (held == Held::kBraces) {
    drive.arm.stiffness_nm_per_rad = between(6, 11);
    drive.change = {.course = ArmCourse::kRamp,
                    .stiffness_nm_per_rad = 3 * drive.arm.stiffness_nm_per_rad,
                    .at_s = between(18, 25),
                    .length_s = 1};
  }
  return scenario;
}

/// For how long each detector has said so without a break, in ticks; row by row.
using Says = std::array<std::vector<std::int32_t>, kDetectors>;

Says says_of(const LabelledDrive& drive) {
  Says says;
  const std::vector<Estimate> estimates = estimates_of<float>(drive.record);
  const double share = 1 - std::exp(-2 * std::numbers::pi * kFilter_hz * kTickS);
  double filtered_nm = 0;
  for (std::size_t k = 0; k < drive.record.size(); ++k) {
    filtered_nm += share * (drive.record.torque_bar_nm[k] - filtered_nm);
    for (std::size_t d = 0; d < kDetectors; ++d) {
      const bool off =
          d == 0 ? estimates[k].driver == DriverState::kHandsOff : std::abs(filtered_nm) < kThresholds_nm[d - 1];
      says[d].push_back(off ? (k > 0 ? says[d][k - 1] : 0) + 1 : 0);
    }
  }
  return says;
}

bool told(const std::vector<std::int32_t>& says, std::size_t row, double hold_s) {
  return says[row] > 0 && says[row] * kTickS >= hold_s;
}

/// [detector][hold]
template <class T>
using OfEach = std::array<std::array<T, kHolds_s.size()>, kDetectors>;

/// Seconds from the release until it is told, infinite when never while the hands are off.
OfEach<double> detections(const LabelledDrive& drive) {
  const Says says = says_of(drive);
  const double usual = drive.truth.front().stiffness_nm_per_rad;
  std::size_t leaves = 0;
  while (leaves < drive.truth.size() && drive.truth[leaves].stiffness_nm_per_rad > 0.95 * usual) ++leaves;
  std::size_t off = leaves;
  while (off < drive.truth.size() && drive.truth[off].stiffness_nm_per_rad > 0.05 * usual) ++off;
  OfEach<double> found;
  for (std::size_t d = 0; d < kDetectors; ++d) {
    for (std::size_t h = 0; h < kHolds_s.size(); ++h) {
      found[d][h] = std::numeric_limits<double>::infinity();
      for (std::size_t k = off; k < drive.truth.size() && drive.truth[k].stiffness_nm_per_rad < 0.05 * usual; ++k) {
        if (!told(says[d], k, kHolds_s[h])) continue;
        found[d][h] = static_cast<double>(k - leaves) * kTickS;
        break;
      }
    }
  }
  return found;
}

/// How often a wheel that is held all through is told to be let go.
OfEach<int> false_alarms(const LabelledDrive& drive) {
  const Says says = says_of(drive);
  OfEach<int> alarms{};
  for (std::size_t d = 0; d < kDetectors; ++d) {
    for (std::size_t h = 0; h < kHolds_s.size(); ++h) {
      double quiet_s = kSameAlarm_s;
      for (auto k = static_cast<std::size_t>(std::llround(kSettling_s / kTickS)); k < says[d].size(); ++k) {
        const bool alarm = told(says[d], k, kHolds_s[h]);
        alarms[d][h] += alarm && quiet_s >= kSameAlarm_s;
        quiet_s = alarm ? 0 : quiet_s + kTickS;
      }
    }
  }
  return alarms;
}

/// Seconds from the beginning of bracing until `braced` is told; infinite when never.
double braced_after_s(const LabelledDrive& drive) {
  const std::vector<Estimate> estimates = estimates_of<float>(drive.record);
  const double usual = drive.truth.front().stiffness_nm_per_rad;
  std::size_t begins = 0;
  while (begins < drive.truth.size() && drive.truth[begins].stiffness_nm_per_rad <= usual) ++begins;
  for (std::size_t k = begins; k < estimates.size(); ++k) {
    if (estimates[k].driver == DriverState::kBraced) return static_cast<double>(k - begins) * kTickS;
  }
  return std::numeric_limits<double>::infinity();
}

// ---- figures ----

struct Answers {
  std::vector<OfEach<double>> release, held_out;
  std::vector<OfEach<int>> smooth, rough;
  std::vector<double> braced;

  [[nodiscard]] std::vector<double> times(const std::vector<OfEach<double>>& of, std::size_t d, std::size_t h) const {
    std::vector<double> all;
    for (const OfEach<double>& one : of) all.push_back(one[d][h]);
    return all;
  }
  /// Each drive counts from its settling on.
  [[nodiscard]] static double per_hour(const std::vector<OfEach<int>>& of, std::size_t d, std::size_t h) {
    double alarms = 0;
    for (const OfEach<int>& one : of) alarms += one[d][h];
    return 3600 * alarms / (static_cast<double>(of.size()) * (kDrive_s - kSettling_s));
  }
  [[nodiscard]] double per_hour(std::size_t d, std::size_t h) const {
    return (per_hour(smooth, d, h) + per_hour(rough, d, h)) / 2;
  }
};

double later_than_allowed_percent(const std::vector<double>& times) {
  const auto late = std::count_if(times.begin(), times.end(), [](double s) { return !(s <= kAllowed_s); });
  return 100 * static_cast<double>(late) / static_cast<double>(times.size());
}

FoundColumn number(const char* key, const char* label, const char* unit) {
  return {key, {.label = label, .unit = unit, .digits = 3}};
}

FoundTable hands_table(const Answers& answers) {
  FoundTable table{"hands",
                   "Hands off: how soon it is told, and how often of a wheel that is held",
                   "Told: once the detector has said so for the time named. A dash: not within 15 s.",
                   {{"detector", {.label = "detector", .numeric = false}},
                    {"for", {.label = "said for", .numeric = false}},
                    number("median_s", "told after, median", "s"),
                    number("p99_s", "99 % below", "s"),
                    number("missed_percent", "not within 15 s", "%"),
                    number("held_out_median_s", "held out, median", "s"),
                    number("held_out_missed_percent", "held out, not within 15 s", "%"),
                    number("false_smooth_per_h", "false alarms, smooth road", "1/h"),
                    number("false_rough_per_h", "false alarms, rough road", "1/h")},
                   {}};
  const auto add = [&](std::size_t d, std::size_t h) {
    const std::vector<double> drawn = answers.times(answers.release, d, h);
    const std::vector<double> other = answers.times(answers.held_out, d, h);
    table.rows.push_back({detector_name(d), fmt::format("{:g} s", kHolds_s[h]), quantile(drawn, 0.5),
                          quantile(drawn, 0.99), later_than_allowed_percent(drawn), quantile(other, 0.5),
                          later_than_allowed_percent(other), Answers::per_hour(answers.smooth, d, h),
                          Answers::per_hour(answers.rough, d, h)});
  };
  add(0, 0);
  for (std::size_t d = 1; d < kDetectors; ++d) {
    for (const std::size_t h : kShownHolds) add(d, h);
  }
  return table;
}

FoundTable braced_table(const Answers& answers) {
  FoundTable table{"braced",
                   "A relaxed arm braces threefold within a second: until `braced` is told",
                   "Missed: not within 15 s.",
                   {{"arm", {.label = "arm", .numeric = false}},
                    number("median_s", "median", "s"),
                    number("p90_s", "90 % below", "s"),
                    number("missed_percent", "missed", "%")},
                   {}};
  std::vector<report::Cell> row;
  row.emplace_back(std::string("relaxed, then braced"));
  row.emplace_back(quantile(answers.braced, 0.5));
  row.emplace_back(quantile(answers.braced, 0.9));
  row.emplace_back(later_than_allowed_percent(answers.braced));
  table.rows.push_back(std::move(row));
  return table;
}

report::LineChart curve(const Answers& answers, double hours) {
  report::LineChart chart;
  chart.title = "Hands off: what an earlier answer costs";
  chart.caption = fmt::format(
      "A point for each time that a detector must have said so, 0 to 12 s; both roads. No alarm at all is drawn at "
      "half "
      "an alarm in {:g} h.",
      hours);
  chart.x = {.label = "told after the release, median", .unit = "s"};
  chart.y = {.label = "false alarms", .unit = "1/h", .log = true};
  constexpr std::array kMeaning = {report::Meaning::kModel, report::Meaning::kInertia, report::Meaning::kDamping,
                                   report::Meaning::kStiffness, report::Meaning::kReference};
  for (std::size_t d = 0; d < kDetectors; ++d) {
    report::Series series{.name = detector_name(d), .meaning = kMeaning[d]};
    for (std::size_t h = 0; h < kHolds_s.size(); ++h) {
      const double median = quantile(answers.times(answers.release, d, h), 0.5);
      if (!std::isfinite(median) || (!series.x.empty() && median <= series.x.back())) continue;
      series.x.push_back(median);
      series.y.push_back(std::max(answers.per_hour(d, h), 0.5 / hours));
    }
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

Findings run_hands_study(const HandsStudy& study, const StudyProgress& at) {
  const std::size_t n = study.drives;
  const std::size_t held = study.hours * 72;  // drives of 50 s after settling, in an hour
  Answers answers;
  answers.release.resize(n);
  answers.held_out.resize(n);
  answers.braced.resize(n);
  std::vector<OfEach<int>> alarms(held);
  const std::size_t jobs = 3 * n + held;
  work_in_parallel(
      jobs, 0, [&](std::size_t done) { at(done, jobs); },
      [&](std::size_t job) {
        const std::size_t number = job < 3 * n ? job / 3 : job - 3 * n;
        const auto drawn = [&](Held what) {
          return drive_of(scenario_of(what, study.seed, number), Known::kBarAndProbe, Bound::kNone);
        };
        if (job >= 3 * n) {
          alarms[number] = false_alarms(drawn(Held::kHolds));
        } else if (job % 3 == 0) {
          answers.release[number] = detections(drawn(Held::kRelease));
        } else if (job % 3 == 1) {
          answers.held_out[number] = detections(held_out_drive(
              {.story = ArmStory::kHandsLeave, .steering_rad = 0.05, .probe_nm = kProbe_nm, .duration_s = kDrive_s},
              study.seed, number));
        } else {
          answers.braced[number] = braced_after_s(drawn(Held::kBraces));
        }
      });
  for (std::size_t k = 0; k < held; ++k) (k % 2 == 1 ? answers.rough : answers.smooth).push_back(alarms[k]);

  Findings found;
  found.study = "hands";
  found.title = "Hands off a whole column, beside a threshold on the torsion bar";
  found.how = fmt::format(
      "{} releases, {} held-out releases, {} arms that brace and {} h of held wheels, half of them on rough roads, "
      "half "
      "held by two fingers; probe of {:g} Nm rms, seed {}; the flashed task in float.",
      n, n, n, study.hours, kProbe_nm, study.seed);
  found.command = fmt::format("steerid study hands --drives {} --hours {} --seed {}", n, study.hours, study.seed);
  found.tables = {hands_table(answers), braced_table(answers)};
  const std::vector<double> steerid = answers.times(answers.release, 0, 0);
  found.asked = {{"hands off told after, median", "s", quantile(steerid, 0.5), 1.5},
                 {"hands off told after, 99 %", "s", quantile(steerid, 0.99), 6},
                 {fmt::format("false alarms in {} h", study.hours), "",
                  answers.per_hour(0, 0) * static_cast<double>(study.hours), 0},
                 {"relaxed to braced, missed", "%", later_than_allowed_percent(answers.braced), 2}};
  found.lines.push_back(curve(answers, static_cast<double>(study.hours)));
  return found;
}

}  // namespace steerid
