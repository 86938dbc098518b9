// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/clock_drift.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "fit/model_check.hpp"
#include "fit/varying_arm.hpp"
#include "log/angle_clock.hpp"

namespace steerid {
namespace {

bool is_likeliest(const std::vector<Alternative>& alternatives) {
  return !alternatives.empty() && alternatives.front().kind == Alternative::Kind::kClockDrift &&
         alternatives.front().evidence_nats > 0;
}

bool nothing_comes_near(const std::vector<Alternative>& alternatives, std::size_t samples) {
  constexpr double kStrong_nats = 3;
  constexpr double kNats_a_sample = 0.02;
  constexpr double kMost_per_s = 5e-4;
  const Alternative& likeliest = alternatives.front();
  return std::abs(likeliest.size) < kMost_per_s &&
         likeliest.evidence_nats > kNats_a_sample * static_cast<double>(samples) &&
         (alternatives.size() < 2 || likeliest.evidence_nats > alternatives[1].evidence_nats + kStrong_nats);
}

}  // namespace

double clock_drift_per_s(const Resampled& resampled, bool torque_offset) {
  constexpr int kTimes = 4;  // it is found to first order
  if (!voluntary_torque_known(resampled.record.equation())) return 0;
  double later_per_s = 0;
  Resampled read = resampled;
  for (int i = 0; i < kTimes; ++i) {
    const std::vector<Alternative> alternatives = check_model(read, torque_offset).alternatives;
    if (!is_likeliest(alternatives)) break;
    const Alternative& drift = alternatives.front();
    if (i == 0 && (!nothing_comes_near(alternatives, read.record.size()) ||
                   fit_varying_arm(read.record).likelihood_ratio / 2 > drift.evidence_nats)) {
      break;
    }
    later_per_s += drift.size;
    read.record = by_one_clock(resampled.record, later_per_s, resampled.in_step_s());
  }
  return later_per_s;
}

}  // namespace steerid
