// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction with bristles: sticking, the torque is that of a stiff spring between wheel and ground; the bristles
// slip once they are bent to the breakaway level, carry the level of the present speed while they slip, and take hold
// again where the rate turns. Both changes are events, so that nothing stiff is left to integrate (Dupont et al.,
// Single state elastoplastic friction models, IEEE TAC 47 (2002), with its two thresholds joined).
#pragma once

#include <algorithm>
#include <cmath>

#include "blind/element.hpp"

namespace steerid::blind {

class DryFriction : public Element {
 public:
  struct Levels {
    double forward_nm = 0;  ///< at speed
    double backward_nm = 0;
    double bristle_rad = 4e-4;   ///< bend at which the larger level slips
    double breakaway_ratio = 1;  ///< level at rest over level at speed
    double stribeck_rate_rad_s = 1;
    double lasting_share = 1;  ///< of the level, left when the friction has faded
    double fading_s = 1;       ///< time constant of that
  };
  explicit DryFriction(const Levels& levels)
      : levels_(levels),
        stiffness_(levels.breakaway_ratio * std::max(levels.forward_nm, levels.backward_nm) / levels.bristle_rad) {}

  [[nodiscard]] std::size_t states() const override { return 1; }  // what the bristles are bent
  void act(const Instant& now, std::span<const double> own, std::span<double> slope, Balance& balance) const override {
    if (slips_ == 0) {
      slope[0] = now.rate_rad_s;
      balance.torque_nm -= left(now.time_s) * stiffness_ * own[0];
    } else {
      balance.torque_nm -= left(now.time_s) * slips_ * level_nm(slips_, now.rate_rad_s);
    }
  }
  [[nodiscard]] double guard(const Instant& now, std::span<const double> own) const override {
    if (slips_ != 0) return slips_ * now.rate_rad_s;
    const int bent = own[0] < 0 ? -1 : 1;
    return level_nm(bent, 0) - stiffness_ * std::abs(own[0]);
  }
  void cross(const Instant&, std::span<double> own) override {
    const int bent = own[0] < 0 ? -1 : 1;
    if (slips_ == 0) {
      slips_ = bent;
    } else {
      own[0] = kJustHolding * slips_ * level_nm(slips_, 0) / stiffness_;
      slips_ = 0;
    }
  }

 private:
  [[nodiscard]] double level_nm(int direction, double rate) const {
    const double level = direction > 0 ? levels_.forward_nm : levels_.backward_nm;
    if (levels_.breakaway_ratio == 1) return level;
    const double ratio = rate / levels_.stribeck_rate_rad_s;
    return level * (1 + (levels_.breakaway_ratio - 1) * std::exp(-ratio * ratio));
  }

  /// Of friction and bristles alike: bristles that hold do not start to slip because they fade.
  [[nodiscard]] double left(double time_s) const {
    if (levels_.lasting_share == 1) return 1;
    return levels_.lasting_share + (1 - levels_.lasting_share) * std::exp(-std::max(time_s, 0.0) / levels_.fading_s);
  }

  static constexpr double kJustHolding = 1 - 1e-9;  // rounding must not let go what has just taken hold

  Levels levels_;
  double stiffness_;
  int slips_ = 0;  // 0 sticks, else the direction
};

}  // namespace steerid::blind
