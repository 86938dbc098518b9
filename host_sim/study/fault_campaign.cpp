// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/fault_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "experiment/signal_point.hpp"
#include "parallel/work_in_parallel.hpp"
#include "sensors/random.hpp"
#include "study/fault_catalogue.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

constexpr WheelArm kArm{0.11, 1.5, 22.7};
constexpr double kVisible_s = 2;   ///< after the onset: from then on a fault may not mislead
constexpr double kWatched_s = 20;  ///< after the end
constexpr std::uint64_t kFaultStream = 995;
constexpr std::size_t kMixturesPerDrive = 10;

/// A parameter is valid and farther from the truth than three deviations and three percent: the probe's bias and what
/// chance makes at one of thousands of ticks are no error.
bool misleads(const ParameterEstimate& parameter, double truth) {
  if (parameter.state != ParameterState::kValid) return false;
  const double error = std::abs(parameter.value_micro * 1e-6 - truth);
  return error > 3 * (parameter.sd_micro * 1e-6 + 0.01 * truth);
}

bool misleads(const Outcome& o) {
  return misleads(o.estimate.inertia, kArm.inertia_kgm2) || misleads(o.estimate.damping, kArm.damping_nms_per_rad) ||
         misleads(o.estimate.stiffness, kArm.stiffness_nm_per_rad);
}

/// Within the identifier's limits (identifier/parameters.hpp), in the port's micro-units.
bool in_range(const ParameterEstimate& p, std::int32_t lowest, std::int32_t highest, std::int32_t spread) {
  return p.value_micro >= lowest && p.value_micro <= highest && p.sd_micro >= 0 && p.sd_micro <= spread &&
         p.state <= ParameterState::kNotExcited;
}

