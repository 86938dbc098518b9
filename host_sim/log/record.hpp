// A drive in memory: what a log holds and what a simulation makes. Columns of equal length.
#pragma once

#include <cstddef>
#include <vector>

namespace steerid {

struct Record {
  std::vector<double> time_s;            ///< strictly increasing
  std::vector<double> torque_driver_nm;  ///< positive counter-clockwise
  std::vector<double> torque_motor_nm;   ///< the EPS motor's target torque, subtracted in the model
  std::vector<double> angle_rad;         ///< positive counter-clockwise

  [[nodiscard]] std::size_t size() const { return time_s.size(); }

  /// T_driver - T_motor at sample i: the torque that moves the wheel.
  [[nodiscard]] double net_torque_nm(std::size_t i) const { return torque_driver_nm[i] - torque_motor_nm[i]; }
  /// The same of every sample.
  [[nodiscard]] std::vector<double> net_torque_nm() const {
    std::vector<double> net(size());
    for (std::size_t i = 0; i < net.size(); ++i) net[i] = net_torque_nm(i);
    return net;
  }
};

}  // namespace steerid
