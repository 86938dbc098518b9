// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/tracking.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "parallel/work_in_parallel.hpp"
#include "study/arm_changes.hpp"
#include "study/manoeuvres.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

using Drive = VirtualDrive<double>;

constexpr WheelArm kArm{0.11, 1.5, 22.7};
constexpr WheelArm kBraced{0.11, 3.0, 68.1};
constexpr WheelArm kWheelAlone{0.018, 0.08, 1.0};
constexpr WheelArm kOneHand{0.11, 0.7, 17.0};
constexpr double kProbe_nm = 1.5;
constexpr double kCurve_nm = 5;
constexpr double kSmallProbe_nm = 0.5;
constexpr double kWithin = 0.15;

/// Some of `rms_nm` that no sensor sees, beside `acts`.
Manoeuvre with_unmeasured(Manoeuvre acts, int percent, double rms_nm, std::uint64_t seed) {
  return percent > 0 ? together(std::move(acts), unmeasured(0.01 * percent * rms_nm, seed)) : acts;
}

std::string unmeasured_name(int percent) { return percent > 0 ? fmt::format("{} %", percent) : "none"; }

struct Drift {
  std::array<double, 3> percent{};
};

Drift keeps(bool on_a_curve, int percent, std::uint64_t seed) {
  Drive wheel(kArm, seed);
  wheel.run(with_unmeasured(probe(seed, kProbe_nm), percent, kProbe_nm, seed), 20);
  std::array<double, 3> start{};
  for (int i = 0; i < 3; ++i) start[static_cast<std::size_t>(i)] = wheel.value(i);
  Drift most;
  const Manoeuvre rest = on_a_curve ? curve(kCurve_nm, 0.3, seed) : straight_road();
  wheel.run(with_unmeasured(rest, percent, kCurve_nm, seed + 1), 120, [&](const Sample&) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double off = std::abs(wheel.value(static_cast<int>(i)) / start[i] - 1);
      most.percent[i] = std::max(most.percent[i], 100 * off);
    }
  });
  return most;
}

/// Seconds until J, B and C are within 15 % to stay; as long as the drive when they never are.
double follows(int percent, std::uint64_t seed, std::size_t number) {
  Drive wheel(kArm, seed);
  const Manoeuvre torques = with_unmeasured(probe(seed, kProbe_nm), percent, kProbe_nm, seed);
  wheel.run(torques, 20 + 0.37 * static_cast<double>(number % 27));  // 27 phases of the probe's 10 s
  wheel.wheel().become(kBraced);
  const double from = wheel.seconds();
  double last = from;
  wheel.run(torques, 10, [&](const Sample&) {
    for (int i = 0; i < 3; ++i) {
      if (std::abs(wheel.relative_error(i)) > kWithin) last = wheel.seconds();
    }
  });
  return last - from;
}

/// Half a minute to a minute each of what a driver does, in random order; how often the detector rang in an hour.
double rings(int percent, std::uint64_t seed) {
  constexpr double kHour_s = 3600;
  const double steering_nm = SteeringDriver({}, kArm, 1, kDriverStream).nominal_rms_nm();
  Random random(seed, kMixedStream);
  Drive wheel(kArm, seed);
  for (std::uint64_t leg = seed * 1000; wheel.seconds() < kHour_s; ++leg) {
    const double seconds = std::min(30 + 30 * random.uniform(), kHour_s - wheel.seconds());
    switch (static_cast<int>(5 * random.uniform())) {
      case 0:
        wheel.run(with_unmeasured(probe(leg, kProbe_nm), percent, kProbe_nm, leg), seconds);
        break;
      case 1:
        wheel.run(with_unmeasured(curve(kCurve_nm, 0.5, leg), percent, kCurve_nm, leg), seconds);
        break;
      case 2:
        wheel.run(with_unmeasured(steering(kArm, leg), percent, steering_nm, leg), seconds);
        break;
      case 3:
        wheel.run(with_unmeasured(holding(leg), percent, kProbe_nm, leg), seconds);
        break;
      default:
        wheel.run(with_unmeasured(straight_road(), percent, kProbe_nm, leg), seconds);
        break;
    }
  }
  return wheel.identifier().steady().changes();
}

struct Return {
  double off_s = 0;         ///< until C is within 15 % to stay
  double misleading_s = 0;  ///< of that, called valid beyond 15 % and three deviations
};

