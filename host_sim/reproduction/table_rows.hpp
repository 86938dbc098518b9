// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Tables I and II as this experiment finds them, and what the printed ones say of themselves.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiment/published_tables.hpp"
#include "reproduction/experiment_run.hpp"

namespace steerid {

/// Median and ends of what was found for so many subjects; nothing of none.
struct Spread {
  std::size_t count = 0;
  double median = 0;
  double low = 0;
  double high = 0;
};
[[nodiscard]] Spread spread_of(std::vector<double> values);

/// J, B, C and the natural frequency of equation 5, in this order.
using FourSpreads = std::array<Spread, 4>;

struct TableRow {
  TaskKind task;
  HandPosition hands;
  FourSpreads truth;                  ///< which only a simulation knows
  FourSpreads plain;                  ///< batch, valid answers only, as the paper excites
  FourSpreads probed;                 ///< batch, valid answers only, with the probe
  FourSpreads recursive_probed;       ///< the firmware's answers, likewise
  std::size_t overdamped_truth = 0;   ///< subjects with xi >= 1: equation 5 does not apply
  std::size_t overdamped_probed = 0;  ///< of the valid batch answers
};

/// Twelve rows: passive and active, six hand positions each.
[[nodiscard]] std::vector<TableRow> table_rows(const ExperimentRun& run);

/// Figure 7's figure over many records: 100 % (1 - sum | |Y| - |Yhat| | / sum |Y|) over the bins up to 5 Hz of all of
/// them, and record by record.
struct Accuracy {
  double pooled_percent = 0;
  Spread percent;           ///< of the batch answers
  Spread true_arm_percent;  ///< of the true J, B and C: what no identification can be blamed for
};
[[nodiscard]] Accuracy accuracy_of(std::span<const IdentifiedRecord> records);

/// One record to which equation 5 does not apply.
struct Overdamped {
  std::size_t subject;
  TaskKind task;
  HandPosition hands;
  double damping_ratio_truth;
  std::optional<double> damping_ratio_found;  ///< of the batch answer with the probe, when it is valid
};
[[nodiscard]] std::vector<Overdamped> overdamped_records(const ExperimentRun& run);

/// A printed row against the paper's own equation 5.
///
///   w^2 = C/J - B^2/(4 J^2), so that over all inertias w is at most C/B, at J = B^2/(2 C): a nominal frequency above
///   C/(2 pi B) belongs to no inertia whatever. Below it there are two, J = (C +- sqrt(C^2 - w^2 B^2))/(2 w^2).
struct FrequencyCheck {
  PublishedRow row{};
  double damping_ratio = 0;
  std::optional<double> equation_5_hz{};         ///< of nominal J, B, C; nothing for xi >= 1
  double undamped_hz = 0;                        ///< sqrt(C/J)/(2 pi): the most that any damping leaves
  double highest_hz = 0;                         ///< C/(2 pi B): the most that any inertia leaves
  std::optional<double> smaller_inertia_kgm2{};  ///< that give the printed frequency with nominal B and C
  std::optional<double> larger_inertia_kgm2{};
};
[[nodiscard]] FrequencyCheck check_frequency(const PublishedRow& row);

}  // namespace steerid
