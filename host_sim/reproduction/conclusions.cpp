// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/conclusions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace steerid {
namespace {

constexpr std::array kSymbols{"J", "B", "C"};
constexpr double kByChance = 0.01;
constexpr double kTorque_nm = 5.0;  // of the passive task's triangle

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

/// How likely it is that intervals of 95 % hold the truth no more often than these.
double chance_of_coverage(const MeasuredErrors& errors, std::size_t i) {
  const double n = std::round(errors.valid_share[i] * static_cast<double>(errors.records));
  const double k = std::round(errors.covered[i] * n);
  return k < n ? incomplete_beta(0.05, n - k, k + 1) : 1.0;
}

std::string clause(std::span<const MeasuredErrors> by_task, std::size_t i) {
  const auto most = [&](auto of) {
    double value = of(by_task.front());
    for (const MeasuredErrors& errors : by_task) value = std::max(value, of(errors));
    return value;
  };
  std::array<bool, 4> met{};
  for (const MeasuredErrors& errors : by_task) met[static_cast<std::size_t>(fault_of(errors, i))] = true;
  const double error = 100 * most([&](const MeasuredErrors& e) { return e.rms[i]; });
  if (met[static_cast<std::size_t>(Fault::kError)]) return fmt::format("{} is off by {:.2g} % rms", kSymbols[i], error);
  if (met[static_cast<std::size_t>(Fault::kSeldomValid)]) {
    return fmt::format("{} is valid in {:.0f} % of the records only", kSymbols[i],
                       -100 * most([&](const MeasuredErrors& e) { return -e.valid_share[i]; }));
  }
  if (met[static_cast<std::size_t>(Fault::kIntervals)]) {
    return fmt::format("the 95 % intervals of {} hold the truth in {:.0f} % of its answers", kSymbols[i],
                       -100 * most([&](const MeasuredErrors& e) { return e.valid_share[i] > 0 ? -e.covered[i] : -1; }));
  }
  return fmt::format("{} is right ({:.2g} % rms)", kSymbols[i], error);
}

/// What the paper says of a label and a quantity; nothing of B.
struct PaperClaim {
  std::size_t label;
  std::size_t quantity;
  bool works;
};
constexpr std::array kPaperClaims{PaperClaim{0, 0, false}, PaperClaim{0, 2, true},  PaperClaim{0, 3, true},
                                  PaperClaim{1, 2, true},  PaperClaim{1, 3, true},  PaperClaim{2, 0, false},
                                  PaperClaim{2, 1, false}, PaperClaim{2, 2, false}, PaperClaim{2, 3, false}};

constexpr std::array<std::array<const char*, 3>, 3> kLevels{
    {{"active", "passive", ""}, {"one hand", "both", ""}, {"3", "12", "1:30"}}};

}  // namespace

Fault fault_of(const MeasuredErrors& errors, std::size_t parameter) {
  if (!(errors.rms[parameter] <= kVisible)) return Fault::kError;
  if (errors.valid_share[parameter] < 0.5) return Fault::kSeldomValid;
  return chance_of_coverage(errors, parameter) < kByChance ? Fault::kIntervals : Fault::kNone;
}

std::string on_parameters(std::span<const MeasuredErrors> by_task) {
  std::vector<std::string> clauses;
  for (const std::size_t i : {2U, 0U, 1U}) clauses.push_back(clause(by_task, i));
  return joined(clauses, "; ");
}

bool right(std::span<const MeasuredErrors> by_task, std::span<const std::size_t> parameters) {
  return std::all_of(by_task.begin(), by_task.end(), [&](const MeasuredErrors& errors) {
    return std::all_of(parameters.begin(), parameters.end(),
                       [&](std::size_t i) { return fault_of(errors, i) == Fault::kNone; });
  });
}

std::string on_fit(double pooled_percent) {
  return fmt::format("the models reproduce {:.1f} % of the amplitude under 5 Hz, {} the paper's \"over {} %\"",
                     pooled_percent, pooled_percent > kPublishedFit_percent ? "as in" : "less than",
                     kPublishedFit_percent);
}