Return returns(int percent, std::uint64_t seed) {
  Drive wheel(kWheelAlone, seed);
  const Manoeuvre torques =
      with_unmeasured(together(probe(seed, kSmallProbe_nm), holding(seed)), percent, kSmallProbe_nm, seed);
  const Manoeuvre alone = probe(seed, kSmallProbe_nm);
  wheel.run(alone, 20);
  wheel.wheel().become(kOneHand);
  const double from = wheel.seconds();
  Return result;
  wheel.run(torques, 30, [&](const Sample&) {
    if (std::abs(wheel.relative_error(kStiffness)) <= kWithin) return;
    result.off_s = wheel.seconds() - from;
    const bool valid = wheel.identifier().belief(kStiffness) == Belief::kValid;
    const double error = std::abs(wheel.value(kStiffness) - kOneHand.stiffness_nm_per_rad);
    if (valid && error > 3 * wheel.deviation(kStiffness)) result.misleading_s += kTickS;
  });
  return result;
}

/// The rate at which so few, or so many, events would still be seen once in forty times: the exact Poisson limits.
double poisson_limit(double events, bool upper) {
  const double tail = 0.025;
  double low = 0, high = 10 + 3 * events;
  for (int i = 0; i < 100; ++i) {
    const double rate = (low + high) / 2;
    double below = 0;  // P(at most `last` events)
    double term = std::exp(-rate);
    const double last = upper ? events : events - 1;
    for (double k = 0; k <= last; k += 1) {
      below += term;
      term *= rate / (k + 1);
    }
    ((upper ? below > tail : 1 - below < tail) ? low : high) = rate;
  }
  return (low + high) / 2;
}

// ---- tables ----

void add_keeping(Findings& found, const char* rest, int percent, const std::vector<Drift>& drifts) {
  constexpr const char* kSymbols[] = {"J", "B", "C"};
  constexpr double kAsked[] = {1, 1, 5};
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> values;
    for (const Drift& drift : drifts) values.push_back(drift.percent[i]);
    const double worst = quantile(values, 1);
    found.tables[0].rows.push_back({std::string(rest), unmeasured_name(percent), std::string(kSymbols[i]),
                                    quantile(values, 0.5), quantile(values, 0.9), worst});
    found.asked.push_back({fmt::format("drift of {} over 120 s of {}, worst drive, unmeasured torque {}", kSymbols[i],
                                       rest, unmeasured_name(percent)),
                           "%", worst, kAsked[i]});
  }
}

void add_following(Findings& found, int percent, const std::vector<double>& seconds) {
  const double worst = quantile(seconds, 1);
  found.tables[1].rows.push_back({unmeasured_name(percent), quantile(seconds, 0.5), quantile(seconds, 0.9), worst});
  found.asked.push_back(
      {fmt::format("B x2 and C x3 back within 15 %, slowest drive, unmeasured torque {}", unmeasured_name(percent)),
       "s", worst, 1.5});
}

void add_resets(Findings& found, int percent, const std::vector<double>& rang) {
  double events = 0;
  for (const double one : rang) events += one;
  const auto hours = static_cast<double>(rang.size());
  const report::Ends rate{events > 0 ? poisson_limit(events, false) / hours : 0.0, poisson_limit(events, true) / hours};
  found.tables[2].rows.push_back({unmeasured_name(percent), hours, events, events / hours, rate.low, rate.high});
  found.asked.push_back({.what = fmt::format("false resets, unmeasured torque {}", unmeasured_name(percent)),
                         .unit = "1/h",
                         .measured = events / hours,
                         .asked = 1,
                         .ci95 = rate});
}

void add_returning(Findings& found, int percent, const std::vector<Return>& drives) {
  std::vector<double> off, misleading;
  for (const Return& drive : drives) {
    off.push_back(drive.off_s);
    misleading.push_back(drive.misleading_s);
  }
  found.tables[3].rows.push_back({unmeasured_name(percent), quantile(off, 0.5), quantile(off, 0.9), quantile(off, 1),
                                  quantile(misleading, 0.5), quantile(misleading, 0.9), quantile(misleading, 1)});
}

std::vector<FoundTable> empty_tables() {
  return {{"keeping",
           "Farthest drift over 120 s that show nothing, after 20 s of probe",
           "Over the drives.",
           {word_column("rest", "rest"), word_column("unmeasured", "unmeasured"), word_column("parameter", "parameter"),
            number_column("median_percent", "median", "%"), number_column("p90_percent", "90 % below", "%"),
            number_column("worst_percent", "worst", "%")},
           {}},
          {"following",
           "B doubled and C tripled under a probe: seconds until all three are within 15 % to stay",
           "Over the drives.",
           {word_column("unmeasured", "unmeasured"), number_column("median_s", "median", "s"),
            number_column("p90_s", "90 % below", "s"), number_column("worst_s", "slowest", "s")},
           {}},
          {"resets",
           "Mixed driving with one arm: how often it is taken for another one",
           "Interval: 95 %, of the rate.",
           {word_column("unmeasured", "unmeasured"), number_column("hours", "hours", "h"),
            number_column("resets", "resets", ""), number_column("per_hour", "rate", "1/h"),
            number_column("per_hour_low", "low", "1/h"), number_column("per_hour_high", "high", "1/h")},
           {}},
          {"returning",
           "A hand comes back to a wheel that was alone: C from 1 to 17 Nm/rad",
           "Off: until C is within 15 % to stay. Misleading: C called valid, beyond 15 % and three deviations.",
           {word_column("unmeasured", "unmeasured"), number_column("off_median_s", "off, median", "s"),
            number_column("off_p90_s", "90 % below", "s"), number_column("off_worst_s", "slowest", "s"),
            number_column("misleading_median_s", "misleading, median", "s"),
            number_column("misleading_p90_s", "90 % below", "s"), number_column("misleading_worst_s", "worst", "s")},
           {}}};
}

