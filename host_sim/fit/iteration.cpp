// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/iteration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steerid {
namespace {

constexpr double kArmijo = 1e-4;    // c1 of equation 15
constexpr double kCurvature = 0.9;  // c2 of Wolfe's second condition (Nocedal and Wright 2006, section 3.1)
constexpr int kHalvings = 20;
constexpr double kTowardsZero = 0.9;  // J may lose at most this share in one step

double largest_cosine(const NormalEquations& equations, int fixed) {
  const double length = std::sqrt(2 * equations.cost);
  double largest = 0;
  for (Eigen::Index i = fixed; i < equations.gradient.size(); ++i) {
    const double column = std::sqrt(equations.diagonal[i]);
    if (column > 0 && length > 0) largest = std::max(largest, std::abs(equations.gradient[i]) / (column * length));
  }
  return largest;
}

double longest_step(const Eigen::VectorXd& x, const Eigen::VectorXd& step) {
  return step[0] < 0 ? std::min(1.0, -kTowardsZero * x[0] / step[0]) : 1.0;
}

}  // namespace

Iteration gauss_newton(OutputError& problem, Eigen::VectorXd start, int max_steps, double tolerance, int fixed) {
  NormalEquations equations = problem.evaluate(start);
  Iteration at{std::move(start), std::move(equations)};
  while (true) {
    at.gradient = largest_cosine(at.equations, fixed);
    if (at.gradient <= tolerance) at.stop = StopReason::kGradient;
    if (2 * at.equations.cost <= problem.rounding_power()) at.stop = StopReason::kExact;
    if (at.stop != StopReason::kIterationLimit || at.steps >= max_steps) return at;

    const Eigen::VectorXd step = -at.equations.solve(at.equations.gradient, fixed);
    const double slope = at.equations.gradient.dot(step);
    double alpha = longest_step(at.x, step);
    for (int halving = 0;; ++halving, alpha /= 2) {
      const Eigen::VectorXd next = at.x + alpha * step;
      NormalEquations trial = problem.evaluate(next);
      if (std::isfinite(trial.cost) && trial.cost <= at.equations.cost + kArmijo * alpha * slope) {
        at.curvature_ok = at.curvature_ok && std::abs(trial.gradient.dot(step)) <= kCurvature * std::abs(slope);
        at.x = next;
        at.equations = std::move(trial);
        break;
      }
      if (halving == kHalvings || !(slope < 0)) {
        at.equations = problem.evaluate(at.x);  // the rows kept for later belong to x again
        at.stop = StopReason::kNoDescent;
        return at;
      }
    }
    ++at.steps;
  }
}

}  // namespace steerid