std::string on_label(const LabelCorrelation& found) {
  const std::string what = fmt::format("{} and {}", kLabels[found.label], kQuantities[found.quantity]);
  const auto claim = std::find_if(kPaperClaims.begin(), kPaperClaims.end(), [&](const PaperClaim& one) {
    return one.label == found.label && one.quantity == found.quantity;
  });
  if (!found.effect.tested()) {
    return fmt::format("{}: not tested, {} subjects have a valid answer in all of their records.", what,
                       found.effect.subjects);
  }
  const bool works = found.effect_holm_p < kSignificance;
  std::vector<std::string> means;
  for (std::size_t i = 0; i < found.effect.level_mean.size(); ++i) {
    means.push_back(fmt::format("{:.3g} ({})", found.effect.level_mean[i], kLevels[found.label][i]));
  }
  std::string beside;
  if (claim != kPaperClaims.end()) {
    beside = claim->works == works ? ", as the paper says"
                                   : fmt::format(", where the paper says {}", claim->works ? "it does" : "it does not");
  }
  return fmt::format("{}: the label {} (F {:.1f}, {} subjects, means {}){}.", what,
                     works ? "works" : "does not show to work", found.effect.f, found.effect.subjects,
                     joined(means, ", "), beside);
}

std::array<MeasuredErrors, 2> batch_errors(const std::vector<IdentifiedRecord>& records) {
  return {measured_errors(records, TaskKind::kPassive, &IdentifiedRecord::batch),
          measured_errors(records, TaskKind::kActive, &IdentifiedRecord::batch)};
}

std::string on_basin(double unit_share, double line_search_share) {
  const double more = line_search_share - unit_share;
  return fmt::format(
      "Steps of unit length reach the minimum from {:.0f} % of the starts, a line search from {:.0f} %: "
      "it {} the basin{}.",
      100 * unit_share, 100 * line_search_share, more > 0 ? "widens" : (more < 0 ? "narrows" : "does not change"),
      line_search_share < 1 ? ", and does not make it whole" : ", and makes it whole");
}

std::string on_excitation(const ExcitationRow& row) {
  std::vector<std::string> seen;
  std::vector<std::string> unexcited;
  for (std::size_t i = 0; i < 3; ++i) {
    const double sd = row.relative_sd.front()[i];
    if (sd <= kVisible) seen.push_back(fmt::format("{} (to {:.2g} %)", kSymbols[i], 100 * sd));
    if (!(sd <= kVisible)) unexcited.emplace_back(kSymbols[i]);
  }
  return fmt::format("To the letter and without a probe, the {} task shows {}{}.", name(row.task),
                     seen.empty() ? "nothing to 10 %" : joined(seen, " and "),
                     unexcited.empty() ? "" : fmt::format(", and leaves {} unexcited", joined(unexcited, " and ")));
}

std::string on_figure_5(const ExperimentResults& results) {
  const std::vector<double>& angle = results.figure_5.record.angle_rad;
  const auto [least, most] = std::minmax_element(angle.begin(), angle.end());
  const double stiffness =
      results.run.subjects.front().passive[static_cast<std::size_t>(HandPosition::kRight130)].stiffness_nm_per_rad;
  return fmt::format(
      "In the paper's figure 5 the angle \"remains within a small range around 0 rad\"; here the wheel goes from "
      "{:.2f} "
      "to {:.2f} rad. The model leaves no choice: {:.0f} Nm turn an arm of C = {:.1f} Nm/rad by {:.2f} rad, and a "
      "nominal one of table I (17.0 Nm/rad) by {:.2f} rad, unless the driver's own torque balances the motor's; then "
      "nothing is left that would show C.",
      *least, *most, kTorque_nm, stiffness, kTorque_nm / stiffness, kTorque_nm / 17.0);
}

std::vector<std::string> conclusions(const ExperimentResults& results) {
  std::string fit = on_fit(results.plain_accuracy.pooled_percent);
  fit[0] = 'T';
  return {fmt::format("{}.", fit),
          fmt::format("As the paper excites the wheel: {}.", on_parameters(batch_errors(results.run.plain))),
          fmt::format("With a probe of {} Nm rms: {}.", results.run.settings.probe_rms_nm,
                      on_parameters(batch_errors(results.run.probed))),
          fmt::format("{} of the {} records have no natural frequency.", results.overdamped.size(), kRecordsOfAKind)};
}

}  // namespace steerid
