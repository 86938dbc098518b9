// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/table_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steerid {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

using Values = std::array<std::vector<double>, 4>;

FourSpreads spreads(const Values& values) {
  FourSpreads out;
  for (std::size_t i = 0; i < 4; ++i) out[i] = spread_of(values[i]);
  return out;
}

/// Adds what an answer may say; true when its damping ratio is known and at least 1.
bool add_answer(const ArmAnswer& answer, Values& values) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (answer.valid(static_cast<int>(i))) values[i].push_back(answer.value[i]);
  }
  const std::optional<NaturalFrequency> frequency = answer.frequency();
  if (!frequency) return false;
  if (frequency->defined == NaturalFrequency::Defined::kYes) values[3].push_back(frequency->hz);
  return frequency->defined == NaturalFrequency::Defined::kOverdamped;
}

bool add_truth(const WheelArm& arm, Values& values) {
  ArmAnswer exact{{arm.inertia_kgm2, arm.damping_nms_per_rad, arm.stiffness_nm_per_rad}, {}, {}};
  exact.state.fill(ParameterState::kValid);
  return add_answer(exact, values);
}

TableRow table_row(const ExperimentRun& run, TaskKind task, HandPosition hands) {
  TableRow row{task, hands, {}, {}, {}, {}};
  Values truth;
  Values plain;
  Values probed;
  Values recursive;
  for (std::size_t subject = 0; subject < kSubjects; ++subject) {
    const std::size_t at = ExperimentRun::index(task, hands, subject);
    row.overdamped_truth += add_truth(run.subjects[subject].arm(task, hands), truth) ? 1 : 0;
    row.overdamped_probed += add_answer(run.probed[at].batch, probed) ? 1 : 0;
    add_answer(run.plain[at].batch, plain);
    add_answer(run.probed[at].recursive, recursive);
  }
  row.truth = spreads(truth);
  row.plain = spreads(plain);
  row.probed = spreads(probed);
  row.recursive_probed = spreads(recursive);
  return row;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {n, (values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

std::vector<TableRow> table_rows(const ExperimentRun& run) {
  std::vector<TableRow> rows;
  for (const TaskKind task : kSteeringTasks) {
    for (const HandPosition hands : kAllHandPositions) rows.push_back(table_row(run, task, hands));
  }
  return rows;
}

Accuracy accuracy_of(std::span<const IdentifiedRecord> records) {
  double error = 0;
  double total = 0;
  std::vector<double> percent;
  std::vector<double> true_arm;
  for (const IdentifiedRecord& record : records) {
    const AmplitudeCurves& curves = record.quality.curves;
    for (std::size_t k = 0; k < curves.frequency_hz.size(); ++k) {
      error += std::abs(curves.measured_rad[k] - curves.model_rad[k]);
      total += curves.measured_rad[k];
    }
    if (record.quality.amplitude_fit_percent) percent.push_back(*record.quality.amplitude_fit_percent);
    if (record.true_arm_fit_percent) true_arm.push_back(*record.true_arm_fit_percent);
  }
  return {total > 0 ? 100 * (1 - error / total) : 0, spread_of(percent), spread_of(true_arm)};
}

std::vector<Overdamped> overdamped_records(const ExperimentRun& run) {
  std::vector<Overdamped> out;
  for (const IdentifiedRecord& record : run.probed) {
    const double truth = record.what.arm.damping_ratio().value_or(0);
    if (truth < 1) continue;
    std::optional<double> found;
    if (record.batch.all_valid()) found = record.batch.wheel().damping_ratio();
    out.push_back({record.subject, record.what.task, record.what.hands, truth, found});
  }
  return out;
}

FrequencyCheck check_frequency(const PublishedRow& row) {
  const WheelArm arm = row.nominal();
  const double b = arm.damping_nms_per_rad;
  const double c = arm.stiffness_nm_per_rad;
  FrequencyCheck check{.row = row};
  check.damping_ratio = arm.damping_ratio().value_or(0);
  const NaturalFrequency frequency = natural_frequency(arm);
  if (frequency.defined == NaturalFrequency::Defined::kYes) check.equation_5_hz = frequency.hz;
  check.undamped_hz = std::sqrt(c / arm.inertia_kgm2) / kTurn;
  check.highest_hz = c / b / kTurn;
  const double w = kTurn * row.natural_frequency_hz.nominal;
  const double square = c * c - w * w * b * b;
  if (square >= 0) {
    check.smaller_inertia_kgm2 = (c - std::sqrt(square)) / (2 * w * w);
    check.larger_inertia_kgm2 = (c + std::sqrt(square)) / (2 * w * w);
  }
  return check;
}

}  // namespace steerid
