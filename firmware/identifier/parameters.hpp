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

/// What the identifier is told of the machine. The defaults are a steering wheel held by a driver; a host that feeds
/// it another machine (a linear drive, an ankle) sets its own.
template <class Scalar>
struct Prior {
  Vector3<Scalar> value{Scalar(0.08), Scalar(1.5), Scalar(15)};       ///< start of the search
  Vector3<Scalar> spread{Scalar(0.1), Scalar(2), Scalar(30)};         ///< one standard deviation of the start
  Vector3<Scalar> lowest{Scalar(0.005), Scalar(0.01), Scalar(0.01)};  ///< physical limits; all positive, so that the
  Vector3<Scalar> highest{Scalar(0.6), Scalar(15), Scalar(300)};      ///< model stays stable

  /// The same machine with its torque counted in another unit, or another machine of the same kind whose inertia is
  /// `factor` times a wheel's: J, B and C are all proportional to it.
  [[nodiscard]] Prior scaled(Scalar factor) const {
    return {value * factor, spread * factor, lowest * factor, highest * factor};
  }
};

}  // namespace steerid
