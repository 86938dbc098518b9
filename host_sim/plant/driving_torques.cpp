// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/driving_torques.hpp"

namespace steerid {

Record with_driving_torques(Record record) {
  const std::uint8_t used = channels_of(record.equation());
  for (const std::uint8_t channel : {kTorqueBarValid, kTorqueRimValid}) {
    if ((used & channel) != 0) record.motor_channel = channel;
  }
  const bool driver_known = voluntary_torque_known(record.equation());
  record.torque_motor_nm = record.opposing_torque_nm();
  record.torque_bar_nm.clear();
  record.torque_rim_nm.clear();
  record.channels =
      driver_known ? kAllChannelsValid : kAngleValid | kTorqueMotorValid | (record.channels & kProbeValid);
  if (!record.has(kProbeValid)) record.probe_nm.clear();
  return record;
}

}  // namespace steerid
