// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What makes a real wheel differ from J th'' + B th' + C th = T_driver - T_motor: the effects, one small file each.
//
// An effect is stated once. Its file holds its id (the vocabulary of the gap diagnosis), its parameters with units,
// presets and physical ranges, and what it does. The same lines serve
//   a streaming simulation   Plant and Recorder, one period at a time,
//   a replay                 FreeRun on a recorded log (`steerid simulate --replay`), and
//   a fit by output error    FreeRun again, thousands of times with other parameter values.
//
// An effect acts in the plant, on the record, or both:
//   PlantEffect   torque and changes of the linear terms at an instant, plus states of its own
//   RecordEffect  between what happened and what was written down, in both directions
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plant/wheel_arm.hpp"

namespace steerid {

/// What a fit knows of a number before a record, in its unit; it decides where the record says little. Set by hand,
/// after the sources that the effect's file names.
struct ParameterPrior {
  double mean = 0;
  double sd = 0;                                          ///< 0: nothing is known but the range
  double low = -std::numeric_limits<double>::infinity();  ///< a fit's range, where a simulation's is wider
  double high = std::numeric_limits<double>::infinity();
};

/// One number of an effect, as JSON, a fit and a report name it.
struct Parameter {
  std::string_view name;  ///< carries its unit: `friction_nm`
  double preset;          ///< taken when none is given; clearly visible on a typical drive
  double low;             ///< physical range, both ends included
  double high;
  double scale;           ///< a change worth noticing: first step of a fit, yardstick of its convergence
  std::string_view says;  ///< a few words for messages and reports
  ParameterPrior prior{};
  bool whole = false;  ///< a choice or a count: whole numbers only, a fit enumerates it
};

/// What an effect may know about the run it takes part in.
struct RunSetting {
  WheelArm wheel;
  /// A replay follows a record, so nothing may be drawn at random: a seeded torque is zero unless its time course is
  /// given, and lost samples are those that the record shows.
  bool replay = false;
  std::uint64_t seed = 0;  ///< of the seeded effects when not in a replay
};

// ---- in the plant ----

/// The plant at an instant. Quantities that jump are frozen over an integration step, which ends exactly where one of
/// them jumps; so an effect is smooth within a step and the integrator keeps its order.
struct Instant {
  double time_s;  ///< since the record's origin
  double angle_rad;
  double rate_rad_s;
  double step_middle_s;  ///< use this in place of time_s for whatever jumps at a time, see next_jump_s()
  int direction;         ///< frozen sign of rate_rad_s: +1, -1, 0 at rest; kept only if some effect asks for it
  int region;            ///< frozen: which of the effect's own laws holds, see PlantTraits::divided
  int slips;             ///< frozen: which way what bends slips, +1 or -1; 0 while it bends
};

/// Both sides of the torque balance. Effects change it in turn; what is left at the end gives the acceleration:
/// inertia * th'' = driver - motor + torque - damping * th' - stiffness * spring_angle - dry friction.
struct Balance {
  double inertia_kgm2;
  double damping_nms_per_rad;
  double stiffness_nm_per_rad;
  double spring_angle_rad;  ///< what the arm's spring feels; the wheel angle unless there is backlash
  double torque_driver_nm;
  double torque_motor_nm;
  double torque_nm;  ///< sum of the effects' own torques, positive like the driver's
};

/// An instant that does not come.
inline constexpr double kNever_s = std::numeric_limits<double>::infinity();

/// What the integrator must know beforehand.
struct PlantTraits {
  int states = 0;              ///< continuous states of its own
  bool acts = true;            ///< act() does something (purely dry friction leaves it out)
  bool dry = false;            ///< has dry friction, so the wheel can stick
  bool turns_at_rest = false;  ///< has a kink where the rate changes sign; so has all dry friction
  bool remembers = false;      ///< wants remember()
  bool linear = false;         ///< its act() is linear in the states and the torques, and the same at all times
  double bending_stiffness_nm_per_rad = 0;  ///< of a spring that slips where it is bent far enough; 0: none
  bool slips_steadily = false;              ///< and while it slips its torque is the same at any speed
  bool divides_arm = false;                 ///< gives the arm a motion of its own, by what the others make of its terms
  bool divided = false;                     ///< its law is another one in each of numbered regions of the state
  // Upper bounds that set the integration step. Zero where the effect makes the wheel no faster.
  double added_stiffness_nm_per_rad = 0;
  double passing_stiffness_nm_per_rad = 0;  ///< more of it, while engaged()
  double added_damping_nms_per_rad = 0;
  double damping_per_rate_nms2_per_rad2 = 0;  ///< more of it, times the wheel's rate
  double least_inertia_share = 1;             ///< of J, when it leaves less of it moving
  double fastest_per_s = 0;                   ///< rate constant of its own states or of how it changes in time
  double passing_per_s = 0;                   ///< a faster one, while engaged()
  double fastest_per_rad = 0;                 ///< of its course over the angle, while engaged(): times the wheel's rate
  bool in_time_only = false;                  ///< a torque that nothing but the time changes: a cubic in each piece

