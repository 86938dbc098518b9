// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Drives of a whole steering column that the project's own plant, driver and sensors have no part in: to hold out.
//
// The physics above the torsion bar is that of docs/theory.md, since it defines J, B and C. All else is other than in
// plant/column.hpp and experiment/drive_task.hpp, on purpose:
//
//   friction   bristles that bend before they slip (Dahl 1968) instead of a set; above the bar where it is asked for
//   assist     a smooth curve, gain T^3 / (T^2 + d^2), behind a first-order lag; the motor saturates softly
//   probe      20 to 40 tones that have no common period, 0.15 to 7 Hz, stronger below; late, and weaker than asked
//   road       noise behind one low pass, and bumps
//   driver     a train of pulses at random instants (intermittent control) whose spectrum is Campbell's theorem's:
//              the intended angle has the density 2 rate E[a^2] (e tau)^2 / (1 + (2 pi f tau)^2)^2, one-sided
//   arm        J, B and C drawn apart; changes approach their end as a first-order lag does, or swing as two tones; B
//              follows C with a power of 0.2 to 0.8
//   sensors    offsets, coarse steps, an angle up to 0.5 ms late, instants that jitter
//   integration  Dormand and Prince's pair, tolerance 1e-6
//
// Cost: some 50 ms for a drive of 60 s.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "log/record.hpp"

namespace steerid::blind {

/// Once in a drive of a minute, or, for drives of ten minutes, again and again.
enum class ArmCourse : std::uint8_t {
  kStays,
  kChanges,     ///< C by 1.3 to 4 up or down, 95 % within 2 to 20 s; in half of the drives back again
  kSwings,      ///< C, two tones, periods of 3 to 40 s
  kSecondHand,  ///< J by 10 to 30 %, B and C by 15 to 60 % more
  kHandsLeave,  ///< for 8 to 15 s
  kWanders,     ///< C by 15 % rms, periods of 15 to 120 s
  kBraces,      ///< C by 1.5 to 4 every 95 s, for 10 to 25 s
  kHandsCome,   ///< a second hand for half of every 150 s
  kWarmsUp,     ///< B falls by 40 % within ten minutes
  kOrdinary     ///< wanders, braces, second hands, and hands off for 8 s every 200 s
};

struct ColumnRequest {
  ArmCourse course = ArmCourse::kStays;
  double steering_rad = 0.1;  ///< the intended angle, rms; less where it would take more than 4 Nm rms
  double probe_nm = 1;        ///< rms
  double duration_s = 60;
  double period_s = 0.01;        ///< between two rows
  double wheel_friction_nm = 0;  ///< dry friction above the bar, of a bearing or a seal
  bool by_probe = true;  ///< whether the motion by the probe is worked out, at the price of two more simulations
};

struct ColumnTruth {
  double inertia_kgm2 = 0;
  double damping_nms_per_rad = 0;
  double stiffness_nm_per_rad = 0;
  double voluntary_nm = 0;
};

struct DrawnColumnDrive {
  Record record;                     ///< angle, torque_bar, torque_motor, torque_rim and probe
  std::vector<ColumnTruth> truth;    ///< of each row
  std::vector<double> by_probe_rad;  ///< half of what the probe's sign makes of the angle, at k * period_s; or empty
  double torque_noise_nm = 0;        ///< of the bar, its steps included
  double angle_noise_rad = 0;        ///< likewise
  std::function<double(double hz)> intent_rad2_per_hz;  ///< one-sided density of the intended angle
};

/// Drive `number` of `seed`.
[[nodiscard]] DrawnColumnDrive draw_column_drive(const ColumnRequest& request, std::uint64_t seed,
                                                 std::uint64_t number);

}  // namespace steerid::blind
