// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which of a record's torques drive the wheel of a simulation. A simulation has two inputs, one that turns it and one
// that stands against it; a record may hold five channels. What stands against it follows from them
// (port/equation.hpp):
//
//   | record has    | against       | what the simulation describes           |
//   | ------------- | ------------- | --------------------------------------- |
//   | a bar         | torque_bar    | arm and wheel, above the torsion bar    |
//   | a rim, no bar | torque_rim    | the arm alone                           |
//   | neither       | torque_motor  | arm and wheel, the paper's equation 1   |
//
// What turns it is torque_driver. Where a record has none, nothing that turns the wheel is known: what a driver adds is
// an unmeasured torque.
#pragma once

#include "log/record.hpp"

namespace steerid {

/// `record` with what drives a simulation as torque_driver and torque_motor, and no further torques. Where the driver's
/// own one is in no channel, its bit is cleared, and a probe is kept.
[[nodiscard]] Record with_driving_torques(Record record);

}  // namespace steerid
