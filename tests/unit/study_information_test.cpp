// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The Fisher information over time against the closed form in the frequency domain, which shares no code with it.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "study/cramer_rao.hpp"
#include "study/drive_information.hpp"
#include "study/steady_drive.hpp"

namespace steerid {
namespace {

constexpr WheelArm kArms[] = {{0.06, 0.4, 2.0}, {0.11, 1.5, 22.7}, {0.11, 2.1, 45.9}};

/// The steady drive's torque without its sensor's noise.
std::vector<double> torque_of(SteadyDrive drive, std::size_t samples) {
  drive.torque_noise_nm = 0;
  drive.angle_noise_rad = 0;
  drive.unmeasured_torque_nm = 0;
  drive.samples = samples;
  const Record record = record_of(drive, 5, 0);
  std::vector<double> torque;
  for (std::size_t k = 0; k < record.size(); ++k)
    torque.push_back(record.torque_driver_nm[k] - record.torque_motor_nm[k]);
  return torque;
}

Eigen::Matrix3d sum(const std::vector<Eigen::Matrix3d>& blocks) {
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& block : blocks) all += block;
  return all;
}

// The closed form leaves out the unknown start and the transient, each some wheel memories (up to 0.3 s and, with the
// slow torque known only by its colour, some seconds) of 300 s: 3 %.
TEST(DriveInformation, AgreesWithTheClosedForm) {
  for (const WheelArm& wheel : kArms) {
    for (const double unmeasured_nm : {0.0, 0.15}) {
      SteadyDrive drive{.wheel = wheel, .angle_noise_rad = 0.0007, .unmeasured_torque_nm = unmeasured_nm};
      drive.samples = 30'000;
      const Eigen::Matrix3d bound = cramer_rao_bound(drive);
      const std::vector<double> torque = torque_of(drive, drive.samples);
      const Eigen::Vector3d sd = bound_of(sum(information_by_block(
          wheel, torque,
          {.angle_rad = drive.angle_noise_rad, .torque_nm = drive.torque_noise_nm, .unmeasured_nm = unmeasured_nm},
          100)));
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(sd(i) / std::sqrt(bound(i, i)), 1, 0.03)
            << wheel.stiffness_nm_per_rad << " " << unmeasured_nm << " " << i;
      }
    }
  }
}

// C - J w^2 and B w are all that one frequency tells: J and C are unexcited, B is not.
TEST(DriveInformation, OneSineShowsDampingAlone) {
  std::vector<double> torque;
  for (int k = 0; k < 12'000; ++k) torque.push_back(3 * std::sin(2 * 3.14159265358979 * 0.25 * 0.01 * k));
  std::vector<Eigen::Matrix3d> blocks =
      information_by_block(kArms[1], torque, {.angle_rad = 0.0007, .torque_nm = 0.03}, 1000);
  blocks.erase(blocks.begin(), blocks.begin() + 2);  // the start is no sine
  const Eigen::Vector3d sd = bound_of(sum(blocks));
  EXPECT_GT(sd(0), 0.11);
  EXPECT_GT(sd(2), 0.2);
  EXPECT_LT(sd(1), 0.015);
}

TEST(DriveInformation, NothingTellsNothing) {
  const std::vector<double> torque(1000, 0.0);
  const auto blocks = information_by_block(kArms[1], torque, {.angle_rad = 0.0007, .torque_nm = 0.03}, 300);
  EXPECT_EQ(blocks.size(), 3U);
  EXPECT_TRUE(std::isinf(bound_of(sum(blocks))(0)));
}

TEST(DriveInformation, TheBoundIsTheInversesDiagonal) {
  Eigen::Matrix3d information;
  information << 4e6, 1e4, -2e3, 1e4, 9e3, 30, -2e3, 30, 5;
  const Eigen::Matrix3d inverse = information.inverse();
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(bound_of(information)(i), std::sqrt(inverse(i, i)), 1e-9 * std::sqrt(inverse(i, i)));
}

}  // namespace
}  // namespace steerid
