// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/random_walk.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>

namespace steerid {
namespace {

struct Filtered {
  Eigen::Vector4d value;
  Eigen::Matrix4d covariance;
};

/// Takes in one row; what it adds to the sum of squares and of logarithms.
class Forwards {
 public:
  Forwards(const RandomWalk& walk) : now{walk.start, walk.start_variance.asDiagonal()} {}

  void wander(const Eigen::Vector4d& variance) { now.covariance.diagonal() += variance; }

  void take(double y, const Eigen::Vector4d& z) {
    const Eigen::Vector4d along = now.covariance * z;
    const double spread = 1 + z.dot(along);
    const double error = y - z.dot(now.value);
    now.value += along * (error / spread);
    now.covariance -= along * along.transpose() / spread;
    squares_ += error * error / spread;
    logarithms_ += std::log(spread);
    ++rows_;
  }

  [[nodiscard]] double variance() const { return squares_ / static_cast<double>(rows_); }
  [[nodiscard]] double log_likelihood() const {
    return -0.5 * (static_cast<double>(rows_) * std::log(variance()) + logarithms_);
  }

  Filtered now;

 private:
  double squares_ = 0;
  double logarithms_ = 0;
  std::size_t rows_ = 0;
};

Eigen::Vector4d wandered(const RandomWalk& walk, std::span<const double> time_s, std::size_t k) {
  return k == 0 ? Eigen::Vector4d(Eigen::Vector4d::Zero())
                : Eigen::Vector4d(walk.variance_per_s * (time_s[k] - time_s[k - 1]));
}

}  // namespace

double log_likelihood(const Eigen::VectorXd& y, const Eigen::Matrix<double, Eigen::Dynamic, 4>& z,
                      std::span<const double> time_s, const RandomWalk& walk) {
  Forwards forwards(walk);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    forwards.wander(wandered(walk, time_s, static_cast<std::size_t>(k)));
    forwards.take(y[k], z.row(k).transpose());
  }
  return forwards.log_likelihood();
}

SmoothedWalk smooth_walk(const Eigen::VectorXd& y, const Eigen::Matrix<double, Eigen::Dynamic, 4>& z,
                         std::span<const double> time_s, const RandomWalk& walk) {
  const auto rows = static_cast<std::size_t>(y.size());
  Forwards forwards(walk);
  std::vector<Filtered> filtered;
  filtered.reserve(rows);
  for (std::size_t k = 0; k < rows; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    forwards.wander(wandered(walk, time_s, k));
    forwards.take(y[row], z.row(row).transpose());
    filtered.push_back(forwards.now);
  }
  SmoothedWalk out;
  out.variance = forwards.variance();
  out.log_likelihood = forwards.log_likelihood();
  out.value.resize(rows);
  out.sd.resize(rows);
  Filtered later = filtered.back();
  for (std::size_t k = rows; k-- > 0;) {
    if (k + 1 < rows) {
      const Filtered& here = filtered[k];
      Eigen::Matrix4d ahead = here.covariance;
      ahead.diagonal() += wandered(walk, time_s, k + 1);
      // G = P_k ahead^-1; scaled, since the numbers' sizes differ by powers of ten.
      const Eigen::Vector4d scale = ahead.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
      const Eigen::LDLT<Eigen::Matrix4d> solver(scale.asDiagonal() * ahead * scale.asDiagonal());
      const Eigen::Matrix4d gain =
          (scale.asDiagonal() * solver.solve(Eigen::Matrix4d(scale.asDiagonal() * here.covariance))).transpose();
      later.value = here.value + gain * (later.value - here.value);
      later.covariance = here.covariance + gain * (later.covariance - ahead) * gain.transpose();
    }
    out.value[k] = later.value;
    out.sd[k] = (later.covariance.diagonal().cwiseMax(0) * out.variance).cwiseSqrt();
  }
  return out;
}

}  // namespace steerid
