// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/instrumental_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace steerid {
namespace {

constexpr int kMostRounds = 20;
constexpr double kStands = 0.01;  // of a standard deviation, from one round to the next

struct Regression {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double variance = 0;
};

Regression regression(const InstrumentedRows::White& white, int noise_numbers) {
  const Eigen::Matrix4d both = white.instrument.transpose() * white.motion;
  const Eigen::Matrix4d own = white.instrument.transpose() * white.instrument;
  // The unknowns' sizes differ by powers of ten: scaled, a singular matrix is seen as one.
  const Eigen::Vector4d scale = own.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::FullPivLU<Eigen::Matrix4d> solver(scale.asDiagonal() * both * scale.asDiagonal());
  Regression out;
  const auto samples = static_cast<double>(white.torque.size());
  const double free = samples - InstrumentedRows::kUnknowns - noise_numbers;
  if (!solver.isInvertible() || !(free > 0)) {
    out.covariance.diagonal().setConstant(kUnexcited);
    return out;
  }
  const Eigen::Matrix4d inverse = scale.asDiagonal() * solver.inverse() * scale.asDiagonal();
  out.value = inverse * (white.instrument.transpose() * white.torque);
  out.variance = (white.torque - white.motion * out.value).squaredNorm() / free;
  out.covariance = out.variance * inverse * own * inverse.transpose();
  return out;
}

double mean_square(const std::vector<Eigen::VectorXd>& parts) {
  double n = 0, squares = 0;
  for (const Eigen::VectorXd& part : parts) {
    n += static_cast<double>(part.size());
    squares += part.squaredNorm();
  }
  return n > 0 ? squares / n : 0;
}

}  // namespace

InstrumentalFit fit_by_instrument(const InstrumentedRows& rows, double valid_relative_sd) {
  InstrumentalFit fit;
  fit.by_probe = rows.by_probe();
  fit.rows = static_cast<std::size_t>(rows.size());
  if (rows.size() <= 2 * InstrumentedRows::kFunctions || !(rows.slow_torque_power() > 0)) {
    fit.rows = 0;
    return fit;
  }
  Eigen::Vector4d at(0.1, 1.5, 20, 0);  // the average driver's; only the first whitening hangs on it
  Regression found;
  for (int round = 0; round < kMostRounds && !fit.settled; ++round) {
    const std::vector<Eigen::VectorXd> unexplained = rows.unexplained(at);
    fit.noise = Autoregression::fit(unexplained, InstrumentalFit::kLongestNoise);
    const InstrumentedRows::White white = rows.whitened(fit.noise);
    found = regression(white, fit.noise.numbers());
    fit.driven = white.driven.transpose() * white.driven;
    const Eigen::Vector4d moved = (found.value - at).cwiseAbs();
    fit.settled = (moved.array() <= kStands * found.covariance.diagonal().array().sqrt()).all();
    at = found.value;
  }
  fit.unexplained_nm = std::sqrt(mean_square(rows.unexplained(at)));
  fit.unexplained_share = rows.slow_unexplained_power(at) / rows.slow_torque_power();
  fit.noise_nm = std::sqrt(found.variance);
  fit.constant_nm = at[3];
  fit.covariance = found.covariance.topLeftCorner<3, 3>();
  const double share = fit.by_probe ? 0 : fit.unexplained_share;
  const auto parameter = [&](int i) {
    return judged(at[i], fit.covariance(i, i) + share * at[i] * at[i], false, valid_relative_sd);
  };
  fit.inertia = parameter(0);
  fit.damping = parameter(1);
  fit.stiffness = parameter(2);
  return fit;
}

std::optional<DrivenPart> driven_part(const InstrumentalFit& fit, const WheelArm& arm) {
  const double torque = fit.driven(0, 0);
  if (!fit.by_probe || fit.rows == 0 || !(torque > 0)) return std::nullopt;
  const Eigen::Vector4d with(1, -arm.inertia_kgm2, -arm.damping_nms_per_rad, -arm.stiffness_nm_per_rad);
  return DrivenPart{.nrmse = std::sqrt(std::max(0.0, with.dot(fit.driven * with)) / torque),
                    .by_noise = fit.noise_nm * std::sqrt(static_cast<double>(InstrumentedRows::kFunctions) / torque)};
}

InstrumentalFit fit_by_instrument(const Record& record, double valid_relative_sd) {
  return fit_by_instrument(InstrumentedRows(record), valid_relative_sd);
}

}  // namespace steerid
