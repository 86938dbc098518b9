// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The blind generator's integrator against the swing of a spring, whose closed form is cos t.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "blind/dormand_prince.hpp"

namespace steerid::blind {
namespace {

DormandPrince swing() {
  return {2,
          [](double, std::span<const double> y, std::span<double> slope) {
            slope[0] = y[1];
            slope[1] = -y[0];
          },
          1e-9, 1e-9};
}

double error_after(double duration, int steps) {
  DormandPrince solver = swing();
  std::array<double, 2> y = {1, 0};
  const double h = duration / steps;
  for (int i = 0; i < steps; ++i) {
    solver.attempt(h * i, y, h);
    std::copy(solver.end().begin(), solver.end().end(), y.begin());
    solver.go_on();
  }
  return std::hypot(y[0] - std::cos(duration), y[1] + std::sin(duration));
}

TEST(BlindIntegrator, IsOfFifthOrder) {
  // Halving the step of a fifth-order method divides the error by 32. In 6.3 to 40 steps a cycle it is between orders.
  const double ratio = error_after(10, 100) / error_after(10, 200);
  EXPECT_GT(ratio, 25);
  EXPECT_LT(ratio, 40);
  EXPECT_LT(error_after(10, 1000), 1e-10);
}

TEST(BlindIntegrator, IsOfFourthOrderWithinAStep) {
  const auto worst_within = [](double h) {
    DormandPrince solver = swing();
    const std::array<double, 2> y = {1, 0};
    solver.attempt(0, y, h);
    double worst = 0;
    std::array<double, 2> at{};
    for (int i = 0; i <= 20; ++i) {
      solver.within(i / 20.0, at);
      worst = std::max(worst, std::abs(at[0] - std::cos(h * i / 20.0)));
    }
    return worst;
  };
  // One step: the extension errs by O(h^5), a factor of 32.
  const double ratio = worst_within(0.4) / worst_within(0.2);
  EXPECT_GT(ratio, 25);
  EXPECT_LT(ratio, 80);
}

TEST(BlindIntegrator, EstimatesItsError) {
  DormandPrince solver = swing();
  const std::array<double, 2> y = {1, 0};
  // Over the tolerance of 1e-9 a step of one radian errs by far; one of a hundredth does not.
  EXPECT_GT(solver.attempt(0, y, 1.0), 1);
  EXPECT_LT(DormandPrince::better_step(1.0, solver.attempt(0, y, 1.0)), 1.0);
  EXPECT_LT(solver.attempt(0, y, 0.01), 1);
}

}  // namespace
}  // namespace steerid::blind
