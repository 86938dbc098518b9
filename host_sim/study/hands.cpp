// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/hands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "parallel/work_in_parallel.hpp"
#include "study/hands_drive.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

struct Answers {
  std::vector<ToldRelease> drawn, held_out;
  std::vector<HeldWheel> held;
  std::vector<double> braced, braced_without_friction;

  /// In s, of one detector and one time for which it must have said so.
  [[nodiscard]] static std::vector<double> times(const std::vector<ToldRelease>& of, std::size_t d, std::size_t h) {
    std::vector<double> all;
    for (const ToldRelease& one : of) all.push_back(one.told_after_s[d][h]);
    return all;
  }
  /// False alarms an hour on those of the held wheels that `are` so, by their numbers; each counts from its settling
  /// on.
  template <class Are>
  [[nodiscard]] double per_hour_where(std::size_t d, std::size_t h, Are are) const {
    double alarms = 0;
    double seconds = 0;
    for (std::size_t number = 0; number < held.size(); ++number) {
      if (!are(number)) continue;
      alarms += held[number].alarms[d][h];
      seconds += kHandsDrive_s - kHandsSettling_s;
    }
    return 3600 * alarms / seconds;
  }
  [[nodiscard]] double per_hour(std::size_t d, std::size_t h) const {
    return per_hour_where(d, h, [](std::size_t) { return true; });
  }
  /// Share of the time in which a held wheel is told to be let go.
  [[nodiscard]] double alarmed_percent(std::size_t d, std::size_t h) const {
    double seconds = 0;
    for (const HeldWheel& one : held) seconds += one.alarmed_s[d][h];
    return 100 * seconds / (static_cast<double>(held.size()) * (kHandsDrive_s - kHandsSettling_s));
  }
};

double later_than_allowed_percent(const std::vector<double>& times) {
  const auto late = std::count_if(times.begin(), times.end(), [](double s) { return !(s <= kHandsOff_s); });
  return 100 * static_cast<double>(late) / static_cast<double>(times.size());
}

FoundTable hands_table(const Answers& answers) {
  FoundTable table{
      "hands",
      "Hands off: how soon it is told, and how often of a wheel that is held",
      "Told: once the detector has said so for the time named. A dash: not within 15 s. In false alarm: share of "
      "the time with hands on the wheel; a detector that always says so has one alarm a drive, 72 an hour.",
      {word_column("detector", "detector"), word_column("for", "said for"),
       number_column("median_s", "told after, median", "s"), number_column("p99_s", "99 % below", "s"),
       number_column("missed_percent", "not within 15 s", "%"),
       number_column("held_out_median_s", "held out, median", "s"),
       number_column("held_out_missed_percent", "held out, not within 15 s", "%"),
       number_column("false_smooth_per_h", "false alarms, smooth road", "1/h"),
       number_column("false_rough_per_h", "false alarms, rough road", "1/h"),
       number_column("false_arm_per_h", "false alarms, an arm", "1/h"),
       number_column("false_fingers_per_h", "false alarms, two fingers", "1/h"),
       number_column("false_time_percent", "in false alarm", "%")},
      {}};
  for (std::size_t d = 0; d < kHandsDetectors; ++d) {
    for (std::size_t h = 0; h < kSaidFor_s.size(); ++h) {
      const std::vector<double> drawn = Answers::times(answers.drawn, d, h);
      const std::vector<double> other = Answers::times(answers.held_out, d, h);
      const auto per_hour = [&](auto are) { return answers.per_hour_where(d, h, are); };
      table.rows.push_back({hands_detector_name(d), fmt::format("{:g} s", kSaidFor_s[h]), quantile(drawn, 0.5),
                            quantile(drawn, 0.99), later_than_allowed_percent(drawn), quantile(other, 0.5),
                            later_than_allowed_percent(other),
                            per_hour([](std::size_t n) { return !on_rough_road(n); }), per_hour(on_rough_road),
                            per_hour([](std::size_t n) { return !by_two_fingers(n); }), per_hour(by_two_fingers),
                            answers.alarmed_percent(d, h)});
    }
  }
  return table;
}