  [[nodiscard]] bool bends() const { return bending_stiffness_nm_per_rad > 0; }
  [[nodiscard]] bool takes_part_in_passing() const {
    return passing_stiffness_nm_per_rad > 0 || passing_per_s > 0 || fastest_per_rad > 0;
  }
};

class PlantEffect {
 public:
  virtual ~PlantEffect() = default;
  [[nodiscard]] virtual PlantTraits traits() const = 0;

  /// Own states and memory at the start of a run, as if the wheel had been like this for long.
  virtual void start(const Instant& /*now*/, double* /*own*/) {}
  /// Adds to the balance at this instant and says how fast its own states move.
  virtual void act(const Instant& /*now*/, const double* /*own*/, double* /*own_rate*/, Balance& /*balance*/) const {}
  /// Magnitude of its dry friction moving in `direction` at `speed`; at speed 0 the torque that it can hold.
  [[nodiscard]] virtual double dry_friction_nm(int /*direction*/, double /*speed_rad_s*/) const { return 0; }
  /// Whether what takes part in passing does so now. Where it does not, it may begin to only as the wheel comes to
  /// rest, or slowly.
  [[nodiscard]] virtual bool engaged(const Instant& /*now*/, const double* /*own*/) const { return true; }
  /// How far what bends() still does so in `way` (+1 or -1) before it slips, rad.
  [[nodiscard]] virtual double left_to_bend_rad(const Instant& /*now*/, int /*way*/) const { return 0; }
  /// Of what is divided: the region that it begins in.
  [[nodiscard]] virtual int first_region(const Instant& /*now*/) const { return 0; }
  /// How far this instant is within its region on the side of the next one (`way` +1) or the one before (-1), in a unit
  /// of the effect's; negative beyond. Balance and acceleration of the wheel are those of this region's law.
  [[nodiscard]] virtual double left_in_region(const Instant& /*now*/, const double* /*own*/, const Balance& /*balance*/,
                                              double /*acceleration_rad_s2*/, int /*way*/) const {
    return std::numeric_limits<double>::infinity();
  }
  /// Called where `now.region` begins: sets its own states, and returns the wheel's rate from there on.
  [[nodiscard]] virtual double enter_region(const Instant& now, double* /*own*/) const { return now.rate_rad_s; }
  /// The next time after `time_s` at which its course in time has a jump or a kink.
  [[nodiscard]] virtual double next_jump_s(double /*time_s*/) const { return kNever_s; }
  /// Called after every accepted step.
  virtual void remember(const Instant& /*now*/) {}
};

// ---- on the record ----

/// What the wheel did at one sampling instant; a RecordEffect turns it into what is written down.
struct Channels {
  double time_s = 0;  ///< since the record's origin
  double torque_driver_nm = 0;
  double torque_motor_nm = 0;
  double angle_rad = 0;
  double rate_rad_s = 0;  ///< of the angle channel; not recorded, kept so that channels can be shifted in time
};

/// A free run on the way to a predicted record, all samples at once. `first` is the index of the record's first sample;
/// samples before and after the record are there for the effects that reach beyond it.
struct Trajectory {
  std::span<const double> time_s;
  std::span<double> angle_rad;
  std::span<double> rate_rad_s;
  std::size_t first = 0;
  std::span<const double> recorded_angle_rad;  ///< of the record itself
};

class RecordEffect {
 public:
  virtual ~RecordEffect() = default;

