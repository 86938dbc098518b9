// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The wheel and arm with any list of effects, integrated in double under torques that are cubic polynomials in time.
//
//   inertia th'' = T_driver - T_motor + effects - B th' - C th - dry friction
//
// Torques that depend on the time alone are a cubic in each piece, as the applied ones are. While the plant is linear
// (no effect in it but these and compliance) every piece is one exact step (plant/linear_response.hpp), whose matrices
// come from the same lines as everything else. So it is while the bristles of a dry friction bend: they are by far the
// stiffest spring, everything else is nearly constant meanwhile, and the wheel swings on them faster than the torques
// change. And so it is where more than two steps a piece would be needed otherwise, as long as the torques that the
// wheel meets on its way are a cubic in time (plant/plant_nearly_linear.cpp, docs/adr/0017). Otherwise a piece is
// divided into equal steps of the classical Runge-Kutta method of order four, as many as keep step * rate below
// kStepAngle, where the rate bounds how fast wheel and effects can be. What takes part in passing (bristles of a
// friction until it slips, a loop until it is developed, what the wheel's rate makes of a course over the angle) counts
// while it does, and the steps are chosen anew after each. What is faster than the drive counts as its square root
// only. Fourth order needs a smooth right side, so no step crosses a kink:
//   times at which an effect jumps   known beforehand, steps end there
//   rest, slip, and where another of an effect's laws begins (a gap is closed, an arm lifts off)
//                                    found as the root of the step's Hermite cubic (rest and laws polished by one
//                                    Newton step); the step is repeated up to there and the event is set exactly
// and everything that switches (direction of motion, an effect's law, phase in time) is frozen during a step.
//
// Friction really holds. Dry friction is a set: at rest it is whatever torque balances the others, up to the breakaway
// level. At rest the wheel is therefore not integrated at all; it stays where it is, to the last bit, until the other
// torques exceed the level, and the instant at which they do is found as a root. There is no smoothed sign function, so
// no creep at rest, no chatter around it and no stiff slope that would force small steps. (Event-driven integration of
// a differential inclusion, Filippov 1988; for friction Karnopp 1985 without his band of rest.)
//
// A run that diverges (a softening spring driven past its balance) is not a number from there on.
//
// Cost of a second at 100 Hz: 1 to 3 us while the plant is linear, 7 to 23 us with another effect, 34 to 73 us where
// two make it fast (docs/benchmarks.md). Nothing allocates after the constructor.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "plant/cubic.hpp"
#include "plant/effects/effect.hpp"
#include "plant/linear_response.hpp"

namespace steerid {

class Plant {
 public:
  /// Throws BadInput when the effects contradict each other. Effects that act on the record only are passed over.
  Plant(std::span<const Effect> effects, const RunSetting& setting);

  /// Begins a run at `time_s` (since the origin) with the effects' own states settled.
  void start(double time_s, const WheelState& state);

  /// Goes on by `span_s` under torques whose polynomials have their origin at the present.
  void advance(const Cubic& driver, const Cubic& motor, double span_s);

  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] WheelState state() const { return {state_[0], state_[1]}; }
  /// True while dry friction holds the wheel.
  [[nodiscard]] bool held() const { return dry_ && direction_ == 0; }

  /// How fast it is at most in a brisk movement that is nowhere faster than `rate_rad_s`, 1/s; 0 while it is linear.
  [[nodiscard]] double fastest_per_s(double rate_rad_s) const;

  /// Steps that a second of it may take, exact ones and others; 0 while it is linear. What is stiff takes many: a large
  /// stiffness or damping over a small inertia.
  [[nodiscard]] double most_steps_per_s() const;

  /// Divides every piece, so that all its steps are shorter: 2 halves them. For convergence studies.
  void refine(int factor) { refinement_ = factor; }

 private:
  static constexpr std::size_t kMaxStates = 16;
  static constexpr double kStepAngle = 0.2;  // measured: tests/unit/plant_convergence_test.cpp
  static constexpr int kMostEvents = 64;     // in one step; beyond, the step is taken as it is
  using State = std::array<double, kMaxStates>;
  using LinearState = std::array<double, 4>;  // of a plant that a LinearStep takes
  static constexpr int kThirds = 3;           // of a piece, between instants at which torques are known
  using Thirds = std::array<LinearState, kThirds + 1>;

  struct Part {
    std::unique_ptr<PlantEffect> effect;
    PlantTraits traits;
    std::size_t first_state = 0;
    int region = 0;
    int slips = 0;
    [[nodiscard]] bool bends() const { return traits.bends() && slips == 0; }
  };

  /// What cuts a step short.
  struct Event {
    enum class Kind { kNone, kRest, kBreakaway, kSlip, kRegion } kind = Kind::kNone;
    double after_s = 0;
    int sign = 0;            // breakaway and slip: the direction; region: its change
    std::size_t part = 0;    // slip and region: whose
    double left_per_s = -1;  // region: how fast what is left of it falls
  };

  /// Where a step leads, with what it would go on by.
  struct StepEnd {
    State state;
    State slope;
    Balance balance;
  };

  /// The exact step that pieces of one span are made of.
  struct PieceStep {
    double span_s = 0;
    int count = 1;
    double stiffness_nm_per_rad = 0;
    std::optional<LinearStep> step;
  };

