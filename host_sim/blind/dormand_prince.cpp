// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/dormand_prince.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steerid::blind {
namespace {

constexpr std::array<double, 7> kC = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
constexpr double kA[7][6] = {
    {},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
// Fifth minus fourth order.
constexpr std::array<double, 7> kError = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                          -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
// The continuous extension's last coefficient.
constexpr std::array<double, 7> kDense = {-12715105075.0 / 11282082432.0,  0,
                                          87487479700.0 / 32700410799.0,   -10690763975.0 / 1880347072.0,
                                          701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0,
                                          69997945.0 / 29380423.0};

}  // namespace

DormandPrince::DormandPrince(std::size_t states, Rates rates, double relative_tolerance, double absolute_tolerance)
    : rates_(std::move(rates)),
      relative_(relative_tolerance),
      absolute_(absolute_tolerance),
      start_(states),
      stage_(states),
      end_(states) {
  for (auto& slope : slope_) slope.resize(states);
}

double DormandPrince::attempt(double time, std::span<const double> state, double step) {
  const std::size_t n = start_.size();
  std::copy(state.begin(), state.end(), start_.begin());
  step_ = step;
  if (!first_known_) rates_(time, start_, slope_[0]);
  first_known_ = true;  // until restart(): a second try from here starts with the same slope
  for (std::size_t s = 1; s < 7; ++s) {
    std::vector<double>& target = s < 6 ? stage_ : end_;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < s; ++k) sum += kA[s][k] * slope_[k][i];
      target[i] = start_[i] + step * sum;
    }
    rates_(time + kC[s] * step, target, slope_[s]);
  }
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double error = 0;
    for (std::size_t k = 0; k < 7; ++k) error += kError[k] * slope_[k][i];
    const double scale = absolute_ + relative_ * std::max(std::abs(start_[i]), std::abs(end_[i]));
    worst = std::max(worst, std::abs(step * error) / scale);
  }
  return worst;
}

double DormandPrince::better_step(double step, double error) {
  return step * std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 5.0);
}

void DormandPrince::within(double fraction, std::span<double> state) const {
  const double rest = 1 - fraction;
  for (std::size_t i = 0; i < start_.size(); ++i) {
    const double whole = end_[i] - start_[i];
    const double first = step_ * slope_[0][i] - whole;
    const double last = whole - step_ * slope_[6][i] - first;
    double bend = 0;
    for (std::size_t k = 0; k < 7; ++k) bend += kDense[k] * slope_[k][i];
    state[i] = start_[i] + fraction * (whole + rest * (first + fraction * (last + rest * step_ * bend)));
  }
}

}  // namespace steerid::blind