FoundTable braced_table(const Answers& answers) {
  FoundTable table{"braced",
                   "A relaxed arm braces threefold within a second: until `braced` is told",
                   "Missed: not within 15 s. A dash: not told in the rest of the drive.",
                   {word_column("arm", "arm"), number_column("median_s", "median", "s"),
                    number_column("p90_s", "90 % below", "s"), number_column("missed_percent", "missed", "%")},
                   {}};
  const auto state = [&](const std::string& arm, const std::vector<double>& times) {
    table.rows.push_back({arm, quantile(times, 0.5), quantile(times, 0.9), later_than_allowed_percent(times)});
  };
  const auto split = [&](const std::string& arm, const std::vector<double>& times) {
    std::vector<double> smooth;
    std::vector<double> rough;
    for (std::size_t number = 0; number < times.size(); ++number) {
      (on_rough_road(number) ? rough : smooth).push_back(times[number]);
    }
    state(arm, times);
    state(arm + ", smooth road", smooth);
    state(arm + ", rough road", rough);
  };
  split("relaxed, then braced", answers.braced);
  split("the same, rack without friction", answers.braced_without_friction);
  return table;
}

/// What the task says of a wheel by who holds it.
FoundTable states_table(const Answers& answers) {
  constexpr std::array kInOrder = {DriverState::kHandsOff, DriverState::kRelaxed, DriverState::kBraced,
                                   DriverState::kUnknown};
  FoundTable table{"states",
                   "What is told of a wheel that is held by an arm, by two fingers, by nobody",
                   "Share of the ticks. Nobody: from 6 s after the hands have left until they are back.",
                   {word_column("holds", "who holds it")},
                   {}};
  for (const DriverState state : kInOrder) {
    table.columns.push_back(number_column((std::string(name(state)) + "_percent").c_str(), name(state), "%"));
  }
  const auto add = [&](const char* who, const auto& drives, auto are) {
    StateTicks ticks{};
    double all = 0;
    for (std::size_t k = 0; k < drives.size(); ++k) {
      for (std::size_t i = 0; are(k) && i < ticks.size(); ++i) {
        ticks[i] += drives[k].ticks[i];
        all += static_cast<double>(drives[k].ticks[i]);
      }
    }
    std::vector<report::Cell> row = {std::string(who)};
    for (const DriverState state : kInOrder) {
      row.emplace_back(100 * static_cast<double>(ticks[static_cast<std::size_t>(state)]) / all);
    }
    table.rows.push_back(std::move(row));
  };
  add("an arm", answers.held, [](std::size_t n) { return !by_two_fingers(n); });
  add("two fingers", answers.held, by_two_fingers);
  add("nobody", answers.drawn, [](std::size_t) { return true; });
  add("nobody, held out", answers.held_out, [](std::size_t) { return true; });
  return table;
}

/// One trade-off: the time within which a share of the releases is told, against what it costs on a held wheel.
struct TradeOff {
  double share;
  const char* share_named;
  double asked_s;
  report::Axis cost;
  double least;  ///< drawn for no cost at all
  double (Answers::*cost_of)(std::size_t detector, std::size_t said_for) const;
};

