// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a drive's estimates are worth, tick by tick, beside the arm that there was.
//
//   close    within 15 % of the truth
//   outside  valid, and farther from the truth than 1.96 standard deviations
//   wrong    outside, and off by more than a tenth of the truth
//
// Where the truth is 0 (the spring of a wheel without hands) shares of it mean nothing; a parameter's scale is then
// what is small for a driver: kSmall.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plant/wheel_arm.hpp"
#include "port/estimate.hpp"

namespace steerid {

/// Of one parameter, over the ticks of one drive or of many.
struct ParameterTicks {
  std::int64_t ticks = 0;
  std::int64_t valid = 0;
  std::int64_t valid_close = 0;
  std::int64_t outside = 0;
  std::int64_t wrong = 0;
  double longest_wrong_s = 0;

  ParameterTicks& operator+=(const ParameterTicks& other);

  // In percent.
  [[nodiscard]] double valid_percent() const { return percent(valid, ticks); }
  [[nodiscard]] double valid_close_percent() const { return percent(valid_close, ticks); }
  [[nodiscard]] double wrong_percent() const { return percent(wrong, ticks); }
  [[nodiscard]] double wrong_of_valid_percent() const { return percent(wrong, valid); }
  /// Valid ticks whose 95 % interval holds the truth; NaN of none.
  [[nodiscard]] double covered_percent() const { return 100 - percent(outside, valid); }

  static double percent(std::int64_t part, std::int64_t whole) {
    return 100 * static_cast<double>(part) / static_cast<double>(whole);
  }
};

/// J, B and C of one estimate or of one truth, SI units.
[[nodiscard]] std::array<ParameterEstimate, 3> parameters_of(const Estimate& estimate);
[[nodiscard]] std::array<double, 3> parameters_of(const WheelArm& arm);

class ArmScore {
 public:
  static constexpr double kClose = 0.15;
  static constexpr double kTenth = 0.1;
  static constexpr double kInterval = 1.96;
  /// J of a light wheel, B of one, and C of a touch: kg m2, Nms/rad, Nm/rad.
  static constexpr std::array<double, 3> kSmall = {0.02, 0.1, 2};

  /// One tick: what was said and what was true.
  void take(const Estimate& said, const WheelArm& truth);

  [[nodiscard]] const std::array<ParameterTicks, 3>& parameters() const { return parameters_; }

 private:
  std::array<ParameterTicks, 3> parameters_{};
  std::array<std::int64_t, 3> wrong_run_{};  // ticks
};

/// Of the rows from `first` on.
[[nodiscard]] std::array<ParameterTicks, 3> ticks_from(std::size_t first, const std::vector<Estimate>& said,
                                                       const std::vector<WheelArm>& truth);

}  // namespace steerid
