// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drive in memory: what a log holds and what a simulation makes. Columns of equal length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "port/equation.hpp"
#include "port/sample.hpp"

namespace steerid {

struct Record {
  std::vector<double> time_s;            ///< strictly increasing
  std::vector<double> torque_driver_nm;  ///< the driver's voluntary torque, positive counter-clockwise; zeros if absent
  std::vector<double> torque_motor_nm;   ///< the EPS motor's target torque, subtracted in the model; zeros if absent
  std::vector<double> angle_rad;         ///< positive counter-clockwise
  std::vector<double> torque_bar_nm{};   ///< torsion bar, positive when the driver turns counter-clockwise
  std::vector<double> torque_rim_nm{};   ///< the hand's torque on the rim, positive counter-clockwise
  std::vector<double> probe_nm{};        ///< what the EPS was asked to add for identification
  /// The channels that are there, as valid bits of the port's sample (kAngleValid | ...). Bar, rim and probe are empty
  /// where their bits are cleared.
  std::uint8_t channels = kAllChannelsValid;
  /// What torque_motor_nm was measured as: the bar or the rim where it drives a simulation in the motor's place.
  std::uint8_t motor_channel = kTorqueMotorValid;

  [[nodiscard]] std::size_t size() const { return time_s.size(); }

  [[nodiscard]] bool has(std::uint8_t channel) const { return (channels & channel) != 0; }

  /// What these channels identify.
  [[nodiscard]] Equation equation() const { return equation_of(channels); }

  /// What stands against the driver in the equation: the torque of the bar, the rim or the motor.
  [[nodiscard]] const std::vector<double>& opposing_torque_nm() const {
    const std::uint8_t used = channels_of(equation());
    if ((used & kTorqueBarValid) != 0) return torque_bar_nm;
    return (used & kTorqueRimValid) != 0 ? torque_rim_nm : torque_motor_nm;
  }

  /// The known torque on what is identified, at sample i: T_driver - T_motor in the paper's equation.
  [[nodiscard]] double net_torque_nm(std::size_t i) const { return torque_driver_nm[i] - opposing_torque_nm()[i]; }
  /// The same of every sample.
  [[nodiscard]] std::vector<double> net_torque_nm() const {
    std::vector<double> net(size());
    const std::vector<double>& opposing = opposing_torque_nm();
    for (std::size_t i = 0; i < net.size(); ++i) net[i] = torque_driver_nm[i] - opposing[i];
    return net;
  }
};

}  // namespace steerid
