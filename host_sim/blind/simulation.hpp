// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The blind generator's wheel: event-driven, adaptive in its step, and written apart from host_sim/plant so that the
// two can be held against each other.
//
//   J th'' + B th' + C th = T_driver - T_motor, changed by the elements
//
// Sensors: angle and both torques pass equal second-order Butterworth filters, integrated with the wheel; then come
// white noise and resolution. Steps end at every sample, at every event and at every announced time, so that nothing
// that is written down is interpolated.
//
// Cost: about 60 ms for a drive of 100 s; dry friction doubles it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "blind/element.hpp"
#include "blind/signal.hpp"
#include "log/record.hpp"

namespace steerid::blind {

struct Arm {
  double inertia_kgm2 = 0;
  double damping_nms_per_rad = 0;
  double stiffness_nm_per_rad = 0;
};

/// What moves the wheel. Driver and motor are measured; `unseen` acts like the driver's torque but no sensor sees it.
struct Torques {
  Signal driver;
  Signal motor;
  Signal unseen;
};

struct Sensors {
  double corner_hz = 40;
  double driver_noise_nm = 0;  ///< standard deviation of a sample
  double motor_noise_nm = 0;
  double angle_noise_rad = 0;
  double driver_step_nm = 0;  ///< resolution; 0 is none
  double motor_step_nm = 0;
  double angle_step_rad = 0;
};

using Elements = std::vector<std::unique_ptr<Element>>;

struct Run {
  double lead_in_s = 8;  ///< of the drive, before the record, from rest
  double duration_s = 60;
  double rate_hz = 100;
  double relative_tolerance = 1e-8;
  double absolute_tolerance = 1e-10;
};

struct Drive {
  Record record;
  std::size_t events = 0;  ///< corners found
  std::size_t steps = 0;   ///< taken
};

/// `seed` is of the sensors' noise and of elements that convert by chance. Throws std::runtime_error when the wheel
/// runs away or an element's modes do not settle.
[[nodiscard]] Drive simulate(const Arm& arm, const Torques& torques, const Elements& elements, const Sensors& sensors,
                             const Run& run, std::uint64_t seed);

}  // namespace steerid::blind
