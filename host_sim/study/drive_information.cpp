// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/drive_information.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiment/signal_point.hpp"
#include "plant/linear_response.hpp"

namespace steerid {
namespace {

/// Standard deviation of what is not known of the wheel's start: any angle, any rate.
constexpr double kAnyAngle_rad = 1;
constexpr double kAnyRate_rad_s = 10;

/// The Kalman filter of the header's model. Its gain does not hang on the data: one filter serves several signals.
class Whitener {
 public:
  Whitener(const WheelArm& wheel, const DriveNoise& noise) : angle_variance_(noise.angle_rad * noise.angle_rad) {
    const LinearStep step(wheel, kTickS);
    transition_.topLeftCorner<2, 2>() = step.transition.topLeftCorner<2, 2>();
    transition_.topRightCorner<2, 2>() = step.input.topLeftCorner<2, 2>();  // u + u' t over the tick
    const double w = 2 * std::numbers::pi * noise.unmeasured_corner_hz;
    const double fade = std::exp(-w * kTickS);
    Eigen::Matrix2d slow;
    slow << 1 + w * kTickS, kTickS, -w * w * kTickS, 1 - w * kTickS;
    slow *= fade;
    transition_.bottomRightCorner<2, 2>() = slow;

    const double power = noise.unmeasured_nm * noise.unmeasured_nm;
    const Eigen::Matrix2d stationary = Eigen::Vector2d(power, w * w * power).asDiagonal();
    const Eigen::Vector2d push = step.input.topLeftCorner<2, 1>() * noise.torque_nm;
    process_.topLeftCorner<2, 2>() = push * push.transpose();
    process_.bottomRightCorner<2, 2>() = stationary - slow * stationary * slow.transpose();
    covariance_.topLeftCorner<2, 2>() =
        Eigen::Vector2d(kAnyAngle_rad * kAnyAngle_rad, kAnyRate_rad_s * kAnyRate_rad_s).asDiagonal();
    covariance_.bottomRightCorner<2, 2>() = stationary;
  }

  /// What is new in the next sample of three signals, over its standard deviation.
  Eigen::Vector3d next(const Eigen::Vector3d& sample) {
    const double variance = covariance_(0, 0) + angle_variance_;
    const Eigen::Vector4d gain = covariance_.col(0) / variance;
    const Eigen::RowVector3d innovation = sample.transpose() - state_.row(0);
    state_ = transition_ * (state_ + gain * innovation);
    covariance_ = transition_ * (covariance_ - gain * covariance_.row(0)) * transition_.transpose() + process_;
    covariance_ = ((covariance_ + covariance_.transpose()) / 2).eval();
    return innovation.transpose() / std::sqrt(variance);
  }

 private:
  double angle_variance_;
  Eigen::Matrix4d transition_ = Eigen::Matrix4d::Zero();
  Eigen::Matrix4d process_ = Eigen::Matrix4d::Zero();
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> state_ = Eigen::Matrix<double, 4, 3>::Zero();
};

}  // namespace

std::vector<Eigen::Matrix3d> information_by_block(const WheelArm& wheel, std::span<const double> torque_nm,
                                                  const DriveNoise& noise, std::size_t block) {
  std::vector<double> time_s(torque_nm.size());
  for (std::size_t k = 0; k < time_s.size(); ++k) time_s[k] = static_cast<double>(k) * kTickS;
  FreeRunSensitivities run;
  free_run_sensitivities(wheel, TorqueSignal::from_samples(time_s, torque_nm, TorqueSignal::Between::kBandLimited),
                         time_s, {}, 0, run);
  Whitener whitener(wheel, noise);
  std::vector<Eigen::Matrix3d> blocks;
  Eigen::Matrix3d now = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < torque_nm.size(); ++k) {
    const Eigen::Vector3d by = run.by.row(static_cast<Eigen::Index>(k)).head<3>();
    const Eigen::Vector3d s = whitener.next(by);
    now += s * s.transpose();
    if ((k + 1) % block != 0) continue;
    blocks.push_back(now);
    now.setZero();
  }
  return blocks;
}

Eigen::Vector3d bound_of(const Eigen::Matrix3d& information) {
  // Scaled to a diagonal of one, so that units make no direction look unexcited; rounding fills what lies below the
  // floor.
  constexpr double kNoInformation = 1e-13;
  if (!(information.diagonal().minCoeff() > 0)) {
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  }
  const Eigen::Vector3d scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scale.asDiagonal() * information * scale.asDiagonal());
  const Eigen::Vector3d variance =
      eigen.eigenvectors().cwiseAbs2() * eigen.eigenvalues().cwiseMax(kNoInformation).cwiseInverse();
  return variance.cwiseSqrt().cwiseProduct(scale);
}

}  // namespace steerid
