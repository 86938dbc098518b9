// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a driver's feedback does to the estimate: the closed loop's bias, and the probe as instrument.
//
// A driver who tracks feeds the angle back after 150 ms, and his reflex the rate after 40 ms. What he applies is
// measured, so that the wheel's equation holds all the same. But a torque that no sensor sees moves the wheel, he
// answers to that, and his answer stands in the measured torque: the instrument, made of it, is no longer free of the
// equation's error. The EPS probe is: nobody's answer is in it. An instrument made of the motor's torque alone has no
// such bias, at the price of whatever the driver's own torque would have shown; and without a probe there is none.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace steerid {

struct ClosedLoopCase {
  std::string name;
  double gain = 0;           ///< Nm/rad, of the driver on the angle; the reflex has 0.02 s of it on the rate
  double unmeasured_nm = 0;  ///< rms, below 0.3 Hz
  double probe_rms_nm = 0;   ///< of the EPS; 0: none
};

/// Bias over the drives, in percent of the truth, with its standard error; J, B, C.
struct ClosedLoopBias {
  Eigen::Vector3d percent = Eigen::Vector3d::Zero();
  Eigen::Vector3d error_percent = Eigen::Vector3d::Zero();
};

struct ClosedLoopResult {
  ClosedLoopCase what;
  ClosedLoopBias recursive;  ///< the firmware's, its instrument made of all measured torque
  ClosedLoopBias probe;      ///< instrument made of the probe alone; nothing without one
  Eigen::Vector3d valid_share = Eigen::Vector3d::Zero();  ///< of the drives that end with the firmware's answer `valid`
};

struct ClosedLoopStudy {
  std::size_t drives = 0;
  std::uint64_t seed = 0;
  std::vector<ClosedLoopResult> results;
};

/// With and without feedback, three sizes of unmeasured torque, three of probe.
[[nodiscard]] std::vector<ClosedLoopCase> closed_loop_cases();

/// Drives of 60 s with the nominal arm; `at` is told how many are done.
[[nodiscard]] ClosedLoopStudy run_closed_loop_study(std::size_t drives, std::uint64_t seed,
                                                    const std::function<void(std::size_t)>& at);

/// closed_loop.csv, closed_loop.json and closed_loop.html.
void write_closed_loop(const std::filesystem::path& folder, const ClosedLoopStudy& study,
                       const nlohmann::ordered_json& made_by);

}  // namespace steerid
