// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A driver on a whole column: what the hands mean to do, what the arm is like meanwhile, what probe and road add.
//
//   Tv = hold(t) C(t) theta(t)        theta is where the driver means the wheel to be: the manoeuvre, and beneath it
//                                     lane keeping, a process of second order with its corner at 0.3 Hz
//
// So Tv is flat up to 0.3 Hz and falls by 40 dB a decade above: 0.1 rad rms and an arm of 20 Nm/rad make 2 Nm rms, 94 %
// of its power below 0.5 Hz. No sensor sees it.
//
// The arm: C goes its course, and the arm's own B follows its root (co-contraction damps, too) unless it has a course
// of its own, as J may have (a second hand). Where the hands leave,
// arm and Tv fade within kLeaveS and what remains is the wheel alone; they come back within kReturnS.
//
// | course         | C                                                                    |
// | constant       | as it is                                                             |
// | step           | another from at_s on, within one tick                                |
// | ramp           | straight to another, from at_s on within length_s                    |
// | there_and_back | the same, and back in as long                                        |
// | swing          | from at_s on between both with the period length_s, the log a cosine |
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "experiment/manoeuvres.hpp"
#include "experiment/multisine.hpp"
#include "experiment/smooth_noise.hpp"
#include "plant/column.hpp"
#include "plant/column_plant.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

enum class ArmCourse { kConstant, kStep, kRamp, kThereAndBack, kSwing };

inline constexpr std::array<ArmCourse, 5> kAllArmCourses{ArmCourse::kConstant, ArmCourse::kStep, ArmCourse::kRamp,
                                                         ArmCourse::kThereAndBack, ArmCourse::kSwing};

/// As the command line spells it.
constexpr std::string_view name(ArmCourse course) {
  switch (course) {
    case ArmCourse::kConstant:
      return "constant";
    case ArmCourse::kStep:
      return "step";
    case ArmCourse::kRamp:
      return "ramp";
    case ArmCourse::kThereAndBack:
      return "there_and_back";
    case ArmCourse::kSwing:
      return "swing";
  }
  return "unknown";
}

struct ArmChange {
  ArmCourse course = ArmCourse::kConstant;
  double stiffness_nm_per_rad = 0;  ///< the other C; above 0 unless the course is constant
  double at_s = 20;
  double length_s = 5;  ///< above 0
  /// The other J and B of arm and wheel, where they go their own way: straight with the share of the course. Otherwise
  /// J stays, and the arm's own B follows the root of C.
  std::optional<double> inertia_kgm2{};
  std::optional<double> damping_nms_per_rad{};

  /// How much of the way to the other arm has been gone, 0 to 1.
  [[nodiscard]] double gone(double time_s) const;
  /// C at `time_s` of an arm that is `usual` otherwise.
  [[nodiscard]] double stiffness_at(double time_s, double usual_nm_per_rad) const;
  /// Arm and wheel at `time_s`; `wheel` is the wheel alone.
  [[nodiscard]] WheelArm arm_at(double time_s, const WheelArm& usual, const WheelArm& wheel) const;
};

/// The hands are off the wheel from at_s to at_s + length_s.
struct Release {
  double at_s = 0;
  double length_s = 0;
};

struct DriveSettings {
  WheelArm arm{};  ///< arm and wheel; heavier than the column's wheel
  Manoeuvre manoeuvre = Manoeuvre::kLaneKeeping;
  double steering_rad = 0.1;  ///< lane keeping's intended angle, rms; 0: the driver holds still
  ArmChange change{};
  std::vector<Release> releases{};  ///< in order of time, none within another
  MultisineSettings probe{};        ///< rms 0: no probe
  std::uint64_t seed = 1;

  static constexpr double kLeaveS = 0.15;
  static constexpr double kReturnS = 0.3;
};

/// What no sensor sees, at one tick.
struct DriveTruth {
  WheelArm arm;  ///< above the bar: arm and wheel
  double torque_driver_nm = 0;
};

/// Over one tick.
struct DriveTick {
  ColumnInputs inputs;   ///< the probe is not in them
  Cubic probe_asked_nm;  ///< what the EPS is asked to add
  DriveTruth truth;      ///< at the beginning
};

class DriveTask {
 public:
  /// Throws BadInput when the arm is not heavier than the wheel, or less damped.
  DriveTask(const DriveSettings& settings, const Column& column);

  /// The next tick; the first one begins at time 0.
  DriveTick next();

 private:
  struct Points {
    DriveTruth truth;
    SignalPoint voluntary;
    SignalPoint probe;
    SignalPoint road;
  };
  [[nodiscard]] Points next_points();
  [[nodiscard]] SignalPoint hold(double time_s);

  DriveSettings settings_;
  WheelArm wheel_;  // alone
  ManoeuvreCourse manoeuvre_;
  SmoothNoise lane_keeping_;
  SmoothNoise road_;
  Multisine probe_;
  std::size_t release_ = 0;  // the present or next one
  std::int64_t tick_ = 0;
  Points now_;
};

}  // namespace steerid
