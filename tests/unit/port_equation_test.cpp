// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every set of channels against the table of the contract, spelled out here.
#include <gtest/gtest.h>

#include <string>

#include "port/equation.hpp"

namespace steerid {
namespace {

constexpr std::uint8_t kA = kAngleValid, kD = kTorqueDriverValid, kM = kTorqueMotorValid, kB = kTorqueBarValid,
                       kR = kTorqueRimValid, kP = kProbeValid;

constexpr Sample kSample{
    .torque_driver_mnm = 1, .torque_motor_mnm = 20, .torque_bar_mnm = 300, .torque_rim_mnm = 4000, .probe_mnm = 50000};

struct Case {
  unsigned channels;
  Equation equation;
  std::int32_t known_torque_mnm;
  bool voluntary_known;
};

constexpr Case kCases[] = {
    {kA | kD | kM, Equation::kDriverMotor, 1 - 20, true},
    {kA | kD | kM | kP, Equation::kDriverMotor, 1 - 20, true},
    {kA | kD | kB, Equation::kDriverBar, 1 - 300, true},
    {kA | kD | kM | kB | kR | kP, Equation::kDriverBar, 1 - 300, true},
    {kA | kD | kR, Equation::kDriverRim, 1 - 4000, true},
    {kA | kD | kM | kR, Equation::kDriverRim, 1 - 4000, true},
    {kA | kB, Equation::kBar, -300, false},
    {kA | kB | kM | kP, Equation::kBar, -300, false},
    {kA | kB | kR, Equation::kBar, -300, false},
    {kA | kR, Equation::kRim, -4000, false},
    {kA | kR | kM | kP, Equation::kRim, -4000, false},
    {kA, Equation::kNone, 0, false},
    {kA | kD, Equation::kNone, 0, false},
    {kA | kM, Equation::kNone, 0, false},
    {kA | kP | kM, Equation::kNone, 0, false},
    {kD | kM | kB | kR | kP, Equation::kNone, 0, false},
    {0, Equation::kNone, 0, false},
};

TEST(PortEquation, IsThatOfTheContract) {
  for (const Case& expected : kCases) {
    const auto channels = static_cast<std::uint8_t>(expected.channels);
    SCOPED_TRACE(expected.channels);
    const Equation equation = equation_of(channels);
    EXPECT_STREQ(name(equation), name(expected.equation));
    EXPECT_EQ(known_torque_mnm(kSample, equation), expected.known_torque_mnm);
    EXPECT_EQ(voluntary_torque_known(equation), expected.voluntary_known);
  }
}

/// What an equation needs is there whenever it is chosen, and alone leads to the same equation.
TEST(PortEquation, NeedsOnlyChannelsThatAreThere) {
  for (unsigned bits = 0; bits < 64; ++bits) {
    const auto channels = static_cast<std::uint8_t>(bits);
    const Equation equation = equation_of(channels);
    EXPECT_EQ(channels_of(equation) & ~bits, 0U) << bits;
    EXPECT_EQ(equation_of(channels_of(equation)), equation) << bits;
  }
}

TEST(PortEquation, AFreshSampleIsThePapers) { EXPECT_EQ(equation_of(Sample{}.valid_bits), Equation::kDriverMotor); }

}  // namespace
}  // namespace steerid