  /// How far a wheel went, how fast forward and backward, and by how much that changed from step to step.
  struct Reach {
    double highest_rad = 0;
    double lowest_rad = 0;
    double forward_rad_s = 0;
    double backward_rad_s = 0;
    double change_rad_s = 0;
    explicit Reach(const LinearState& from);
    void include(const LinearState& from, double h, const LinearState& to);
    [[nodiscard]] double fastest_rad_s() const { return std::max(forward_rad_s, backward_rad_s); }
  };

  /// The torque that exact steps met beside the applied ones in the last piece that they led through, going on from
  /// its end: a first guess.
  struct Met {
    const PieceStep* beside = nullptr;  ///< which exact steps; null: none yet, or the last ones led nowhere
    Cubic torque;
  };

  [[nodiscard]] Instant instant(double time_s, const State& x, const Part& part) const;
  double derivative(double time_s, const State& x, State& dx) const;
  double derivative(double time_s, const State& x, State& dx, Balance& balance) const;
  [[nodiscard]] double level_nm(int direction, double speed_rad_s) const;
  template <std::size_t Count>
  void runge_kutta_of(double h, State& next) const;
  void runge_kutta(double h, State& next) const;
  void choose_direction();
  [[nodiscard]] LinearStep linear_step(double span_s, double stiffness_nm_per_rad);
  void advance_piece(const Cubic& driver, const Cubic& motor, double span_s);
  void advance_linearly(double span_s);
  bool advance_while_bending(double span_s);
  bool advance_while_slipping(double span_s);
  bool advance_while_moving(double span_s);
  Reach walk(const PieceStep& by, Cubic torque, Thirds& at) const;
  template <class Stays>
  bool walk_nearly_linear(const PieceStep& by, Thirds& at, Stays stays);
  void prepare(PieceStep& step, double span_s, int count, double stiffness_nm_per_rad);
  template <class X>
  void take_step(const LinearStep& step, const Cubic& torque, X& x) const;
  [[nodiscard]] Cubic torque_at_zero(double span_s, bool (*of)(const PlantTraits&)) const;
  [[nodiscard]] Cubic torque_in_time(double span_s) const;
  [[nodiscard]] Cubic push(double span_s) const;
  [[nodiscard]] double push_at(double time_s, const LinearState& x, double stiffness_nm_per_rad) const;
  [[nodiscard]] bool all_bend(const Reach& reach) const;
  [[nodiscard]] bool moves_on(const Reach& reach) const;
  [[nodiscard]] int steps_while_bending(double span_s) const;
  void set_pace();
  [[nodiscard]] double present_per_s() const;
  void step(double target_s, int& events);
  [[nodiscard]] Event first_event(const State& next, double h);
  [[nodiscard]] double rest_after(const State& next, double h) const;
  [[nodiscard]] double breakaway_after(double h, int sign);
  [[nodiscard]] double slip_after(const State& next, double h, const Part& part) const;
  void begin_to_slip();
  [[nodiscard]] double left_in_region(double time_s, const State& x, const Part& part, int way) const;
  [[nodiscard]] double left_in_region(double time_s, const StepEnd& at, const Part& part, int way) const;
  [[nodiscard]] Event leaves_region(const StepEnd& end, double h, std::size_t part, int way) const;
  void enter_region(Part& part, int change);
  void take(const Event& event);
  void accept(const State& next, double time_s);
  [[nodiscard]] double coming_jump_s();
  [[nodiscard]] int steps(double span_s, double fastest_per_s) const;

  WheelArm wheel_;
  double per_inertia_;
  std::vector<Part> parts_;
  std::size_t states_ = 2;
  bool linear_plant_ = true;    // every effect is, bristles while they bend, and LinearStep takes that many states
  bool bends_ = false;          // bristles do, and the rest is linear or nearly so meanwhile
  bool slips_steadily_ = true;  // and is linear again while they slip
  bool in_time_ = false;        // some torque depends on the time alone
  bool dry_ = false;
  bool turns_at_rest_ = false;
  bool divided_ = false;  // some effect is
  bool varies_ = false;   // how fast it is depends on the state:
  double bent_stiffness_nm_per_rad_ = 0;
  double fastest_per_s_ = 0;    // of these:
  double swing_per_s_ = 0;      // what springs and the effects' own states make,
  double damped_per_s_ = 0;     // what damping makes,
  double damped_per_rad_ = 0;   // and with the rate of the wheel
  double engaged_per_s_ = 0;    // as far as steps have to resolve it, with all that takes part in passing,
  double apart_per_s_ = 0;      // with none of it,
  double fastest_per_rad_ = 0;  // and with the rate of the wheel
  int refinement_ = 1;

  double time_s_ = 0;
  State state_{};  // angle, rate, then the effects' own
  State slope_{};  // at the start of the step
  int direction_ = 1;
  double step_middle_s_ = 0;
  double next_jump_s_ = 0;

  double piece_start_s_ = 0;
  Cubic driver_;  // with the torques that depend on the time alone
  Cubic motor_;
  PieceStep free_;  // with no bristles bent
  PieceStep bent_;
  PieceStep moving_;  // likewise without, where not all is linear
  Met met_;
};

}  // namespace steerid
