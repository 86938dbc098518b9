// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The three unknowns in their fixed order, and what is known of them before any data.
//
//   index  symbol  meaning                unit       range found in drivers (Lv et al. 2018, tables I and II)
//   0      J       inertia                kg m2      0.02 to 0.18
//   1      B       damping                Nms/rad    0.1  to 4.4
//   2      C       stiffness              Nm/rad     4.5  to 80.5
#pragma once

#include <Eigen/Core>

namespace steerid {

inline constexpr int kInertia = 0;
inline constexpr int kDamping = 1;
inline constexpr int kStiffness = 2;

template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

/// J, B and C of what is known beforehand. Eigen's own vector cannot be a constant of the program, which lies in flash
/// and takes no memory.
template <class Scalar>
struct Triple {
  Scalar of[3] = {};

  constexpr Triple() = default;
  constexpr Triple(Scalar inertia, Scalar damping, Scalar stiffness) : of{inertia, damping, stiffness} {}
  explicit(false) Triple(const Vector3<Scalar>& p) : of{p(0), p(1), p(2)} {}
  explicit(false) operator Vector3<Scalar>() const { return Vector3<Scalar>(of[0], of[1], of[2]); }

  constexpr const Scalar& operator()(int i) const { return of[i]; }
  constexpr Scalar& operator()(int i) { return of[i]; }
  constexpr Triple operator*(Scalar factor) const { return {of[0] * factor, of[1] * factor, of[2] * factor}; }
};

/// Arm and wheel of the least driver of those tables, and a wheel of 0.03 kg m2; accuracy in percent of less means
/// nothing.
template <class Scalar>
inline constexpr Triple<Scalar> kLeastArm{Scalar(0.05), Scalar(0.5), Scalar(4.5)};

/// What the identifier is told of the machine. The defaults are a steering wheel held by a driver; a host that feeds
/// it another machine (a linear drive, an ankle) sets its own.
template <class Scalar>
struct Prior {
  Triple<Scalar> value{Scalar(0.08), Scalar(1.5), Scalar(15)};       ///< start of the search
  Triple<Scalar> spread{Scalar(0.1), Scalar(2), Scalar(30)};         ///< one standard deviation of the start
  Triple<Scalar> lowest{Scalar(0.005), Scalar(0.01), Scalar(0.01)};  ///< physical limits; all positive, so that the
  Triple<Scalar> highest{Scalar(0.6), Scalar(15), Scalar(300)};      ///< model stays stable

  /// The same machine with its torque counted in another unit, or another machine of the same kind whose inertia is
  /// `factor` times a wheel's: J, B and C are all proportional to it.
  [[nodiscard]] constexpr Prior scaled(Scalar factor) const {
    return {value * factor, spread * factor, lowest * factor, highest * factor};
  }
};

/// The wheel without hands, above the torsion bar: no spring acts there, whatever the rack does; its spread is what the
/// step of an angle sensor makes look like one. The inertia's spread covers production wheels of 0.02 to 0.05 kg m2;
/// whoever has weighed his own sets it.
template <class Scalar>
struct BareWheel {
  Triple<Scalar> value{Scalar(0.035), Scalar(0.06), Scalar(0.01)};
  Triple<Scalar> spread{Scalar(0.008), Scalar(0.04), Scalar(0.05)};
  /// Nm, its dry friction above the bar (wheel_friction.hpp); with a rim transducer alone none is above the sensor.
  Scalar friction_nm{0};
};

}  // namespace steerid
