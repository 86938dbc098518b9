// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A minute of a steered column as a log of the car, for tests of the diagnosis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "log/record.hpp"
#include "support/steered_column.hpp"

namespace steerid::test {

/// What a logger in the car writes; the angle may be late by whole samples.
inline Record record_of(const SteeredColumn& column, std::uint64_t seed, std::size_t late = 0) {
  std::mt19937_64 random(seed);
  const std::vector<ColumnRow> rows = drive(column, 60, random);
  Record record;
  record.channels = kAngleValid | kTorqueBarValid | kTorqueMotorValid | kProbeValid;
  for (std::size_t i = late; i < rows.size(); ++i) {
    record.time_s.push_back(0.01 * static_cast<double>(i - late));
    record.torque_bar_nm.push_back(rows[i].bar_nm);
    record.torque_motor_nm.push_back(rows[i].probe_nm);
    record.probe_nm.push_back(rows[i].probe_nm);
    record.angle_rad.push_back(rows[i - late].angle_rad);
  }
  record.torque_driver_nm.assign(record.size(), 0);
  return record;
}

}  // namespace steerid::test