/// A point for each time of kSaidFor_s.
report::LineChart curve(const Answers& answers, const TradeOff& what) {
  report::LineChart chart;
  chart.title = fmt::format("Hands off told, {}, against {}", what.share_named, what.cost.label);
  chart.caption = fmt::format(
      "A point for each time that a detector must have said so, 0 to 12 s; both roads. At {:g} s: not told while the "
      "hands are off. None at all is drawn at {:g} {}.",
      kHandsOff_s, what.least, what.cost.unit);
  chart.x = {.label = fmt::format("told after the release, {}", what.share_named), .unit = "s"};
  chart.y = what.cost;
  chart.marks = {{.at = what.asked_s, .label = "asked"}};
  constexpr std::array kMeaning = {report::Meaning::kModel, report::Meaning::kInertia, report::Meaning::kDamping,
                                   report::Meaning::kStiffness, report::Meaning::kReference};
  for (std::size_t d = 0; d < kHandsDetectors; ++d) {
    report::Series series{.name = hands_detector_name(d), .meaning = kMeaning[d]};
    for (std::size_t h = 0; h < kSaidFor_s.size(); ++h) {
      const double told_s = std::min(quantile(Answers::times(answers.drawn, d, h), what.share), kHandsOff_s);
      const double cost = std::max((answers.*what.cost_of)(d, h), what.least);
      if (series.x.empty() || told_s > series.x.back()) {
        series.x.push_back(told_s);
        series.y.push_back(cost);
      } else {  // as soon, or both never: what costs less
        series.y.back() = std::min(series.y.back(), cost);
      }
    }
    if (series.x.size() == 1) series.drawn = report::Drawn::kPoints;
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::vector<report::LineChart> curves(const Answers& answers, double hours) {
  const report::Axis alarms{.label = "false alarms", .unit = "1/h", .log = true};
  const report::Axis time{.label = "time in false alarm", .unit = "%", .log = true};
  return {curve(answers, {0.5, "median", 1.5, alarms, 0.5 / hours, &Answers::per_hour}),
          curve(answers, {0.99, "99 %", 6, alarms, 0.5 / hours, &Answers::per_hour}),
          curve(answers, {0.5, "median", 1.5, time, 1e-4, &Answers::alarmed_percent})};
}

}  // namespace

Findings run_hands_study(const HandsStudy& study, const StudyProgress& at) {
  const std::size_t n = study.drives;
  const std::size_t held = study.hours * 72;  // drives of 50 s after settling, in an hour
  Answers answers;
  answers.drawn.resize(n);
  answers.held_out.resize(n);
  answers.braced.resize(n);
  answers.braced_without_friction.resize(n);
  answers.held.resize(held);
  constexpr std::size_t kKinds = 4;  // of drives of which there are n
  const std::size_t jobs = kKinds * n + held;
  work_in_parallel(
      jobs, 0, [&](std::size_t done) { at(done, jobs); },
      [&](std::size_t job) {
        const std::size_t number = job < kKinds * n ? job / kKinds : job - kKinds * n;
        if (job >= kKinds * n) {
          answers.held[number] = held_wheel(study.seed, number);
        } else if (job % kKinds == 0) {
          answers.drawn[number] = drawn_release(study.seed, number);
        } else if (job % kKinds == 1) {
          answers.held_out[number] = held_out_release(study.seed, number);
        } else if (job % kKinds == 2) {
          answers.braced[number] = braced_after_s(study.seed, number);
        } else {
          answers.braced_without_friction[number] = braced_after_s(study.seed, number, Rack::kWithoutFriction);
        }
      });

  Findings found;
  found.study = "hands";
  found.title = "Hands off a whole column, beside a threshold on the torsion bar";
  found.how = fmt::format(
      "{} releases, {} held-out releases, {} arms that brace and {} h of held wheels, half of them on rough roads, "
      "half held by two fingers; probe of {:g} Nm rms, seed {}; the flashed task in float.",
      n, n, n, study.hours, kHandsProbe_nm, study.seed);
  found.command = fmt::format("steerid study hands --drives {} --hours {} --seed {}", n, study.hours, study.seed);
  found.tables = {hands_table(answers), braced_table(answers), states_table(answers)};
  const std::vector<double> steerid = Answers::times(answers.drawn, 0, 0);
  const auto hours = static_cast<double>(study.hours);
  found.asked = {{"hands off told after, median", "s", quantile(steerid, 0.5), 1.5},
                 {"hands off told after, 99 %", "s", quantile(steerid, 0.99), 6},
                 {fmt::format("false alarms in {} h", study.hours), "", answers.per_hour(0, 0) * hours, 0},
                 {"relaxed to braced, missed", "%", later_than_allowed_percent(answers.braced), 2}};
  found.lines = curves(answers, hours);
  return found;
}

}  // namespace steerid
