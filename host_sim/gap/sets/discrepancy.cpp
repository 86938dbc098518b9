// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/discrepancy.hpp"

#include <algorithm>
#include <cmath>
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
  RunSlopes slopes(shaped, parts);
  ResidualModel& judged = one.motion == Motion::kFreeRuns ? static_cast<ResidualModel&>(by_runs) : on_motion;
  const double lines = one.lines();
  const std::vector<Rival> rivals = rivals_beyond(shaped, setting.whittle, judged, slopes, one.fit,
                                                  fitter.fitted(one.set), one.set.slow, setting.threads);
  // The best of many shapes gains by chance: each has its share of the prior.
  const double among = std::log(std::max(static_cast<double>(rivals.size()), 1.0));
  double most = 0;
  for (const Rival& rival : rivals) {
    // A quarter of the record beside the half that it was fitted on: half the gain, if it is real.
    const double gained = 1.5 * std::min(rival.fit_nats, 2 * rival.choose_nats);
    const double price = rival.free * std::log(std::max(lines, 2.0)) / 2 + among;
    most = std::max(most, (gained - price) / (1 + rival.left / lines));
  }
  return most;
}

}  // namespace steerid::gap
