// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// J, B and C over time, of a record whose arm changes: what an offline look knows better than a recursive one.
//
//   torque = J(t) th'' + B(t) th' + C(t) th + constant + v        (fit/instrumented_rows.hpp)
//
// B and C wander, the constant stays. How fast B and C wander is what makes the record likeliest; the record says
// that they change when that is likelier than an arm that stays by kSurelyChanges (fit/random_walk.hpp has the
// smoothing). J wanders too, as with a hand that comes or leaves, where that is likelier still by kSurelyInertia. The
// instrument stands where th does, and the rest of th is subtracted with the arm of the round before,
//
//   y - (phi - z)' p_before = z' p + v,
//
// so that what settles solves the equations of instrumental variables, and no driver's torque is taken for stiffness.
// How the source moves the wheel is learned within 20 s around each part, since the arm's change changes it. v's colour
// is found anew with every round.
//
// Where the driver's own torque is not measured and no probe is there, nothing is said: a driver who begins to steer
// would look like an arm that changes. Nothing is said either where the probe has driven nothing that stands out of the
// noise, where neither B nor C is valid of an arm that stays, or where one of its numbers is negative.
//
// An arm that stays but is stiffer to one side looks like one that changes as the driver turns from side to side: a
// torque by th^2 beside J, B and C is held against the same rows, by its instrument th z less what a number costs
// (Schwarz), (log rows)/2 nats.
//
// Not modelled: steps, which a walk rounds off by some 0.3 s.
//
// Cost: a filter for each of 144 pairs of rates, twice where J wanders, four times; about a second for 80 s of record.
#pragma once

#include <optional>
#include <vector>

#include "fit/model_check.hpp"
#include "log/record.hpp"

namespace steerid {

struct VaryingArm {
  /// Twice the logarithm of the likelihood ratio from which an arm changes: one in a hundred that stay has more. Two
  /// variances on their boundary: a quarter of chi^2 of 0, half of 1, a quarter of 2 degrees of freedom (Self and Liang
  /// 1987, J. American Statistical Association 82).
  static constexpr double kSurelyChanges = 7.29;

  /// Likewise of J beside them: one variance on its boundary, half of chi^2 of 0 and half of 1 degree of freedom. Of 40
  /// drives whose J stays none had more than 3.9.
  static constexpr double kSurelyInertia = 5.41;
  /// The same where the driver's torque is known, one in a million: what walks leave of steps of B and C is more than
  /// the noise there. Such drives had 8.7 at most in the last round; hands that come and leave have 100 to 2700.
  static constexpr double kSurelyInertiaKnown = 22.6;

  /// One number over time.
  struct Course {
    std::vector<double> value;
    std::vector<double> sd;
  };

  bool compared = false;  ///< false where the driver may look like a change, or the record shows no arm
  bool changes = false;
  double likelihood_ratio = 0;      ///< twice its logarithm, the best walk over an arm that stays
  double inertia_per_root_s = 0;    ///< how far J wanders within a second, rms, kg m2; 0: it stays
  double damping_per_root_s = 0;    ///< likewise B, Nms/rad
  double stiffness_per_root_s = 0;  ///< likewise C, Nm/rad
  [[nodiscard]] bool inertia_changes() const { return inertia_per_root_s > 0; }
  /// What makes the record likelier by the same rows, of an arm that stays: a change that is likelier than it is told.
  std::optional<Alternative> stays_otherwise{};
  std::vector<double> time_s;  ///< 25 a second; empty when nothing is said
  Course inertia;              ///< kg m2
  Course damping;              ///< Nms/rad
  Course stiffness;            ///< Nm/rad
};

/// `record` is at 100 Hz. Without a change time_s is empty.
[[nodiscard]] VaryingArm fit_varying_arm(const Record& record);

}  // namespace steerid
