// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How an arm may change: the forgetting rule of arm_modes.hpp, as numbers. Another rule is another table of this file,
// and its name in kWalksByProbe or kWalksByTorque, from which all others take it.
//
//   by the probe   C     B     J      left
//   stays          1     0.3   0.1    to moves 0.03/s, to exchanged 0.02/s
//   moves          25    14    0.1    to stays 0.1/s, to exchanged 0.02/s
//   exchanged      100   32    100    to stays 2/s
//
//   by the torque  C     B     J      left
//   stays          1     2     1      to moves 0.1/s, to exchanged 0.02/s
//   moves          25    14    6      to stays 0.3/s, to exchanged 0.02/s
//   exchanged      100   32    100    to stays 2/s
//
// in percent per square root of a second (B in addition to half of C's). The rates are set by hand. By the probe: a
// change every half minute that takes ten seconds, as the drives of docs/testing.md have them, and another grip every
// minute (docs/adr/0006). By the torque, where all of it is known: a change every ten seconds that takes three; a look
// shows B and J ten times as well there, and their walks may be as large as to follow a doubling of B within 30 s and a
// second hand's J within one (docs/adr/0005).
#pragma once

namespace steerid {

inline constexpr int kArmStays = 0, kArmMoves = 1, kArmModes = 3;  ///< stays, moves, exchanged

/// Variances a look, of relative changes; and the probability a look of going over into each mode.
template <class Scalar>
struct ArmWalk {
  Scalar stiffness, damping_with_it, damping, inertia;
  Scalar to[kArmModes];
};

template <class Scalar>
struct ArmWalks {
  ArmWalk<Scalar> of[kArmModes];
  /// Where the likelihood of a look ends: so far above that of the likeliest mode, or of a residual of zero. The former
  /// tells the modes apart under a change that none of them explains; by the probe it was not measured.
  bool ends_above_likeliest;

  static constexpr double kPeriod_s = 0.04;  ///< from one look to the next
  static constexpr double a_look(double per_s) { return per_s * kPeriod_s; }
  static constexpr ArmWalk<Scalar> kExchanged{Scalar(a_look(1.0)),
                                              Scalar(0.5),
                                              Scalar(a_look(0.1)),
                                              Scalar(a_look(1.0)),
                                              {Scalar(a_look(2)), Scalar(0), Scalar(a_look(-2))}};
  /// For an arm that is seen by the probe, beside a driver who steers.
  static constexpr ArmWalk<Scalar> kStaysByProbe{Scalar(a_look(1e-4)),
                                                 Scalar(0.5),
                                                 Scalar(a_look(1e-5)),
                                                 Scalar(a_look(1e-6)),
                                                 {Scalar(a_look(-0.05)), Scalar(a_look(0.03)), Scalar(a_look(0.02))}};
  static constexpr ArmWalk<Scalar> kMovesByProbe{Scalar(a_look(0.0625)),
                                                 Scalar(0.5),
                                                 Scalar(a_look(0.02)),
                                                 Scalar(a_look(1e-6)),
                                                 {Scalar(a_look(0.1)), Scalar(a_look(-0.12)), Scalar(a_look(0.02))}};
  /// Where all torque is known.
  static constexpr ArmWalk<Scalar> kStaysByTorque{Scalar(a_look(1e-4)),
                                                  Scalar(0.5),
                                                  Scalar(a_look(4e-4)),
                                                  Scalar(a_look(1e-4)),
                                                  {Scalar(a_look(-0.12)), Scalar(a_look(0.1)), Scalar(a_look(0.02))}};
  static constexpr ArmWalk<Scalar> kMovesByTorque{Scalar(a_look(0.0625)),
                                                  Scalar(0.5),
                                                  Scalar(a_look(0.02)),
                                                  Scalar(a_look(4e-3)),
                                                  {Scalar(a_look(0.3)), Scalar(a_look(-0.32)), Scalar(a_look(0.02))}};
};

template <class Scalar>
inline constexpr ArmWalks<Scalar> kWalksByProbe{
    {ArmWalks<Scalar>::kStaysByProbe, ArmWalks<Scalar>::kMovesByProbe, ArmWalks<Scalar>::kExchanged}, false};
template <class Scalar>
inline constexpr ArmWalks<Scalar> kWalksByTorque{
    {ArmWalks<Scalar>::kStaysByTorque, ArmWalks<Scalar>::kMovesByTorque, ArmWalks<Scalar>::kExchanged}, true};

}  // namespace steerid
