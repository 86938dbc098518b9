// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/manoeuvres.hpp"

namespace steerid {

ManoeuvreCourse::ManoeuvreCourse(Manoeuvre manoeuvre, std::uint64_t seed, std::uint64_t stream)
    : manoeuvre_(manoeuvre), random_(seed, stream) {
  draw_round();
}

void ManoeuvreCourse::draw_round() {
  count_ = at_ = 0;
  switch (manoeuvre_) {
    case Manoeuvre::kLaneKeeping:
      add(0, 60);
      break;
    case Manoeuvre::kCurves: {
      const double angle_rad = side() * between(0.15, 0.5);
      add(0, between(4, 10));
      add(angle_rad, between(1.5, 3));
      add(angle_rad, between(3, 8));
      add(0, between(1.5, 3));
      break;
    }
    case Manoeuvre::kLaneChanges: {
      const double angle_rad = side() * between(0.08, 0.2);
      add(0, between(6, 12));
      add(angle_rad, 1.2);
      add(-angle_rad, 1.8);
      add(0, 1.2);
      break;
    }
    case Manoeuvre::kSwerve: {
      const double angle_rad = side() * between(0.7, 1.1);
      add(0, between(15, 30));
      add(angle_rad, 0.4);
      add(-angle_rad, 0.8);
      add(0, 0.4);
      add(0, 0.5);
      add(-0.8 * angle_rad, 0.4);
      add(0.8 * angle_rad, 0.8);
      add(0, 0.4);
      break;
    }
  }
}

SignalPoint ManoeuvreCourse::next() {
  while (since_s_ >= moves_[at_].length_s) {
    since_s_ -= moves_[at_].length_s;
    from_rad_ = moves_[at_].to_rad;
    if (++at_ == count_) draw_round();
  }
  const Move& move = moves_[at_];
  const SignalPoint rise = smooth_rise(since_s_ / move.length_s);
  const double by_rad = move.to_rad - from_rad_;
  since_s_ += kTickS;
  return {from_rad_ + by_rad * rise.value, by_rad * rise.slope / move.length_s};
}

}  // namespace steerid
