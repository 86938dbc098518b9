// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/clock_check.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "fit/model_check.hpp"
#include "fit/varying_arm.hpp"

namespace steerid {
namespace {

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

AngleClock check_clock(const Resampled& resampled, bool torque_offset) {
  constexpr int kTimes = 4;  // both are found to first order
  AngleClock clock;
  if (!voluntary_torque_known(resampled.record.equation())) return clock;
  Resampled read = resampled;
  for (int i = 0; i < kTimes; ++i) {
    const std::vector<Alternative> alternatives = check_model(read, torque_offset).alternatives;
    if (alternatives.empty() || !(alternatives.front().evidence_nats > 0)) break;
    const Alternative& likeliest = alternatives.front();
    if (likeliest.kind == Alternative::Kind::kClockDrift) {
      if (clock.later_per_s == 0 && (!nothing_comes_near(alternatives, read.record.size()) ||
                                     fit_varying_arm(read.record).likelihood_ratio / 2 > likeliest.evidence_nats)) {
        break;
      }
      clock.later_per_s += likeliest.size;
    } else if (likeliest.kind == Alternative::Kind::kDelay &&
               std::abs(clock.late_s + likeliest.size) <= resampled.message_told_to_s) {
      clock.late_s += likeliest.size;
    } else {
      break;
    }
    read.record = by_one_clock(resampled.record, clock, resampled.in_step_s());
  }
  return clock;
}

}  // namespace steerid
