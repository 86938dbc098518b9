// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a driver means the wheel to be: smooth moves between angles, drawn one after the other.
//
// | manoeuvre    | moves                                                                                          |
// | lane_keeping | none                                                                                           |
// | curves       | straight 4 to 10 s; into a curve within 1.5 to 3 s; 0.15 to 0.5 rad for 3 to 8 s; out again    |
// | lane_changes | straight 6 to 12 s; to one side 1.2 s, to the other 1.8 s, back 1.2 s; 0.08 to 0.2 rad         |
// | swerve       | straight 15 to 30 s; out of the lane and into it again as in a double lane change (ISO 3888-2 |
// |              | has 12 to 13.5 m for each): 0.7 to 1.1 rad, 0.4 s from side to side                            |
//
// A move is a polynomial of fifth order whose slope and bend are zero at both ends, as a hand moves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "experiment/signal_point.hpp"
#include "sensors/random.hpp"

namespace steerid {

enum class Manoeuvre { kLaneKeeping, kCurves, kLaneChanges, kSwerve };

inline constexpr std::array<Manoeuvre, 4> kAllManoeuvres{Manoeuvre::kLaneKeeping, Manoeuvre::kCurves,
                                                         Manoeuvre::kLaneChanges, Manoeuvre::kSwerve};

/// As the command line spells it.
constexpr std::string_view name(Manoeuvre manoeuvre) {
  switch (manoeuvre) {
    case Manoeuvre::kLaneKeeping:
      return "lane_keeping";
    case Manoeuvre::kCurves:
      return "curves";
    case Manoeuvre::kLaneChanges:
      return "lane_changes";
    case Manoeuvre::kSwerve:
      return "swerve";
  }
  return "unknown";
}

/// From 0 to 1 within a length of 1, with slope and bend zero at both ends; held outside.
[[nodiscard]] constexpr SignalPoint smooth_rise(double share) {
  if (share <= 0) return {0, 0};
  if (share >= 1) return {1, 0};
  return {share * share * share * (10 + share * (6 * share - 15)), 30 * share * share * (1 - share) * (1 - share)};
}

class ManoeuvreCourse {
 public:
  ManoeuvreCourse(Manoeuvre manoeuvre, std::uint64_t seed, std::uint64_t stream);

  /// The intended angle at the next tick; the first one is at time 0.
  SignalPoint next();

 private:
  struct Move {
    double to_rad = 0;
    double length_s = 0;
  };
  static constexpr std::size_t kMostMoves = 8;

  void draw_round();
  [[nodiscard]] double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  [[nodiscard]] double side() { return random_.uniform() < 0.5 ? -1.0 : 1.0; }
  void add(double to_rad, double length_s) { moves_[count_++] = {to_rad, length_s}; }

  Manoeuvre manoeuvre_;
  Random random_;
  std::array<Move, kMostMoves> moves_{};  // of this round
  std::size_t count_ = 0;
  std::size_t at_ = 0;
  double from_rad_ = 0;
  double since_s_ = 0;  // in the present move
};

}  // namespace steerid
