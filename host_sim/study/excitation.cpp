// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/excitation.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "parallel/work_in_parallel.hpp"
#include "study/drive_information.hpp"
#include "study/manoeuvres.hpp"

namespace steerid {
namespace {

constexpr WheelArm kArm{0.11, 1.5, 22.7};
constexpr std::size_t kBlock = 50;   ///< ticks between two looks at the information
constexpr std::size_t kWindow = 10;  ///< blocks: 5 s
constexpr double kKnown = 0.1;       ///< relative: what the identifier calls learned (IdentifierSettings::usable)
constexpr std::array kUnmeasuredPercent = {0, 2, 10};

struct DriveKind {
  const char* name;
  double seconds;
  double applied_rms_nm;
  std::function<Manoeuvre(std::uint64_t seed)> make;
};

std::vector<DriveKind> kinds(double straight_road_s) {
  const double steering_rms_nm = SteeringDriver({}, kArm, 1, kDriverStream).nominal_rms_nm();
  return {
      {"triangle", 200, 5 / std::sqrt(3.0), [](std::uint64_t) { return triangle(); }},
      {"sine", 60, 3 / std::sqrt(2.0), [](std::uint64_t) { return sine(3, 0.25); }},
      {"curve", 120, 5, [](std::uint64_t seed) { return curve(5, 0.3, seed); }},
      {"straight road", straight_road_s, 1.5, [](std::uint64_t) { return straight_road(); }},
      {"restless hands", 120, 1.5, [](std::uint64_t seed) { return holding(seed); }},
      {"steering", 60, steering_rms_nm, [](std::uint64_t seed) { return steering(kArm, seed); }},
      {"probe", 60, 1.5, [](std::uint64_t seed) { return probe(seed); }},
  };
}

struct Case {
  DriveKind kind;
  int percent;

  [[nodiscard]] double unmeasured_nm() const { return 0.01 * percent * kind.applied_rms_nm; }
  [[nodiscard]] std::string unmeasured_name() const { return percent > 0 ? fmt::format("{} %", percent) : "none"; }
};

/// Ticks of one parameter.
struct Ticks {
  double valid = 0, converging = 0, holding = 0, wrong = 0, knowable = 0, shown = 0, overclaimed = 0, unused = 0;

  Ticks& operator+=(const Ticks& o) {
    valid += o.valid, converging += o.converging, holding += o.holding, wrong += o.wrong;
    knowable += o.knowable, shown += o.shown, overclaimed += o.overclaimed, unused += o.unused;
    return *this;
  }
};

struct Counted {
  double all = 0;
  std::array<Ticks, 3> of;

  Counted& operator+=(const Counted& o) {
    all += o.all;
    for (std::size_t i = 0; i < 3; ++i) of[i] += o.of[i];
    return *this;
  }
};

/// Whether all samples up to a block's end, and whether its last kWindow blocks alone, fix a parameter.
struct Knowledge {
  std::array<bool, 3> knowable{}, shown{};
};

std::vector<Knowledge> knowledge_of(const std::vector<double>& torque_nm, double unmeasured_nm) {
  const SensorDeviation sensors;
  const std::vector<Eigen::Matrix3d> blocks = information_by_block(
      kArm, torque_nm,
      {.angle_rad = sensors.angle_rad, .torque_nm = sensors.torque_nm(), .unmeasured_nm = unmeasured_nm}, kBlock);
  const Eigen::Vector3d limit =
      kKnown * Eigen::Vector3d(kArm.inertia_kgm2, kArm.damping_nms_per_rad, kArm.stiffness_nm_per_rad);
  std::vector<Knowledge> known(blocks.size());
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    all += blocks[k];
    Eigen::Matrix3d window = Eigen::Matrix3d::Zero();
    for (std::size_t i = k + 1 - std::min(k + 1, kWindow); i <= k; ++i) window += blocks[i];
    const Eigen::Vector3d bound = bound_of(all);
    const Eigen::Vector3d window_bound = bound_of(window);
    for (int i = 0; i < 3; ++i) {
      known[k].knowable[static_cast<std::size_t>(i)] = bound(i) <= limit(i);
      known[k].shown[static_cast<std::size_t>(i)] = window_bound(i) <= limit(i);
    }
  }
  return known;
}

/// The identifier's word at a tick, kept until the information is known.
struct Word {
  Belief belief = Belief::kStarting;
  bool wrong = false;
};
using Words = std::vector<std::array<Word, 3>>;

Counted count(const Words& words, const std::vector<Knowledge>& known) {
  Counted counted;
  for (std::size_t k = 0; k / kBlock < known.size() && k < words.size(); ++k) {
    const Knowledge& at = known[k / kBlock];
    counted.all += 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Word& word = words[k][i];
      const bool valid = word.belief == Belief::kValid;
      Ticks& ticks = counted.of[i];
      ticks.valid += valid;
      ticks.converging += word.belief == Belief::kConverging;
      ticks.holding += word.belief == Belief::kHolding;
      ticks.wrong += valid && word.wrong;
      ticks.knowable += at.knowable[i];
      ticks.shown += at.shown[i];
      ticks.overclaimed += valid && !at.knowable[i];
      ticks.unused += !valid && at.shown[i];
    }
  }
  return counted;
}

