// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How much of the hand is away from the wheel.
//
// The hand lets go at first + i period and reaches back after `away`, for every whole i, also before the origin. What
// it does to the wheel follows as a first-order lag of time constant `fade`: a muscle's activation decays with 50 ms
// (Thelen, J. Biomech. Eng. 125, 2003), and the labelled records have 80. With s the share of the hand that is away,
//
//   fade s' + s = 1 while it is off, 0 while it is on
//
// settled to the same course in every period. A fade within kShortest_s is a delay: no step of an integrator has to
// follow it, and no record shows more of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace steerid::effect {

class HandsAway {
 public:
  /// Of hands_off's values: period_s, away_s, first_s, and the last one, fade_s.
  explicit HandsAway(std::span<const double> values)
      : period_s_(values[0]), away_s_(std::min(values[1], values[0])), first_s_(values[2]), fade_s_(values[5]) {
    constexpr double kShortest_s = 0.008;
    if (fade_s_ < kShortest_s) {
      first_s_ += fade_s_;
      fade_s_ = 0;
      return;
    }
    const double kept_off = std::exp(-away_s_ / fade_s_);
    const double kept_on = std::exp(-(period_s_ - away_s_) / fade_s_);
    leaving_ = (1 - kept_off) * kept_on / (1 - kept_off * kept_on);
    returning_ = 1 - (1 - leaving_) * kept_off;
  }

  [[nodiscard]] bool fades() const { return fade_s_ > 0; }
  [[nodiscard]] double fade_s() const { return fade_s_; }

  /// The share that is away at `time_s`, 0 to 1; `side_s` is an instant on the side of the edges that is meant.
  [[nodiscard]] double share(double time_s, double side_s) const {
    const double leave_s = last_leave_s(side_s);
    const bool off = side_s - leave_s < away_s_;
    if (fade_s_ == 0) return off ? 1 : 0;
    if (off) return 1 - (1 - leaving_) * std::exp((leave_s - time_s) / fade_s_);
    const double back = (time_s - leave_s - away_s_) / fade_s_;
    return back > kSettled ? 0 : returning_ * std::exp(-back);
  }

  /// Whether the share still changes by what can be seen, from an edge on.
  [[nodiscard]] bool fading(double time_s) const {
    constexpr double kRounding_s = 1e-9;
    const double since_s = time_s - last_leave_s(time_s + kRounding_s);
    return (since_s < away_s_ - kRounding_s ? since_s : since_s - away_s_) < kSettled * fade_s_;
  }

  /// The next instant after `time_s` at which the hand lets go or reaches back.
  [[nodiscard]] double next_edge_s(double time_s) const {
    const double turn = std::floor((time_s - first_s_) / period_s_);
    for (double i = turn; i <= turn + 1; i += 1) {
      const double leave_s = first_s_ + i * period_s_;
      if (leave_s > time_s) return leave_s;
      if (leave_s + away_s_ > time_s) return leave_s + away_s_;
    }
    return first_s_ + (turn + 2) * period_s_;
  }

  /// Mean share within `window_s` about `time_s`.
  [[nodiscard]] double mean_share(double time_s, double window_s) const {
    const double begin_s = time_s - window_s / 2;
    const double since_s = begin_s - last_leave_s(begin_s);
    if (since_s > away_s_ + kSettled * fade_s_ && since_s + window_s < period_s_) return 0;  // as share() is
    return (since_origin(time_s + window_s / 2) - since_origin(begin_s)) / window_s;
  }

 private:
  static constexpr double kSettled = 20;  // time constants, after which nothing is left

  [[nodiscard]] double last_leave_s(double time_s) const {
    return first_s_ + std::floor((time_s - first_s_) / period_s_) * period_s_;
  }

  /// Integral of the share over time, s, up to a constant.
  [[nodiscard]] double since_origin(double time_s) const {
    const double turns = std::floor((time_s - first_s_) / period_s_);
    const double since_s = time_s - first_s_ - turns * period_s_;
    const double off_s = std::min(since_s, away_s_);
    double sum_s = turns * away_s_ + off_s;  // the lag keeps the mean over a period
    if (fade_s_ == 0) return sum_s;
    sum_s -= (1 - leaving_) * fade_s_ * (1 - std::exp(-off_s / fade_s_));
    if (since_s > away_s_) sum_s += returning_ * fade_s_ * (1 - std::exp((away_s_ - since_s) / fade_s_));
    return sum_s;
  }

  double period_s_;
  double away_s_;
  double first_s_;
  double fade_s_;
  double leaving_ = 0;    ///< share that is still away as the hand lets go again
  double returning_ = 1;  ///< share that is away as it reaches back
};

}  // namespace steerid::effect
