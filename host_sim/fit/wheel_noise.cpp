// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/wheel_noise.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "fit/akaike.hpp"

namespace steerid {
namespace {

struct SlowShape {
  double corner_hz;
  int low_passes;
};

/// Of one low pass a record shows little more than the slope.
constexpr std::array kSlowShapes = {SlowShape{0.1, 2}, SlowShape{0.2, 2}, SlowShape{0.4, 2},
                                    SlowShape{0.8, 2}, SlowShape{0.4, 1}, SlowShape{0.1, 1}};
constexpr int kShortestMemory = 8;  // samples

// Search for the shares, in nats of variance over the angle noise's: steps halve from the first to the last, which is
// a third of what a record of a minute can tell.
constexpr double kFirstStep = 4;
constexpr double kNextStep = 1;  // from one shape's shares to the next one's
constexpr double kLastStep = 0.06;
constexpr double kMostNats = 25;
constexpr int kMovesOfAStep = 20;

constexpr double kLostNats = 0.1;    // that a shorter autoregression may cost
constexpr int kNumbers = 2;          // v_angle, v_torque
constexpr int kNumbersWithSlow = 4;  // and v_slow, f0

using Autocovariance = std::vector<double>;

/// White angle noise and what comes through the wheel, each with a power of one.
struct Parts {
  const LaggedProducts& residual;
  std::vector<Autocovariance> through;
  int numbers;  // estimated: the variances and f0

  [[nodiscard]] std::optional<Autoregression> colour(const std::vector<double>& nats, double lost_nats) const {
    Autocovariance sum(static_cast<std::size_t>(residual.order()) + 1, 0.0);
    sum[0] = 1;
    for (std::size_t part = 0; part < through.size(); ++part) {
      const double share = std::exp(nats[part]);
      for (std::size_t lag = 0; lag < sum.size(); ++lag) sum[lag] += share * through[part][lag];
    }
    return Autoregression::from_autocovariance(sum, numbers - 1, lost_nats / residual.rows());
  }

  /// -2 log likelihood, up to a constant, of the best variance.
  [[nodiscard]] double misfit(const std::vector<double>& nats) const {
    const std::optional<Autoregression> model = colour(nats, 0);
    const double squares = model ? residual.squares(model->coefficients()) : 0;
    return squares > 0 ? residual.rows() * std::log(squares / residual.rows())
                       : std::numeric_limits<double>::infinity();
  }
};

struct Shares {
  std::vector<double> nats;
  double misfit = 0;
};

/// Coordinate by coordinate (Hooke and Jeeves 1961).
Shares best_shares(const Parts& parts, std::vector<double> start, double first_step) {
  Shares best{std::move(start), 0};
  best.misfit = parts.misfit(best.nats);
  const auto improves = [&](std::size_t part, double step) {
    std::vector<double> nats = best.nats;
    nats[part] = std::clamp(nats[part] + step, -kMostNats, kMostNats);
    const double misfit = parts.misfit(nats);
    if (!(misfit < best.misfit)) return false;
    best = {std::move(nats), misfit};
    return true;
  };
  for (double step = first_step; step > kLastStep; step /= 2) {
    bool moved = true;
    for (int move = 0; moved && move < kMovesOfAStep; ++move) {
      moved = false;
      for (std::size_t part = 0; part < best.nats.size(); ++part) {
        moved = improves(part, step) || improves(part, -step) || moved;
      }
    }
  }
  return best;
}

/// With a power of one; empty where it is no number.
Autocovariance scaled(Autocovariance values) {
  const double power = values.front();
  if (!(power > 0) || !std::isfinite(power)) return {};
  for (double& value : values) value /= power;
  return values;
}

}  // namespace

std::vector<double> angle_autocovariance(const WheelArm& wheel, double corner_hz, int poles, double period_s,
                                         int last_lag) {
  const Eigen::Index n = 2 + poles;
  const double corner = 2 * std::numbers::pi * corner_hz;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);  // of angle, rate, and the low passes from the last to the first
  a(0, 1) = 1;
  a(1, 0) = -wheel.stiffness_nm_per_rad / wheel.inertia_kgm2;
  a(1, 1) = -wheel.damping_nms_per_rad / wheel.inertia_kgm2;
  for (Eigen::Index i = 2; i < n; ++i) {
    a(i, i) = -corner;
    a(i - 1, i) = i == 2 ? 1 / wheel.inertia_kgm2 : corner;
  }
  const double input = poles == 0 ? 1 / wheel.inertia_kgm2 : corner;
  // a P + P a' + input^2 period e e' = 0, e the last state: white noise of variance one a sample is that dense
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd lyapunov(n * n, n * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      lyapunov.block(i * n, j * n, n, n) = a(i, j) * identity + (i == j ? a : Eigen::MatrixXd::Zero(n, n));
    }
  }
  Eigen::VectorXd driven = Eigen::VectorXd::Zero(n * n);
  driven[n * n - 1] = -input * input * period_s;
  Eigen::VectorXd with_angle = lyapunov.partialPivLu().solve(driven).head(n);
  const Eigen::MatrixXd step = (a * period_s).exp();
  std::vector<double> out;
  for (int lag = 0; lag <= last_lag; ++lag, with_angle = step * with_angle) out.push_back(with_angle[0]);
  return out;
}

std::optional<Autoregression> wheel_noise(const LaggedProducts& residual, const WheelArm& wheel, double period_s) {
  const bool comes_to_rest = wheel.inertia_kgm2 > 0 && wheel.damping_nms_per_rad > 0 && wheel.stiffness_nm_per_rad > 0;
  if (!comes_to_rest || residual.order() < kShortestMemory) return std::nullopt;
  const auto part = [&](double corner_hz, int poles) {
    return scaled(angle_autocovariance(wheel, corner_hz, poles, period_s, residual.order()));
  };
  Parts parts{residual, {part(0, 0)}, kNumbers};
  if (parts.through.front().empty()) return std::nullopt;
  Shares best = best_shares(parts, {0}, kFirstStep);
  double criterion = corrected_akaike(best.misfit, residual.rows(), parts.numbers);
  Shares slow{{best.nats.front(), 0}, 0};
  double step = kFirstStep;
  for (const SlowShape& shape : kSlowShapes) {
    Parts more{residual, {parts.through.front(), part(shape.corner_hz, shape.low_passes)}, kNumbersWithSlow};
    if (more.through.back().empty()) continue;
    slow = best_shares(more, std::move(slow.nats), step);
    step = kNextStep;
    const double with_slow = corrected_akaike(slow.misfit, residual.rows(), more.numbers);
    if (!(with_slow < criterion)) continue;
    criterion = with_slow;
    best = slow;
    parts.through = std::move(more.through);
    parts.numbers = more.numbers;
  }
  return parts.colour(best.nats, kLostNats);
}

}  // namespace steerid