Counted drive(const Case& what, std::uint64_t seed) {
  Manoeuvre acts = what.kind.make(seed);
  if (what.percent > 0) acts = together(acts, unmeasured(what.unmeasured_nm(), seed));
  std::vector<double> torque_nm = {0.0};  // nothing acts before the first tick
  const auto kept = [&](const VirtualWheel& wheel) {
    const Torques now = acts(wheel);
    torque_nm.push_back(now.driver.value - now.motor.value);
    return now;
  };
  VirtualDrive<double> wheel(kArm, seed);
  Words words;
  wheel.run(kept, what.kind.seconds, [&](const Sample&) {
    std::array<Word, 3>& now = words.emplace_back();
    for (int i = 0; i < 3; ++i) {
      const Belief belief = wheel.identifier().belief(i);
      const bool wrong =
          belief == Belief::kValid && std::abs(wheel.value(i) - wheel.truth()(i)) > 1.96 * wheel.deviation(i);
      now[static_cast<std::size_t>(i)] = {belief, wrong};
    }
  });
  torque_nm.pop_back();  // what acts after the last tick
  return count(words, knowledge_of(torque_nm, what.unmeasured_nm()));
}

/// Standard error of the share of wrong ticks among the valid ones: the ticks of a drive hang together, the drives do
/// not.
double wrong_error_percent(std::span<const Counted> drives, std::size_t parameter) {
  double valid = 0, wrong = 0, squares = 0;
  for (const Counted& one : drives) {
    valid += one.of[parameter].valid;
    wrong += one.of[parameter].wrong;
  }
  if (!(valid > 0)) return std::numeric_limits<double>::quiet_NaN();
  for (const Counted& one : drives) {
    const double off = one.of[parameter].wrong - wrong / valid * one.of[parameter].valid;
    squares += off * off;
  }
  const auto n = static_cast<double>(drives.size());
  return 100 * std::sqrt(squares * n / (n - 1)) / valid;
}

double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : std::numeric_limits<double>::quiet_NaN();
}

FoundTable empty_table() {
  FoundTable table;
  table.name = "ticks";
  table.title = "Share of all ticks";
  table.caption = "Wrong: of the valid ticks, those with the truth outside the 95 % interval.";
  table.columns = {word_column("drive", "drive"), word_column("unmeasured", "unmeasured"),
                   word_column("parameter", "")};
  for (const char* word :
       {"valid", "converging", "holding", "wrong", "wrong_error", "knowable", "shown", "overclaimed", "unused"}) {
    table.columns.push_back(
        {fmt::format("{}_percent", word),
         {.label = word == std::string_view("wrong_error") ? "+-" : word, .unit = "%", .digits = 3}});
  }
  return table;
}

std::vector<report::Cell> row_of(const Case& what, const char* parameter, const Ticks& ticks, double all,
                                 double wrong_error) {
  return {std::string(what.kind.name),
          what.unmeasured_name(),
          std::string(parameter),
          percent(ticks.valid, all),
          percent(ticks.converging, all),
          percent(ticks.holding, all),
          percent(ticks.wrong, ticks.valid),
          wrong_error,
          percent(ticks.knowable, all),
          percent(ticks.shown, all),
          percent(ticks.overclaimed, all),
          percent(ticks.unused, all)};
}

