// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Everything that `steerid experiment` finds, worked out once for the report and for experiment.json.
#pragma once

#include <functional>
#include <vector>

#include "reproduction/convergence.hpp"
#include "reproduction/correlations.hpp"
#include "reproduction/driver_state_score.hpp"
#include "reproduction/excitation.hpp"
#include "reproduction/experiment_run.hpp"
#include "reproduction/fit_sweep.hpp"
#include "reproduction/grasp_check.hpp"
#include "reproduction/put_in.hpp"
#include "reproduction/table_rows.hpp"

namespace steerid {

struct ExperimentResults {
  ExperimentRun run;
  std::vector<TableRow> rows;
  std::vector<PutIn> put_in;
  std::vector<Overdamped> overdamped;
  std::vector<FrequencyCheck> checks;  ///< of the six printed rows
  Accuracy plain_accuracy;
  Accuracy probed_accuracy;
  std::vector<LabelCorrelation> correlations;  ///< of the records with the probe
  std::vector<ExcitationRow> excitation;
  std::vector<SweepPoint> sweep;
  FitSweep fit;
  Recording figure_5;  ///< passive, right arm at 1:30, as the paper excites
  Recording figure_6;  ///< active, right arm at 3, likewise
  std::vector<GraspCheck> grasps;
  std::vector<ConvergenceCase> convergence;
  Basin basin;
  std::vector<RankCase> ranks;
  DriverStateScore driver_probed;
  DriverStateScore driver_plain;  ///< the same drives without a probe
};

/// How much there is to do, for a progress bar.
[[nodiscard]] std::size_t experiment_jobs();

[[nodiscard]] ExperimentResults experiment_results(
    const ExperimentSettings& settings, const std::function<void(std::size_t done)>& at_job = [](std::size_t) {});

}  // namespace steerid
