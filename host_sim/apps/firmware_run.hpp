// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The firmware's 100 Hz task over a record: the very loop that is flashed, on the replayed back end.
//
// The identifier is told of a steering wheel: its prior, its limits and the port's integers suit one. A record of
// another machine (a linear drive of 95 kg) is counted in other units, powers of ten, so that it looks like a wheel;
// the answers come out in SI all the same. Only the decade of the machine's inertia is used (apps/first_look.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "log/record.hpp"
#include "port/estimate.hpp"

namespace steerid {

/// The arithmetic that the identifier is compiled for.
enum class Scalar : std::uint8_t {
  kFloat,   ///< as on a microcontroller with a floating-point unit
  kFixed,   ///< as on one without: integers only (base/fixed.hpp)
  kDouble,  ///< the reference
};

/// How many Nm one of the port's newton metres stands for, and rad one of its radians. Powers of ten.
struct PortUnits {
  double torque_nm = 1.0;
  double angle_rad = 1.0;

  /// Of J, B and C.
  [[nodiscard]] double parameter() const { return torque_nm / angle_rad; }
  /// Whether the machine is one that a driver holds: the firmware tells of a driver whatever it is fed.
  [[nodiscard]] bool steering_wheel() const { return parameter() == 1.0; }
};

/// For a machine of this inertia: 1 and 1 within the identifier's limits for a steering wheel. Otherwise such that the
/// inertia is within a factor of sqrt(10) of a typical wheel's, and the angle below 3 rad.
PortUnits port_units_for(const Record& record, double inertia_kgm2);

struct FirmwareRun {
  std::vector<Estimate> estimates;  ///< one a tick, in order, in the port's units
  std::vector<double> time_s;       ///< the record's, of each tick: an estimate's own stamp stands still in a fault
  PortUnits units;
};

/// `record` is at 100 Hz (log/resample.hpp); `friction_nm` is what the firmware is told of the wheel's dry friction
/// above the torsion bar.
FirmwareRun run_firmware(const Record& record, Scalar scalar, const PortUnits& units, double friction_nm = 0);

}  // namespace steerid