report::Bars drift_chart(const FoundTable& keeping) {
  report::Bars bars;
  bars.title = "Worst drift over 120 s that show nothing";
  bars.value = {.label = "drift", .unit = "%", .log = true};
  report::BarSeries worst{.name = "worst drive", .meaning = report::Meaning::kModel};
  report::BarSeries median{.name = "median", .meaning = report::Meaning::kReference};
  for (const auto& row : keeping.rows) {
    bars.categories.push_back(std::get<std::string>(row[2]) + ", " + std::get<std::string>(row[0]) + ", unmeasured " +
                              std::get<std::string>(row[1]));
    median.values.push_back(std::get<double>(row[3]));
    worst.values.push_back(std::get<double>(row[5]));
  }
  bars.series = {median, worst};
  bars.marks.push_back({.at = 1, .label = "asked of J and B"});
  return bars;
}

constexpr std::array kPercent = {0, 2};  // of unmeasured torque
constexpr std::array kPercentMixed = {0, 2, 10};

}  // namespace

Findings run_tracking_study(const TrackingStudy& study, const StudyProgress& at) {
  const std::size_t n = study.drives;
  const std::uint64_t first = study.seed * 1'000'003;
  struct OfPercent {
    std::vector<Drift> curve, quiet;
    std::vector<double> following;
    std::vector<Return> returning;
  };
  std::vector<OfPercent> of(
      kPercent.size(), {std::vector<Drift>(n), std::vector<Drift>(n), std::vector<double>(n), std::vector<Return>(n)});
  std::vector<std::vector<double>> rang(kPercentMixed.size(), std::vector<double>(study.hours));
  const std::size_t hours = kPercentMixed.size() * study.hours;
  const std::size_t jobs = hours + kPercent.size() * n;
  const ArmChangesStudy changes{
      .drives = study.changes, .seed = study.seed, .angle_offset_rad = study.angle_offset_rad};
  const std::size_t all_jobs = jobs + arm_change_jobs(changes);
  work_in_parallel(
      jobs, 0, [&](std::size_t done) { at(done, all_jobs); },
      [&](std::size_t job) {
        if (job < hours) {
          const std::size_t which = job / study.hours;
          rang[which][job % study.hours] = rings(kPercentMixed[which], first + job % study.hours);
          return;
        }
        const std::size_t which = (job - hours) / n;
        const std::size_t number = (job - hours) % n;
        const std::uint64_t seed = first + number;
        OfPercent& one = of[which];
        one.curve[number] = keeps(true, kPercent[which], seed);
        one.quiet[number] = keeps(false, kPercent[which], seed);
        one.following[number] = follows(kPercent[which], seed, number);
        one.returning[number] = returns(kPercent[which], seed);
      });

  Findings found;
  found.study = "tracking";
  found.title = "Drift while unexcited, tracking after a change, false resets";
  found.how = fmt::format(
      "{} drives a case and {} hours of mixed driving for each share of unmeasured torque, seed {}; J {} kg m2, B {} "
      "Nms/rad, C {} Nm/rad unless said otherwise.",
      n, study.hours, study.seed, kArm.inertia_kgm2, kArm.damping_nms_per_rad, kArm.stiffness_nm_per_rad);
  found.command = fmt::format(
      "steerid study tracking --drives {} --hours {} --changes {}{} --seed {}", n, study.hours, study.changes,
      study.angle_offset_rad == 0 ? "" : fmt::format(" --angle-offset {}", study.angle_offset_rad), study.seed);
  found.tables = empty_tables();
  for (std::size_t k = 0; k < kPercent.size(); ++k) {
    add_keeping(found, "curve", kPercent[k], of[k].curve);
    add_keeping(found, "rest", kPercent[k], of[k].quiet);
    add_following(found, kPercent[k], of[k].following);
    add_returning(found, kPercent[k], of[k].returning);
  }
  for (std::size_t k = 0; k < kPercentMixed.size(); ++k) add_resets(found, kPercentMixed[k], rang[k]);
  found.charts.push_back(drift_chart(found.tables[0]));
  if (study.changes > 0)
    add_arm_changes(found, changes, [&](std::size_t done, std::size_t) { at(jobs + done, all_jobs); });
  return found;
}

}  // namespace steerid
