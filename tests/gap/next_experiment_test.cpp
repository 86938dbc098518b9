// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe that a diagnosis proposes: against what, and within which bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiment/multisine.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/verdict_ids.hpp"
#include "gap/drawn_drive.hpp"
#include "plant/free_run.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

double span_of(const std::vector<double>& x, std::size_t from = 0) {
  const auto [low, high] = std::minmax_element(x.begin() + static_cast<std::ptrdiff_t>(from), x.end());
  return *high - *low;
}

TEST(NextExperiment, HoldsTheVerdictAgainstItsNearestRivalWithinWhatTheWheelStands) {
  test::DrawnDrive what;
  what.lag_s = 0.003;
  what.duration_s = 10;
  what.probe_rms_nm = 0.7;
  const Record record = test::drive(what, test::seed(61));
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  const NextExperiment& next = diagnosis.next_experiment;
  ASSERT_EQ(diagnosis.verdict, "lag");
  EXPECT_EQ(next.separates[0], "lag") << next.why;
  EXPECT_EQ(next.separates[1], "delay") << next.why;  // "no change" is told from it by all of the probes
  EXPECT_GT(next.separation, 0);
  EXPECT_FALSE(next.why.empty());

  // Played on the diagnosed wheel, it asks no more than an EPS grants and moves the wheel at most half as far again as
  // the record did; 2 % for the difference between two periods.
  Multisine multisine({next.probe.rms_nm, next.probe.low_hz, next.probe.high_hz, next.probe.period_s, {}});
  Record probe;
  double peak_nm = 0;
  for (int i = 0; i < 4000; ++i) {
    const double torque = multisine.next().value;
    peak_nm = std::max(peak_nm, std::abs(torque));
    probe.time_s.push_back(0.01 * i);
    probe.torque_driver_nm.push_back(0);
    probe.torque_motor_nm.push_back(torque);
    probe.angle_rad.push_back(0);
  }
  double recorded_nm = 5.0;
  for (const double torque : record.torque_motor_nm) recorded_nm = std::max(recorded_nm, std::abs(torque));
  EXPECT_LT(peak_nm, 1.1 * recorded_nm);
  EXPECT_LT(span_of(free_run(diagnosis.with_effect, probe), 2000), 1.02 * 1.5 * span_of(record.angle_rad));
}

TEST(NextExperiment, WithoutARivalSaysSo) {
  const test::DrawnDrive what;
  Simulation simulation;
  simulation.wheel = what.wheel;
  DiagnoseOptions options;
  for (const std::string& id : verdict_ids()) {
    if (id != "none" && id != "parameters" && id != "unknown") options.without.push_back(id);
  }
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(62)), simulation, options);
  EXPECT_TRUE(diagnosis.next_experiment.separates[0].empty());
  EXPECT_FALSE(diagnosis.next_experiment.why.empty());
  // That nothing is left to settle is said only where nothing is.
  const auto unknown = std::ranges::find(diagnosis.ranking, "unknown", &RankedEffect::id);
  const bool settled = unknown == diagnosis.ranking.end() || unknown->probability < 0.05;
  EXPECT_EQ(diagnosis.next_experiment.why.starts_with("Nothing is left to settle"), settled)
      << diagnosis.next_experiment.why;
}

}  // namespace
}  // namespace steerid::gap
