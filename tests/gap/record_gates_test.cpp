// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/record_gates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "log/bad_input.hpp"

namespace steerid::gap {
namespace {

BatchFit nothing_known() {
  BatchFit fit;
  fit.stop = StopReason::kGradient;
  return fit;
}

/// What the closest wheel leaves beside a constant torque.
std::function<double()> beside_offset(double power) {
  return [power] { return std::sqrt(power); };
}

TEST(RecordGates, ExcitedIsAMotionThatALinearWheelMakes) {
  const auto excited = [](double left, double left_beside_offset) {
    return require_excited(nothing_known(), std::sqrt(left), beside_offset(left_beside_offset));
  };
  EXPECT_EQ(excited(0.45, 1).size(), 3U);  // a note a parameter
  EXPECT_EQ(excited(0.55, 0.45).size(), 3U);
  EXPECT_THROW((void)excited(0.55, 0.55), BadInput);
}

TEST(RecordGates, OneParameterThatIsKnownIsEnough) {
  BatchFit stiffness_known = nothing_known();
  stiffness_known.stiffness.state = ParameterState::kValid;
  EXPECT_EQ(require_excited(stiffness_known, std::sqrt(0.9), beside_offset(0.9)).size(), 2U);
}

/// An angle that takes so many values in turns, a second each.
Record stairs(int values) {
  Record record;
  for (int i = 0; i < 2000; ++i) {
    record.time_s.push_back(0.01 * i);
    record.angle_rad.push_back(0.2 * (i / 100 % values));
    record.torque_driver_nm.push_back(std::sin(0.02 * i));
    record.torque_motor_nm.push_back(0);
  }
  return record;
}

TEST(RecordGates, AnAngleOfThreeValuesMoves) {
  EXPECT_NO_THROW(require_usable(stairs(3)));
  EXPECT_THROW(require_usable(stairs(2)), BadInput);
}

}  // namespace
}  // namespace steerid::gap
