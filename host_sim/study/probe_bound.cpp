// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/probe_bound.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "experiment/signal_point.hpp"
#include "log/linear_prediction.hpp"

namespace steerid {
namespace {

constexpr std::size_t kOrder = 64;
constexpr int kFrequencies = 4000;      // 0.0125 Hz apart
constexpr std::int64_t kRenewed = 100;  // ticks that a filter serves while the arm changes

/// One-sided, Nm^2/Hz.
double density(const WheelArm& arm, const HidingNoise& noise, double hz) {
  const double w = 2 * std::numbers::pi * hz;
  const double spring = arm.stiffness_nm_per_rad - arm.inertia_kgm2 * w * w;
  const double damper = arm.damping_nms_per_rad * w;
  const double c = arm.stiffness_nm_per_rad;
  return c * c * noise.intent_rad2_per_hz(hz) +
         2 * kTickS *
             (noise.torque_noise_nm * noise.torque_noise_nm +
              (spring * spring + damper * damper) * noise.angle_noise_rad * noise.angle_noise_rad);
}

/// Makes noise of the density white with variance 1.
class Whitener {
 public:
  Whitener(const WheelArm& arm, const HidingNoise& noise) {
    std::array<double, kOrder + 1> covariance{};
    constexpr double kSpacing_hz = 0.5 / kTickS / kFrequencies;
    for (int k = 0; k < kFrequencies; ++k) {
      const double hz = (k + 0.5) * kSpacing_hz;
      const double power = density(arm, noise, hz) * kSpacing_hz;
      // cos(m x) by Chebyshev's recursion
      const double twice = 2 * std::cos(2 * std::numbers::pi * hz * kTickS);
      double before = twice / 2;
      double now = 1;
      for (double& sum : covariance) {
        sum += power * now;
        const double next = twice * now - before;
        before = now;
        now = next;
      }
    }
    prediction_ = linear_prediction(covariance);
  }

  /// Of the rows up to `at`, the newest last.
  [[nodiscard]] Eigen::Vector3d whiten(std::span<const Eigen::Vector3d> rows, std::size_t at) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i <= kOrder; ++i) sum += prediction_.weight[i] * rows[at - i];
    return sum / std::sqrt(prediction_.variance);
  }

 private:
  LinearPrediction<kOrder> prediction_;
};

/// (z'', z', z) by differences of fourth order; zero where neighbours are missing.
std::vector<Eigen::Vector3d> derivatives(std::span<const double> z) {
  std::vector<Eigen::Vector3d> rows(z.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 2; k + 2 < z.size(); ++k) {
    rows[k] = {(-z[k - 2] + 16 * z[k - 1] - 30 * z[k] + 16 * z[k + 1] - z[k + 2]) / (12 * kTickS * kTickS),
               (z[k - 2] - 8 * z[k - 1] + 8 * z[k + 1] - z[k + 2]) / (12 * kTickS), z[k]};
  }
  return rows;
}

bool same(const WheelArm& a, const WheelArm& b) {
  return a.inertia_kgm2 == b.inertia_kgm2 && a.damping_nms_per_rad == b.damping_nms_per_rad &&
         a.stiffness_nm_per_rad == b.stiffness_nm_per_rad;
}

}  // namespace

double smooth_density(double rms, double corner_hz, double hz) {
  const double x = 1 + hz * hz / (corner_hz * corner_hz);
  return 4 * rms * rms / (std::numbers::pi * corner_hz) / (x * x);
}

std::vector<Eigen::Matrix3d> probe_information(std::span<const double> by_probe_rad, std::span<const WheelArm> arm,
                                               const HidingNoise& noise, std::size_t block) {
  const std::vector<Eigen::Vector3d> rows = derivatives(by_probe_rad);
  std::vector<Eigen::Matrix3d> blocks;
  Eigen::Matrix3d now = Eigen::Matrix3d::Zero();
  WheelArm served = arm.front();
  Whitener whitener(served, noise);
  std::int64_t since = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (++since >= kRenewed && !same(served, arm[k])) {
      served = arm[k];
      whitener = Whitener(served, noise);
      since = 0;
    }
    if (k >= kOrder) {
      const Eigen::Vector3d w = whitener.whiten(rows, k);
      now += w * w.transpose();
    }
    if ((k + 1) % block != 0) continue;
    blocks.push_back(now);
    now.setZero();
  }
  return blocks;
}

std::vector<Eigen::Vector3d> followed_bound(std::span<const Eigen::Matrix3d> information, const Eigen::Vector3d& walk,
                                            Uses uses) {
  const Eigen::Vector3d any(1, 10, 1000);  // kg m2, Nms/rad, Nm/rad, above any arm's: a start that knows nothing
  const Eigen::Matrix3d nothing = any.cwiseAbs2().cwiseInverse().asDiagonal();
  const Eigen::Matrix3d step = walk.asDiagonal();
  const auto aged = [&](const Eigen::Matrix3d& knowledge) -> Eigen::Matrix3d {
    return (knowledge.inverse() + step).inverse();
  };
  const std::size_t n = information.size();
  std::vector<Eigen::Matrix3d> later(n, Eigen::Matrix3d::Zero());  // what all blocks after this one say
  Eigen::Matrix3d knowledge = nothing;
  for (std::size_t k = n; uses == Uses::kPastAndFuture && k-- > 0;) {
    later[k] = knowledge;
    knowledge = aged(knowledge + information[k]);
  }
  std::vector<Eigen::Vector3d> deviation;
  knowledge = nothing;
  for (std::size_t k = 0; k < n; ++k) {
    knowledge += information[k];
    deviation.emplace_back((knowledge + later[k]).inverse().diagonal().cwiseSqrt());
    knowledge = aged(knowledge);
  }
  return deviation;
}

}  // namespace steerid