  /// Converter effects come after the sensors' noise, the others before it.
  [[nodiscard]] virtual bool converter() const { return false; }

  /// Forward, streaming: turns the true channels into the recorded ones. Samples come in order of time.
  virtual void record(Channels& now) = 0;

  // Replay. The recorded torque back to what moved the wheel, and the wheel's angle on to what the record should show.

  /// What to add to the recorded T_driver at `time_s` to get the true one.
  [[nodiscard]] virtual double torque_correction_nm(double /*time_s*/) const { return 0; }
  /// True when torque_correction_nm() does something.
  [[nodiscard]] virtual bool corrects_torque() const { return false; }
  /// Repairs recorded torque samples in place.
  virtual void repair_torque(std::span<double> /*torque_nm*/) const {}
  /// True when repair_torque() may change some.
  [[nodiscard]] virtual bool repairs_torque() const { return false; }
  /// How far before or after an instant its record looks.
  [[nodiscard]] virtual double reach_s() const { return 0; }
  virtual void record(Trajectory& /*run*/) const {}
};

// ---- the type ----

struct Effect;

/// An effect of the vocabulary. Either factory may be null; `values` holds one number a parameter, in their order.
struct EffectType {
  std::string_view id;
  std::string_view says;  ///< one sentence
  std::span<const Parameter> parameters;
  std::unique_ptr<PlantEffect> (*in_plant)(std::span<const double> values, std::span<const double> time_course_nm,
                                           const RunSetting& setting) = nullptr;
  std::unique_ptr<RecordEffect> (*on_record)(std::span<const double> values, const RunSetting& setting) = nullptr;
  /// Other effects that together move the wheel in the same way, whatever drives it; null where there are none.
  std::vector<Effect> (*same_motion_as)(std::span<const double> values) = nullptr;
  /// The way back: the values that move the wheel as those others do, in their order; none where no values do.
  std::optional<std::vector<double>> (*values_of_same_motion)(std::span<const Effect> others) = nullptr;
  bool takes_time_course = false;  ///< its torque's course in time can be given, see unmeasured_torque.cpp
  /// It says how the arm joins the wheel, and so does every other effect with this mark: at most one of them at a time
  /// together with an effect that holds the joint alone.
  enum class Joint { kNone, kShares, kAlone } joint = Joint::kNone;
};

/// An effect with its numbers.
struct Effect {
  const EffectType* type = nullptr;
  std::vector<double> values;          ///< one a parameter of the type
  std::vector<double> time_course_nm;  ///< only where the type takes one

  Effect() = default;
  /// All parameters at their presets.
  explicit Effect(const EffectType& of);
  /// The value of the parameter called `name`; throws BadInput when the effect has none of that name.
  [[nodiscard]] double& at(std::string_view name);
  [[nodiscard]] double at(std::string_view name) const;
};

/// Builds the factory of a class whose constructor takes the values.
template <class Class>
std::unique_ptr<PlantEffect> plant_effect(std::span<const double> values, std::span<const double> /*time_course_nm*/,
                                          const RunSetting& /*setting*/) {
  return std::make_unique<Class>(values);
}
template <class Class>
std::unique_ptr<RecordEffect> record_effect(std::span<const double> values, const RunSetting& /*setting*/) {
  return std::make_unique<Class>(values);
}

}  // namespace steerid
