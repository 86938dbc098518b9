// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The identifier of a wheel, whatever its sensors: one of two answers, by what is known of the driver's own torque.
//
//   known    the steady identifier (identifier.hpp): all the torque that acts on arm and wheel is measured
//   unknown  the identifier by the probe (closed_loop_identifier.hpp): a torsion bar or a rim transducer alone
//
// Units: Nm, rad, kg m2, Nms/rad, Nm/rad. Cost: that of the identifier which answers; memory that of both, since a
// wheel may lose its driver's channel while it runs.
#pragma once

#include "identifier/closed_loop_identifier.hpp"
#include "identifier/identifier.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

/// One sample, in Nm and rad.
template <class Scalar>
struct WheelSample {
  Scalar torque_nm{0};  ///< what is known of the torque on arm and wheel (port/equation.hpp)
  Scalar angle_rad{0};
  Scalar probe_nm{0};  ///< what the motor was asked to add for identification

  /// On a straight line from this one (share 0) to `to` (share 1).
  [[nodiscard]] WheelSample towards(const WheelSample& to, Scalar share) const {
    return {torque_nm + (to.torque_nm - torque_nm) * share, angle_rad + (to.angle_rad - angle_rad) * share,
            probe_nm + (to.probe_nm - probe_nm) * share};
  }
};

template <class Scalar>
class WheelIdentifier {
 public:
  /// `settings` are not copied, so that they can lie in flash: they have to live as long as the identifier does.
  explicit WheelIdentifier(const IdentifierSettings<Scalar>& settings = kSteeringWheel<Scalar>) : steady_(settings) {}
  explicit WheelIdentifier(const IdentifierSettings<Scalar>&& passing) = delete;

  /// Which of the two answers from now on. What was learned stays.
  void voluntary_torque_known(bool known) { known_ = known; }

  /// Back to the prior, everything forgotten.
  void restart() {
    steady_.restart();
    by_probe_.restart();
  }
  /// After a gap too long to bridge: the filters start again on the next samples, what was learned stays.
  void resettle() {
    steady_.resettle();
    by_probe_.resettle();
  }
  /// Goes on from what was known at power-off (Identifier::restore), whichever answers.
  void restore(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation, Scalar noise_nm) {
    steady_.restore(value, deviation, noise_nm);
    by_probe_.restore(value, deviation);
  }
  /// Takes in one sample; learn = false lets it through the filters without believing it.
  void update(const WheelSample<Scalar>& sample, bool learn = true) {
    if (known_) {
      steady_.update(sample.torque_nm, sample.angle_rad, learn);
    } else {
      by_probe_.update(sample.torque_nm, sample.angle_rad, sample.probe_nm, learn);
    }
  }

  [[nodiscard]] Vector3<Scalar> value() const { return known_ ? steady_.value() : by_probe_.value(); }
  [[nodiscard]] Scalar value(int parameter) const {
    return known_ ? steady_.value(parameter) : by_probe_.value(parameter);
  }
  /// One standard deviation of each parameter; never more than the prior's.
  [[nodiscard]] Vector3<Scalar> standard_deviation() const {
    return known_ ? steady_.standard_deviation() : by_probe_.standard_deviation();
  }
  [[nodiscard]] Belief belief(int parameter) const {
    return known_ ? steady_.belief(parameter) : by_probe_.belief(parameter);
  }
  /// Standard deviation of the whitened residual, Nm.
  [[nodiscard]] Scalar noise_nm() const { return known_ ? steady_.noise_nm() : by_probe_.noise_nm(); }
  /// That nobody holds the wheel, above a torsion bar and without the driver's torque: 0 to 1.
  [[nodiscard]] Scalar released() const { return by_probe_.released(); }
  [[nodiscard]] const Prior<Scalar>& prior() const { return steady_.prior(); }
  [[nodiscard]] bool sound() const { return steady_.sound() && by_probe_.sound(); }

  [[nodiscard]] const Identifier<Scalar>& steady() const { return steady_; }
  [[nodiscard]] const ClosedLoopIdentifier<Scalar>& by_probe() const { return by_probe_; }

 private:
  Identifier<Scalar> steady_;
  ClosedLoopIdentifier<Scalar> by_probe_;
  bool known_ = true;
};

}  // namespace steerid
