// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/linear_refit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

namespace steerid::blind {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;
// Row 0 the wheel, rows 1 to 5 its derivatives by J, B, C, first angle, first rate; columns angle and rate.
using Motion = Eigen::Matrix<double, 6, 2>;

constexpr int kQuarters = 4;

/// The torque at every quarter of a sampling interval.
std::vector<double> quarters(const Record& record) {
  const std::size_t n = record.size();
  std::array<std::array<double, 6>, kQuarters> weights{};
  for (int q = 0; q < kQuarters; ++q) {
    const double u = 2 + q / static_cast<double>(kQuarters);
    for (int i = 0; i < 6; ++i) {
      double w = 1;
      for (int k = 0; k < 6; ++k) {
        if (k != i) w *= (u - k) / (i - k);
      }
      weights[static_cast<std::size_t>(q)][static_cast<std::size_t>(i)] = w;
    }
  }
  std::vector<double> torque;
  torque.reserve(kQuarters * n);
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t q = 0; q < kQuarters; ++q) {
      if (s < 2 || s + 3 >= n) {
        const double next = record.net_torque_nm(std::min(s + 1, n - 1));
        const double share = static_cast<double>(q) / kQuarters;
        torque.push_back(record.net_torque_nm(s) * (1 - share) + next * share);
        continue;
      }
      double sum = 0;
      for (std::size_t i = 0; i < 6; ++i) sum += weights[q][i] * record.net_torque_nm(s - 2 + i);
      torque.push_back(sum);
    }
  }
  return torque;
}

Motion slopes(const Motion& now, const Arm& arm, double torque) {
  Motion out;
  const double acceleration =
      (torque - arm.damping_nms_per_rad * now(0, 1) - arm.stiffness_nm_per_rad * now(0, 0)) / arm.inertia_kgm2;
  out.col(0) = now.col(1);
  out.col(1) = -(arm.damping_nms_per_rad * now.col(1) + arm.stiffness_nm_per_rad * now.col(0)) / arm.inertia_kgm2;
  out(0, 1) = acceleration;
  out(1, 1) -= acceleration / arm.inertia_kgm2;
  out(2, 1) -= now(0, 1) / arm.inertia_kgm2;
  out(3, 1) -= now(0, 0) / arm.inertia_kgm2;
  return out;
}

struct Normal {
  Matrix5 information = Matrix5::Zero();
  Vector5 gradient = Vector5::Zero();
  double squares = 0;
};

Normal run(const Record& record, const std::vector<double>& torque, const Vector5& at) {
  const Arm arm{at(0), at(1), at(2)};
  const double h = (record.time_s.back() - record.time_s.front()) / static_cast<double>(record.size() - 1) / 2;
  Motion now = Motion::Zero();
  now(0, 0) = at(3);
  now(0, 1) = at(4);
  now(4, 0) = 1;
  now(5, 1) = 1;
  Normal normal;
  for (std::size_t s = 0; s < record.size(); ++s) {
    const double miss = record.angle_rad[s] - now(0, 0);
    const Vector5 by = now.col(0).tail<5>();
    normal.squares += miss * miss;
    normal.gradient += by * miss;
    normal.information += by * by.transpose();
    if (s + 1 == record.size()) break;
    for (std::size_t half = 0; half < 2; ++half) {
      const double* t = &torque[kQuarters * s + 2 * half];
      const Motion k1 = slopes(now, arm, t[0]);
      const Motion k2 = slopes(now + h / 2 * k1, arm, t[1]);
      const Motion k3 = slopes(now + h / 2 * k2, arm, t[1]);
      const Motion k4 = slopes(now + h * k3, arm, t[2]);
      now += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return normal;
}

bool physical(const Vector5& at) { return at(0) > 1e-3 && at(1) > 1e-3 && at(2) > 0; }

}  // namespace

LinearRefit refit(const Record& record, const Arm& start) {
  constexpr int kMostSteps = 40;
  constexpr double kSettled = 1e-8;  // of the residual's square
  const std::vector<double> torque = quarters(record);
  Vector5 at(start.inertia_kgm2, start.damping_nms_per_rad, start.stiffness_nm_per_rad, record.angle_rad.front(), 0);
  Normal here = run(record, torque, at);
  double damping = 1e-4;
  for (int i = 0; i < kMostSteps; ++i) {
    Matrix5 damped = here.information;
    damped.diagonal() *= 1 + damping;
    const Vector5 next = at + damped.ldlt().solve(here.gradient);
    const Normal there = physical(next) ? run(record, torque, next) : Normal{.squares = INFINITY};
    if (there.squares < here.squares) {
      const bool settled = here.squares - there.squares < kSettled * here.squares;
      at = next;
      here = there;
      damping = std::max(damping / 10, 1e-9);
      if (settled) break;
    } else {
      damping *= 10;
      if (damping > 1e8) break;
    }
  }
  const auto n = static_cast<double>(record.size());
  double mean = 0;
  for (const double angle : record.angle_rad) mean += angle / n;
  double spread = 0;
  for (const double angle : record.angle_rad) spread += (angle - mean) * (angle - mean) / n;
  const double rms = std::sqrt(here.squares / n);
  return {{at(0), at(1), at(2)}, rms, rms / std::sqrt(spread)};
}

}  // namespace steerid::blind
