// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The steering column below the driver's arm, as numbers and as a file, and the drive's torques that act on it.
//
//   above the torsion bar   J th'' + B th' + C th + wheel friction = Tv - Tbar      arm and wheel, angle th
//   wheel alone             Jw th'' + Bw th' + wheel friction = Trim - Tbar         the hand's torque is Trim
//   torsion bar             Tbar = kt (th - ph) + bt (th' - ph')
//   below it                Jc ph'' + Bc ph' + Cr ph + rack friction = Tbar + Tmotor + Troad
//   motor                   Tmotor = assist(Tbar) + probe, no more than its limit either way
//   assist                  gain times what of Tbar lies beyond the dead zone
//
// All torques are positive counter-clockwise. Everything below the bar (column, motor and rack) is seen at the column:
// divided by the squares of the gears' ratios. Both frictions are dry: of one size, against the motion of the wheel or
// of the column, and at rest whatever holds it, up to that size.
//
// The file, JSON; every key may be left out and then has the value below:
//
// | key                              | value | range       | what it is                                             |
// | wheel_inertia_kgm2               | 0.034 | 0.001 to 1  | Jw of the wheel alone; part of the arm's J             |
// | wheel_damping_nms_per_rad        | 0.055 | 0 to 10     | Bw of the wheel alone; part of the arm's B             |
// | wheel_friction_nm                | 0     | 0 to 20     | dry friction of bearing, slip ring, seal above the bar |
// | bar_stiffness_nm_per_rad         | 150   | 10 to 1e4   | kt; 2.6 Nm/degree                                      |
// | bar_damping_nms_per_rad          | 0.1   | 0 to 10     | bt                                                     |
// | column_inertia_kgm2              | 0.11  | 0.005 to 10 | Jc, motor, column and rack                             |
// | column_damping_nms_per_rad       | 0.85  | 0 to 100    | Bc                                                     |
// | aligning_stiffness_nm_per_rad    | 16    | 0 to 1e3    | Cr: what the tyres' self-aligning torque adds          |
// | rack_friction_nm                 | 0.75  | 0 to 20     | dry friction of rack and column                        |
// | assist_gain                      | 2     | 0 to 20     | motor's Nm a Nm of bar beyond the dead zone            |
// | assist_dead_zone_nm              | 0.35  | 0 to 10     | bar torque below which the assist does nothing         |
// | motor_limit_nm                   | 50    | 0.1 to 1e3  | the largest torque of the motor at the column          |
// | probe_gain                       | 1     | 0 to 10     | what the motor makes of a probe that is asked for      |
// | probe_delay_s                    | 0     | 0 to 0.1    | how much later                                         |
// | road_rms_nm                      | 0.2   | 0 to 20     | torque of the road, rms                                |
// | road_corner_hz                   | 3     | 0.01 to 15  | flat below, 40 dB a decade down above                  |
// | sensors                          |       |             | sensors/sensors_json.hpp                               |
//
// Where the values come from: inertias, dampings, stiffnesses, friction, gain, dead zone and road are in the middle of
// what sixteen recorded drives of a passenger car's column (an independent simulation) were drawn from: kt 92 to 196,
// Jc .06 to .14, Bc .4 to 1.2, Cr 6 to 25, friction .3 to 1.2 Nm, gain .8 to 3.6, road .03 to .3 Nm, Jw .026 to .043,
// Bw .03 to .08. The bar's damping, the road's corner and the motor's limit are assumed: with 0.1 Nms/rad the swing of
// the wheel on the bar has a damping ratio of 0.02; 50 Nm do not clip an ordinary drive. None of those drives has
// friction above the bar; in real columns 0.05 to 1 Nm are assumed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace steerid {

struct Column {
  double wheel_inertia_kgm2 = 0.034;
  double wheel_damping_nms_per_rad = 0.055;
  double wheel_friction_nm = 0;
  double bar_stiffness_nm_per_rad = 150;
  double bar_damping_nms_per_rad = 0.1;
  double column_inertia_kgm2 = 0.11;
  double column_damping_nms_per_rad = 0.85;
  double aligning_stiffness_nm_per_rad = 16;
  double rack_friction_nm = 0.75;
  double assist_gain = 2;
  double assist_dead_zone_nm = 0.35;
  double motor_limit_nm = 50;
  double probe_gain = 1;
  double probe_delay_s = 0;
  double road_rms_nm = 0.2;
  double road_corner_hz = 3;
  std::string sensors_json{};  ///< the object under "sensors", empty when there is none

  static constexpr double kLongestProbeDelayS = 0.1;

  /// Throws BadInput, one sentence with the file and the place in it. `name` stands for the text in messages.
  static Column from_json(std::string_view text, std::string_view name);
  static Column load(const std::filesystem::path& file);
  /// What from_json() reads back unchanged.
  [[nodiscard]] std::string to_json() const;
  /// The usual column, each number with its range in a comment.
  [[nodiscard]] static std::string commented();
};

}  // namespace steerid
