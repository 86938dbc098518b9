// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/discrepancy.hpp"

#include <algorithm>
#include <optional>

#include "gap/hypotheses/slow_share.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/sets/rivals.hpp"

namespace steerid::gap {

double discrepancy_nats(const FittedSet& one, const SetFitter& fitter) {
  const SetSetting& setting = fitter.setting();
  const Parts parts = one.set.hypotheses();
  SimulatedModel by_runs(setting.record, parts, one.course);
  std::optional<SpectralRecord> carried;
  if (one.motion == Motion::kCarried) carried.emplace(carried_record(setting.record, by_runs, one.at()));
  const SpectralRecord& record = carried ? *carried : setting.record;
  SpectralModel on_motion(record, parts);
  // The angle's noise in the motion would stand in slopes and shapes, and explain itself. But the run of a wheel that
  // is let go a little early or late is soon elsewhere.
  std::optional<SpectralRecord> quiet;
  if (std::ranges::none_of(parts, &Hypothesis::lets_go)) {
    quiet.emplace(carried_record(setting.record, by_runs, one.at(), kSlowTop_hz));
  }
  const SpectralRecord& shaped = quiet ? *quiet : record;
  ResidualModel& judged = one.motion == Motion::kFreeRuns ? static_cast<ResidualModel&>(by_runs) : on_motion;
  const std::vector<Fitted> fitted = fitter.fitted(one.set);
  return rival_nats(shaped, setting.whittle, judged, RunSlopes(shaped, parts).at(one.fit.x, fitted), one.fit, fitted,
                    one.set.slow, setting.threads);
}

}  // namespace steerid::gap
