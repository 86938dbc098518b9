// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The way of a probe torque that the 100 Hz task requests, r_k at tick k, to the EPS motor.
//
//   kHeld    the EPS holds each request over one tick; r_k acts from tick k + 1 to tick k + 2.
//   kSmooth  the EPS runs smoothly through the requests (Catmull-Rom cubics): the motor's torque at tick k + 3 is
//            exactly r_k. It needs the requests on either side of an interval, hence the longer way.
// In both cases the motor torque that a sample reports is the one that acts at the sample's instant: the way delays
// what the task asked for, not what it measures.
#pragma once

#include <array>

#include "experiment/tasks.hpp"

namespace steerid {

class ProbePath {
 public:
  explicit ProbePath(EpsTorque eps) : eps_(eps) {}

  void request(double torque_nm) { pending_nm_ = torque_nm; }

  /// The probe's share of the motor torque over the tick that begins now; a request stands until the next one.
  Cubic next() {
    for (std::size_t i = past_nm_.size() - 1; i > 0; --i) past_nm_[i] = past_nm_[i - 1];
    past_nm_[0] = pending_nm_;
    if (eps_ == EpsTorque::kHeld) return {past_nm_[0], 0, 0, 0};
    const auto [after, to, from, before] = past_nm_;
    return Cubic::hermite(from, (to - before) / (2 * kTickS), to, (after - from) / (2 * kTickS), kTickS);
  }

 private:
  EpsTorque eps_;
  double pending_nm_ = 0;
  std::array<double, 4> past_nm_{};  // newest first
};

}  // namespace steerid