/// Valid and knowable beside each other, one chart a parameter.
report::Bars chart_of(const std::vector<Case>& cases, const std::vector<Counted>& counted, std::size_t parameter) {
  constexpr const char* kNames[] = {"inertia J", "damping B", "stiffness C"};
  report::Bars bars;
  bars.title = fmt::format("{}: share of ticks", kNames[parameter]);
  bars.value = {.label = "of all ticks", .unit = "%"};
  report::BarSeries knowable{.name = "knowable", .meaning = report::Meaning::kReference};
  report::BarSeries shown{.name = "shown by the last 5 s", .meaning = report::Meaning::kMeasured};
  report::BarSeries valid{.name = "valid", .meaning = report::Meaning::kModel};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const Ticks& ticks = counted[k].of[parameter];
    bars.categories.push_back(cases[k].kind.name + std::string(", ") + cases[k].unmeasured_name());
    knowable.values.push_back(percent(ticks.knowable, counted[k].all));
    shown.values.push_back(percent(ticks.shown, counted[k].all));
    valid.values.push_back(percent(ticks.valid, counted[k].all));
  }
  bars.series = {knowable, shown, valid};
  return bars;
}

/// All drives with the same share of unmeasured torque.
void ask_together(Findings& found, const std::vector<Case>& cases, const std::vector<Counted>& counted, int share) {
  double valid = 0, wrong = 0;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (cases[k].percent != share) continue;
    for (const Ticks& ticks : counted[k].of) {
      valid += ticks.valid;
      wrong += ticks.wrong;
    }
  }
  const Case any{{}, share};
  found.asked.push_back({fmt::format("wrong though valid, all drives, unmeasured torque {}", any.unmeasured_name()),
                         "%", percent(wrong, valid), 5});
}

void add_rows(Findings& found, FoundTable& table, const Case& what, const Counted& sum,
              std::span<const Counted> drives) {
  constexpr const char* kSymbols[] = {"J", "B", "C"};
  for (std::size_t i = 0; i < 3; ++i) {
    const Ticks& ticks = sum.of[i];
    table.rows.push_back(row_of(what, kSymbols[i], ticks, sum.all, wrong_error_percent(drives, i)));
    if (!(ticks.valid > 0)) continue;
    found.asked.push_back({fmt::format("{} wrong though valid, {}, unmeasured torque {}", kSymbols[i], what.kind.name,
                                       what.unmeasured_name()),
                           "%", percent(ticks.wrong, ticks.valid), 5});
  }
}

}  // namespace

Findings run_excitation_study(const ExcitationStudy& study, const StudyProgress& at) {
  std::vector<Case> cases;
  for (const DriveKind& kind : kinds(study.straight_road_s)) {
    for (const int percent : kUnmeasuredPercent) cases.push_back({kind, percent});
  }
  const std::size_t drives = (study.drives + cases.size() - 1) / cases.size();
  std::vector<Counted> of_drive(cases.size() * drives);
  work_in_parallel(
      of_drive.size(), 0, [&](std::size_t done) { at(done, of_drive.size()); },
      [&](std::size_t job) { of_drive[job] = drive(cases[job / drives], study.seed * 1'000'003 + job % drives); });

  std::vector<Counted> counted(cases.size());
  for (std::size_t job = 0; job < of_drive.size(); ++job) counted[job / drives] += of_drive[job];

  Findings found;
  found.study = "excitation";
  found.title = "What is called valid, and what the drive could tell";
  found.how = fmt::format(
      "{} drives in each of {} cases, seed {}; J {} kg m2, B {} Nms/rad, C {} Nm/rad; the straight road lasts {} s.",
      drives, cases.size(), study.seed, kArm.inertia_kgm2, kArm.damping_nms_per_rad, kArm.stiffness_nm_per_rad,
      study.straight_road_s);
  found.command = fmt::format("steerid study excitation --drives {} --seed {}", study.drives, study.seed);
  for (const int share : kUnmeasuredPercent) ask_together(found, cases, counted, share);
  FoundTable table = empty_table();
  for (std::size_t k = 0; k < cases.size(); ++k) {
    add_rows(found, table, cases[k], counted[k], std::span(of_drive).subspan(k * drives, drives));
  }
  for (std::size_t i = 0; i < 3; ++i) found.charts.push_back(chart_of(cases, counted, i));
  found.tables.push_back(std::move(table));
  return found;
}

}  // namespace steerid
