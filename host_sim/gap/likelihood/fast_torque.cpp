// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/fast_torque.hpp"

#include <cmath>
#include <numbers>

#include "gap/likelihood/block_spectra.hpp"

namespace steerid::gap {

namespace {

/// Behind its two poles, without an end.
Eigen::ArrayXd falling(const FastTorque& one, const Eigen::ArrayXd& f_hz) {
  const double first = one.tail_corner_hz;
  const double second = one.tail_second_hz;
  const double power = std::numbers::pi / 2 * first * second / (first + second);
  return one.tail_variance / power / ((1 + (f_hz / first).square()) * (1 + (f_hz / second).square()));
}

}  // namespace

Eigen::ArrayXd FastTorque::density(const Eigen::ArrayXd& f_hz) const {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(f_hz.size());
  if (tail_variance > 0) {
    const Eigen::ArrayXd beyond = beyond_the_end(f_hz);
    out += falling(*this, f_hz) * beyond / (1 + beyond);
  }
  if (tremor_variance > 0) {
    const Eigen::ArrayXd square = (f_hz / tremor_hz).square();
    const double height = 4 * tremor_damping / (std::numbers::pi * tremor_hz);
    out += tremor_variance * height * square / ((1 - square).square() + std::pow(2 * tremor_damping, 2) * square);
  }
  return out;
}

/// That of the whole in closed form, less what is before the end, of which nothing is left at the highest line.
double FastTorque::rate_variance() const {
  if (!(tail_variance > 0)) return 0;
  constexpr Eigen::Index kLines = 200;
  constexpr double kWidth_hz = kHighest_hz / kLines;
  const Eigen::ArrayXd f_hz = Eigen::ArrayXd::LinSpaced(kLines, kWidth_hz / 2, kHighest_hz - kWidth_hz / 2);
  const Eigen::ArrayXd before = f_hz.square() * falling(*this, f_hz) / (1 + beyond_the_end(f_hz));
  const double whole = tail_variance * tail_corner_hz * tail_second_hz;
  return 4 * std::numbers::pi * std::numbers::pi * (whole - before.sum() * kWidth_hz);
}

}  // namespace steerid::gap
