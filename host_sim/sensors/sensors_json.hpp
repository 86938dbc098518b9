// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The sensors of a simulation file, its optional key "sensors":
//
//   "sensors": {
//     "angle":         {"noise": {"sd_rad": 0.0007}, "resolution": {"step_rad": 0.0005}},
//     "torque_driver": {"bias": {"offset_nm": 0.1, "drift_nm_per_s": 0}, "dropout": {"fraction": 0.02}},
//     "torque_motor":  {"delay": {"delay_s": 0.02, "onset_s": 30, "length_s": 5}},
//     "jitter":        {"spread_s": 0.002, "stamped": true},
//     "message_loss":  {"fraction": 0.01, "mean_run": 2}
//   }
//
// | defect       | keys (UNIT is rad for the angle, nm for the torques)   | see                  |
// | lag          | time_constant_s                                        | sensors/lag.hpp        |
// | delay        | delay_s                                                | sensors/delay.hpp      |
// | gain         | factor                                                 | sensors/gain.hpp       |
// | bias         | offset_UNIT, drift_UNIT_per_s                          | sensors/bias.hpp       |
// | noise        | sd_UNIT                                                | sensors/noise.hpp      |
// | saturation   | limit_UNIT                                             | sensors/saturation.hpp |
// | resolution   | step_UNIT                                              | sensors/resolution.hpp |
// | dropout      | fraction, mean_run, flagged                            | sensors/dropout.hpp    |
// | stuck        | (when only)                                            | sensors/stuck.hpp      |
// | jitter       | spread_s, stamped                                      | sensors/jitter.hpp     |
// | message_loss | fraction, mean_run                                     | sensors/dropout.hpp    |
//
// Every defect takes onset_s and length_s; without them it always acts, except stuck, which needs a length_s.
// The sensors of a column's file (plant/column.hpp) are torque_bar, torque_rim and probe in place of torque_driver.
//
// What is not named is off. An unknown key or a value out of range is refused.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sensors/column_sensors.hpp"
#include "sensors/sensor_suite.hpp"

namespace steerid {

/// Throws BadInput with one sentence; `file` stands for the file in it.
[[nodiscard]] SensorDefects sensors_from_json(const nlohmann::json& sensors, const std::string& file);

[[nodiscard]] ColumnSensorDefects column_sensors_from_json(const nlohmann::json& sensors, const std::string& file);

}  // namespace steerid