bool is_sound(const Outcome& o) {
  return o.finite && o.sound && in_range(o.estimate.inertia, 5'000, 600'000, 100'000) &&
         in_range(o.estimate.damping, 10'000, 15'000'000, 2'000'000) &&
         in_range(o.estimate.stiffness, 10'000, 300'000'000, 30'000'000) && !(o.valid && o.fault);
}

bool same(const InputCounters& a, const InputCounters& b) {
  return a.accepted_after_gap == b.accepted_after_gap && a.invalid_channel == b.invalid_channel &&
         a.out_of_range == b.out_of_range && a.spike == b.spike && a.stuck == b.stuck && a.repeated == b.repeated &&
         a.out_of_order == b.out_of_order;
}

/// What one fault did in one drive.
struct Account {
  std::optional<double> detected_s;
  double fault_s = 0;  ///< beyond kVisible_s after the onset
  double misled_s = 0;
  double recovery_s = 0;
  int unsound = 0;
  int not_finite = 0;
  bool counted = false;
  bool counters_off = false;
};

Account account(const Fault& fault, const FaultTime& when, std::uint64_t seed, double unmeasured_percent) {
  const FaultyDrive drive = faulty_drive(fault, when, when.end_s() + kWatched_s, seed, kArm, unmeasured_percent);
  const auto onset = static_cast<std::size_t>(std::ceil(when.onset_s / kTickS));
  const auto end = static_cast<std::size_t>(std::ceil(when.end_s() / kTickS));
  const auto visible = onset + static_cast<std::size_t>(kVisible_s / kTickS);
  Account sum;
  for (std::size_t k = 0; k < drive.outcomes.size(); ++k) {
    const Outcome& now = drive.outcomes[k];
    const bool misled = misleads(now);
    sum.unsound += is_sound(now) ? 0 : 1;
    sum.not_finite += now.finite ? 0 : 1;
    if (k >= onset && k < end && !now.valid && !sum.detected_s) {
      sum.detected_s = kTickS * static_cast<double>(k - onset);
    }
    if (k >= visible && k < end) {
      sum.fault_s += kTickS;
      sum.misled_s += misled ? kTickS : 0;
    }
    if (k >= end && (!now.valid || misled)) sum.recovery_s = kTickS * static_cast<double>(k - end + 1);
  }
  if (fault.counters) {
    sum.counted = true;
    InputCounters counters = drive.outcomes.back().estimate.counters;
    sum.counters_off = !same(counters, fault.counters(drive.bus));
  }
  return sum;
}

FaultTime random_time(Random& random, bool loose_contact) {
  const auto between = [&random](double low, double high) { return low + (high - low) * random.uniform(); };
  const double onset_s = between(15, 25);
  return {onset_s, loose_contact ? between(0.05, 0.5) : between(3, 15)};
}

const Fault& any_of(const std::vector<Fault>& faults, Random& random) {
  return faults[static_cast<std::size_t>(random.uniform() * static_cast<double>(faults.size()))];
}

// ---- tables ----

const char* name(FaultClass kind) {
  switch (kind) {
    case FaultClass::kRefused:
      return "refused";
    case FaultClass::kMisfit:
      return "misfit";
    case FaultClass::kNotVisible:
      return "not visible";
  }
  return "unknown";
}

/// Sums over the drives of one row of the table.
struct Sums {
  double fault_s = 0, misled_s = 0, unsound = 0, not_finite = 0, counted = 0, counters_off = 0, undetected = 0;
  std::vector<double> detected_s, recovery_s;

  void add(const Account& one) {
    fault_s += one.fault_s;
    misled_s += one.misled_s;
    unsound += one.unsound;
    not_finite += one.not_finite;
    counted += one.counted;
    counters_off += one.counters_off;
    if (one.detected_s) detected_s.push_back(*one.detected_s);
    undetected += !one.detected_s;
    recovery_s.push_back(one.recovery_s);
  }
};

FoundTable empty_table() {
  FoundTable table;
  table.name = "faults";
  table.title = "What each fault did, over its drives";
  table.columns = {word_column("class", "class"),
                   word_column("fault", "fault"),
                   number_column("detected_median_s", "detected, median", "s"),
                   number_column("undetected", "drives valid throughout", ""),
                   number_column("misled_s", "misled", "s"),
                   number_column("fault_s", "of", "s"),
                   number_column("recovery_median_s", "recovery, median", "s"),
                   number_column("recovery_p90_s", "90 % below", "s"),
                   number_column("recovery_worst_s", "slowest", "s"),
                   number_column("counters_off", "counters off", ""),
                   number_column("unsound", "unsound ticks", "")};
  return table;
}

std::vector<report::Cell> row_of(const std::string& kind, const std::string& fault, const Sums& sums) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {kind,
          fault,
          quantile(sums.detected_s, 0.5),
          sums.undetected,
          sums.misled_s,
          sums.fault_s,
          quantile(sums.recovery_s, 0.5),
          quantile(sums.recovery_s, 0.9),
          quantile(sums.recovery_s, 1),
          sums.counted > 0 ? sums.counters_off : none,
          sums.unsound};
}

report::Bars recovery_chart(const FoundTable& table) {
  report::Bars bars;
  bars.title = "Time from a fault's end until the answer is valid and right";
  bars.value = {.label = "recovery", .unit = "s"};
  report::BarSeries median{.name = "median", .meaning = report::Meaning::kReference};
  report::BarSeries worst{.name = "slowest", .meaning = report::Meaning::kModel};
  for (const auto& row : table.rows) {
    bars.categories.push_back(std::get<std::string>(row[1]));
    median.values.push_back(std::get<double>(row[6]));
    worst.values.push_back(std::get<double>(row[8]));
  }
  bars.series = {median, worst};
  bars.marks.push_back({.at = 5, .label = "asked"});
  return bars;
}

void ask(Findings& found, const std::vector<Sums>& sums) {
  const std::vector<Fault>& faults = all_faults();
  Sums all;
  for (const FaultClass kind : {FaultClass::kRefused, FaultClass::kMisfit}) {
    Sums of_class;
    double soon = 0;
    for (std::size_t i = 0; i < faults.size(); ++i) {
      if (faults[i].kind != kind) continue;
      of_class.misled_s += sums[i].misled_s;
      of_class.fault_s += sums[i].fault_s;
      of_class.recovery_s.insert(of_class.recovery_s.end(), sums[i].recovery_s.begin(), sums[i].recovery_s.end());
    }
    for (const double one : of_class.recovery_s) soon += one <= 5 ? 1 : 0;
    found.asked.push_back(
        {fmt::format("class {}: valid while wrong beyond 2 s, of {:.0f} s of fault", name(kind), of_class.fault_s), "s",
         of_class.misled_s, 0});
    found.asked.push_back(
        {fmt::format("class {}: slowest recovery", name(kind)), "s", quantile(of_class.recovery_s, 1), 5});
    found.asked.push_back({fmt::format("class {}: share of drives that recover within 5 s", name(kind)), "%",
                           100 * soon / static_cast<double>(of_class.recovery_s.size()), 100,
                           AskedFigure::Limit::kAtLeast});
  }
  for (const Sums& one : sums) {
    all.unsound += one.unsound;
    all.not_finite += one.not_finite;
    all.counters_off += one.counters_off;
    all.counted += one.counted;
  }
  found.asked.push_back({"ticks with a number that is not finite, mixtures included", "", all.not_finite, 0});
  found.asked.push_back(
      {"ticks with an output out of range or an unsound state, mixtures included", "", all.unsound, 0});
  found.asked.push_back(
      {fmt::format("drives with a counter that is off, of {:.0f} that can be counted off", all.counted), "",
       all.counters_off, 0});
}

}  // namespace

Findings run_fault_study(const FaultStudy& study, const StudyProgress& at) {
  const std::vector<Fault>& faults = all_faults();
  const std::size_t single = faults.size() * study.drives;
  const std::size_t jobs = single + kMixturesPerDrive * study.drives;
  std::vector<Account> accounts(jobs);
  work_in_parallel(
      jobs, 0, [&](std::size_t done) { at(done, jobs); },
      [&](std::size_t job) {
        const std::size_t number = job % study.drives;
        const std::uint64_t seed = study.seed * 1'000'003 + job;
        Random random(seed, kFaultStream);
        const FaultTime when = random_time(random, number % 3 == 2);
        if (job < single) {
          accounts[job] = account(faults[job / study.drives], when, seed, study.unmeasured_percent);
        } else {
          const Fault& first = any_of(faults, random);
          accounts[job] = account(both(first, any_of(faults, random)), when, seed, study.unmeasured_percent);
        }
      });
  std::vector<Sums> sums(faults.size() + 1);
  for (std::size_t job = 0; job < jobs; ++job) {
    sums[job < single ? job / study.drives : faults.size()].add(accounts[job]);
  }

  Findings found;
  found.study = "faults";
  found.title = "What a fault does to the estimate";
  found.how = fmt::format(
      "{} drives of each of {} faults and {} of two at once, seed {}, the firmware's loop in float under a probe of "
      "1.5 Nm rms, with {:g} % of slow torque beside it that no sensor sees; onset at 15 to 25 s, for 3 to 15 s, one "
      "in three for 0.05 to 0.5 s; watched for {} s after the end.",
      study.drives, faults.size(), kMixturesPerDrive * study.drives, study.seed, study.unmeasured_percent, kWatched_s);
  found.command = fmt::format("steerid study faults --drives {} --seed {}", study.drives, study.seed);
  if (study.unmeasured_percent > 0) found.command += fmt::format(" --unmeasured {:g}", study.unmeasured_percent);
  FoundTable table = empty_table();
  for (std::size_t i = 0; i < faults.size(); ++i)
    table.rows.push_back(row_of(name(faults[i].kind), faults[i].name, sums[i]));
  table.rows.push_back(row_of("mixture", "two of these", sums.back()));
  ask(found, sums);
  found.charts.push_back(recovery_chart(table));
  found.tables.push_back(std::move(table));
  return found;
}

}  // namespace steerid
