// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The arm on the wheel, the torsion bar and the column below it (plant/column.hpp), integrated in double.
//
// Two masses and a motor that answers the bar's torque. Between events it is a linear system under torques that are
// cubics in time; it is integrated by the classical Runge-Kutta method of order four in steps that keep
// step * rate below 0.1, where the rate bounds how fast wheel and column swing on the bar. No step crosses a kink:
// these are found by bisection of the step and met exactly.
//   wheel or column comes to rest, or breaks loose   dry friction is a set: at rest it is whatever torque balances the
//                                                    others, so that nothing creeps
//   the bar's torque leaves or enters the assist's dead zone
//   the motor meets its limit, or leaves it
//
// Cost: 1 to 2 us a tick of 10 ms. Nothing allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plant/column.hpp"
#include "plant/cubic.hpp"

namespace steerid {

/// th, th', ph, ph': the wheel above the bar and the column below it.
struct ColumnState {
  double angle_rad = 0;
  double rate_rad_s = 0;
  double column_angle_rad = 0;
  double column_rate_rad_s = 0;
};

/// What acts over a stretch of time, as polynomials with their origin at its start.
struct ColumnInputs {
  Cubic voluntary_nm;  ///< Tv
  Cubic probe_nm;      ///< as the motor delivers it
  Cubic road_nm;       ///< Troad
  Cubic inertia_kgm2;  ///< J of arm and wheel; above 0
  Cubic damping_nms;   ///< B of arm and wheel, Nms/rad
  Cubic stiffness_nm;  ///< C of the arm, Nm/rad

  [[nodiscard]] ColumnInputs shifted(double tau_s) const;
};

/// Friction is that of a mass, against its motion; at rest it balances what else acts on it.
struct ColumnTorques {
  double bar_nm = 0;
  double motor_nm = 0;
  double rim_nm = 0;  ///< the hand's torque on the wheel
  double wheel_friction_nm = 0;
  double rack_friction_nm = 0;
};

class ColumnPlant {
 public:
  explicit ColumnPlant(const Column& column) : column_(column) {}

  void start(const ColumnState& state);

  /// Goes on by `span_s`.
  void advance(const ColumnInputs& inputs, double span_s);

  [[nodiscard]] ColumnState state() const { return {x_[0], x_[1], x_[2], x_[3]}; }

  /// At the present, under inputs whose origin it is.
  [[nodiscard]] ColumnTorques torques(const ColumnInputs& inputs) const;

  /// True while friction holds the wheel, or the column.
  [[nodiscard]] bool wheel_held() const { return held(kWheel); }
  [[nodiscard]] bool column_held() const { return held(kColumn); }

  /// Makes all steps shorter: 2 halves them. For convergence studies.
  void refine(int factor) { refinement_ = factor; }

 private:
  static constexpr double kStepAngle = 0.1;  // measured: tests/unit/column_plant_test.cpp
  static constexpr int kMostEvents = 64;     // in one stretch; beyond, steps are taken as they are
  using State = std::array<double, 4>;

  /// What may stick: the wheel with the arm above the bar, and the column below it.
  enum Mass : std::uint8_t { kWheel, kColumn };
  static constexpr std::array<Mass, 2> kMasses{kWheel, kColumn};
  static constexpr std::size_t rate_of(Mass mass) { return mass == kWheel ? 1 : 3; }  ///< its place in the state

  /// What is frozen during a step; each is -1, 0 or 1.
  struct Regime {
    int assist = 0;             ///< which side of the dead zone the bar's torque is on
    int clip = 0;               ///< which limit the motor is at
    std::array<int, 2> slip{};  ///< which way each mass turns; 0: friction holds it
  };
  /// How far the state is inside its regime; below 0 it has left it.
  struct Margins {
    double assist;
    double clip;
    std::array<double, 2> slip;  ///< of each mass
    [[nodiscard]] bool inside() const { return assist >= 0 && clip >= 0 && slip[kWheel] >= 0 && slip[kColumn] >= 0; }
  };

  [[nodiscard]] double bar_nm(const State& x) const;
  [[nodiscard]] double asked_of_motor_nm(double tau, double bar) const;
  [[nodiscard]] double motor_nm(double tau, double bar) const;
  [[nodiscard]] double dry_nm(Mass mass) const {
    return mass == kWheel ? column_.wheel_friction_nm : column_.rack_friction_nm;
  }
  [[nodiscard]] bool held(Mass mass) const { return dry_nm(mass) > 0 && regime_.slip[mass] == 0; }
  [[nodiscard]] double pull_nm(Mass mass, double tau, const State& x) const;
  [[nodiscard]] double friction_nm(Mass mass, double pull) const;
  [[nodiscard]] double acceleration_rad_s2(Mass mass, double tau, const State& x) const;
  [[nodiscard]] State slope(double tau, const State& x) const;
  [[nodiscard]] State after(double tau, double h) const;
  [[nodiscard]] Margins margins(double tau, const State& x) const;
  [[nodiscard]] bool kinked() const { return column_.assist_gain > 0 && column_.assist_dead_zone_nm > 0; }
  [[nodiscard]] double fastest_per_s(double span_s) const;
  void classify();
  void settle_at_rest(Mass mass, double tau);
  double step(double tau, double h, int& events);

  Column column_;
  ColumnInputs inputs_;
  State x_{};
  Regime regime_;
  int refinement_ = 1;
};

}  // namespace steerid
