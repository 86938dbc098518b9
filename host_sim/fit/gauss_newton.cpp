// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/gauss_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/certainty.hpp"
#include "fit/inertia_limit.hpp"
#include "fit/iteration.hpp"
#include "fit/output_error.hpp"
#include "fit/residual_colour.hpp"
#include "fit/segments.hpp"
#include "fit/starting_values.hpp"

namespace steerid {
namespace {

constexpr int kColourRounds = 20;
constexpr int kMasslessRounds = 2;
constexpr int kMasslessSteps = 10;
constexpr double kGoodShare = 0.25;  // of the angle's power left unexplained: a start that does better is not doubted
constexpr double kSettled = 0.02;    // of a standard deviation: the colour is settled when no parameter moves more
constexpr double kColourMemory_s = 0.3;  // of a free autoregression
constexpr double kWheelMemory_s = 0.5;   // of noise through the wheel, the slow torque's included

// Candidates in the order of the cost they start from.
std::vector<OutputError::Completed> by_cost(OutputError& problem, const std::vector<WheelArm>& candidates) {
  std::vector<OutputError::Completed> starts;
  for (const WheelArm& candidate : candidates) {
    OutputError::Completed start = problem.complete(candidate);
    if (std::isfinite(start.cost)) starts.push_back(std::move(start));
  }
  std::sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return starts;
}

// Runs from the candidates, best first, until one ends in a minimum that explains most of the angle.
std::optional<Iteration> best_run(OutputError& problem, const std::vector<WheelArm>& candidates,
                                  const FitOptions& options, double angle_power) {
  std::optional<Iteration> best;
  bool rows_are_best = false;  // the problem keeps the rows of the last run only
  int steps = 0;
  for (const OutputError::Completed& start : by_cost(problem, candidates)) {
    Iteration run = gauss_newton(problem, start.x, options.max_iterations, options.gradient_tolerance);
    steps += run.steps;
    rows_are_best = !best || run.equations.cost < best->equations.cost;
    if (rows_are_best) best = std::move(run);
    if (best->stop != StopReason::kIterationLimit && 2 * best->equations.cost < kGoodShare * angle_power) break;
  }
  if (best) {
    if (!rows_are_best) best->equations = problem.evaluate(best->x);
    best->steps = steps;
  }
  return best;
}

// The first guesses come from the record; if none leads anywhere, typical arms are tried.
std::optional<Iteration> first_run(OutputError& problem, const FitOptions& options, double angle_power) {
  if (options.start) return best_run(problem, {*options.start}, options, angle_power);
  std::optional<Iteration> run =
      best_run(problem, starting_values(problem.segments(), options.torque_offset), options, angle_power);
  if (run && 2 * run->equations.cost < kGoodShare * angle_power) return run;
  std::optional<Iteration> other = best_run(problem, typical_arms(), options, angle_power);
  if (!run || (other && other->equations.cost < run->equations.cost)) return other;
  run->equations = problem.evaluate(run->x);
  return run;
}

double spare_samples(const OutputError& problem) {
  const double used = static_cast<double>(problem.unknowns()) + problem.noise().numbers();
  return std::max(1.0, static_cast<double>(problem.samples()) - used);
}

// Squared distance of two points in standard deviations.
double moved_sd2(const OutputError& problem, const Iteration& at, const Eigen::VectorXd& before) {
  const Eigen::VectorXd moved = at.x - before;
  return moved.dot(at.equations.times(moved)) * spare_samples(problem) / (2 * at.equations.cost);
}

// Continues a run: its counts add up.
void go_on(OutputError& problem, Iteration& at, int max_steps, double tolerance) {
  Iteration next = gauss_newton(problem, at.x, max_steps, tolerance);
  next.steps += at.steps;
  next.curvature_ok = next.curvature_ok && at.curvature_ok;
  at = std::move(next);
}

// The colour of the noise, what the fit took from it given back. Not along directions that the record does not show.
Autoregression colour_of(const OutputError& problem, const Iteration& at, double period_s, const ColourMemory& memory) {
  const double variance = 2 * at.equations.cost / spare_samples(problem);
  const std::vector<Eigen::VectorXd> absorbed =
      problem.absorbed(covariance_of(at.equations.shared_information(), variance, 0));
  return residual_colour(problem.residuals(), absorbed, problem.named(at.x).wheel, period_s, memory);
}

// Alternates between the residual's colour and one step of the parameters until neither moves, then converges.
void settle_colour(OutputError& problem, Iteration& at, double period_s, const ColourMemory& memory,
                   const FitOptions& options) {
  for (int round = 0; round < kColourRounds; ++round) {
    problem.set_noise(colour_of(problem, at, period_s, memory));
    const Eigen::VectorXd before = at.x;
    go_on(problem, at, 1, options.gradient_tolerance);
    if (moved_sd2(problem, at, before) <= kSettled * kSettled) break;
  }
  go_on(problem, at, options.max_iterations, options.gradient_tolerance);
}

void report_run(const OutputError& problem, const Iteration& at, std::size_t record_size, BatchFit& fit) {
  fit.angle_model_rad.assign(record_size, std::numeric_limits<double>::quiet_NaN());
  fit.residual_rad = fit.angle_model_rad;
  const std::vector<Eigen::VectorXd> residuals = problem.residuals();
  const Unknowns found = problem.named(at.x);
  for (std::size_t s = 0; s < problem.segments().size(); ++s) {
    const Segment& segment = problem.segments()[s];
    fit.segments.push_back({segment.sample.front(), segment.sample.back(), found.initial[s]});
    for (std::size_t i = 0; i < segment.size(); ++i) {
      const double residual = residuals[s][static_cast<Eigen::Index>(i)];
      fit.residual_rad[segment.sample[i]] = residual;
      fit.angle_model_rad[segment.sample[i]] = segment.angle_rad[i] - residual;
    }
  }
}

int samples_of(double memory_s, double period_s) {
  return static_cast<int>(std::clamp(memory_s / period_s, 8.0, 400.0));
}

/// The longest free autoregression that is tried.
int most_memory(double period_s, const FitOptions& options) {
  return options.ar_max_order > 0 ? options.ar_max_order : samples_of(kColourMemory_s, period_s);
}

void judge(const Iteration& at, double variance, const FitOptions& options, BatchFit& fit) {
  fit.covariance = covariance_of(at.equations.shared_information(), variance);
  fit.inertia = judged(at.x[0], fit.covariance(0, 0), false, options.valid_relative_sd);
  fit.damping = judged(at.x[1], fit.covariance(1, 1), false, options.valid_relative_sd);
  fit.stiffness = judged(at.x[2], fit.covariance(2, 2), false, options.valid_relative_sd);
  if (options.torque_offset) fit.torque_offset = judged(at.x[3], fit.covariance(3, 3), true, options.valid_relative_sd);
}

/// Whether the fitted inertia is a line in the noise. Then `at` becomes the massless fit, its colour settled anew.
bool gives_up_inertia(OutputError& problem, Iteration& at, double variance, double period_s, const FitOptions& options,
                      const BatchFit& fit) {
  InertiaDoubt doubt(problem, at, variance, period_s);
  if (fit.inertia.state != ParameterState::kValid) return false;
  if (!doubt.possible(fit.damping.state == ParameterState::kValid)) return false;
  if (!doubt.is_line(fit.inertia.sd)) {
    at.equations = problem.evaluate(at.x);  // the rows kept for later belong to the answer again
    return false;
  }
  const int steps = at.steps;
  at = Iteration(doubt.massless());
  for (int round = 0; round < kMasslessRounds; ++round) {
    if (options.noise == FitOptions::Noise::kAutoregressive) {
      problem.set_noise(Autoregression::fit(problem.residuals(), most_memory(period_s, options)));
    }
    at = gauss_newton(problem, at.x, kMasslessSteps, options.gradient_tolerance, 1);
  }
  at.steps += steps;
  return true;
}

double variance_of(const OutputError& problem, const Iteration& at) {
  return std::max(2 * at.equations.cost, problem.rounding_power()) / spare_samples(problem);
}

// Sum over the segments of (angle - its mean)^2, and of the torque's change: what there is to explain and to fit with.
struct Activity {
  double angle_power = 0;
  double torque_power = 0;
};

Activity activity(const std::vector<Segment>& segments) {
  const auto varies = [](const std::vector<double>& values) {
    const Eigen::Map<const Eigen::ArrayXd> v(values.data(), static_cast<Eigen::Index>(values.size()));
    return (v - v.mean()).square().sum();
  };
  Activity sum;
  for (const Segment& segment : segments) {
    sum.angle_power += varies(segment.angle_rad);
    sum.torque_power += varies(segment.net_torque_nm);
  }
  return sum;
}

}  // namespace

const char* name(StopReason reason) {
  switch (reason) {
    case StopReason::kGradient:
      return "gradient vanished";
    case StopReason::kExact:
      return "model and record agree to rounding";
    case StopReason::kNoDescent:
      return "no step lowers the cost";
    case StopReason::kIterationLimit:
      return "iteration limit";
    case StopReason::kNoData:
      return "no usable data";
  }
  return "unknown";
}

BatchFit fit_batch(const Record& record, const FitOptions& options) {
  BatchFit fit;
  std::vector<Segment> segments = gap_free_segments(record, options.between);
  const Activity moves = activity(segments);
  if (!(moves.angle_power > 0) || !(moves.torque_power > 0)) return fit;

  OutputError problem(std::move(segments), options.torque_offset);
  std::optional<Iteration> first = first_run(problem, options, moves.angle_power);
  if (!first) return fit;
  Iteration& at = *first;
  const double period_s = sample_period_s(record);
  if (options.noise == FitOptions::Noise::kAutoregressive && at.stop != StopReason::kExact) {
    settle_colour(problem, at, period_s, {most_memory(period_s, options), samples_of(kWheelMemory_s, period_s)},
                  options);
  }

  double variance = variance_of(problem, at);
  judge(at, variance, options, fit);
  const bool free_run_only = options.max_iterations == 0 || at.stop == StopReason::kExact;
  if (!free_run_only && gives_up_inertia(problem, at, variance, period_s, options, fit)) {
    variance = variance_of(problem, at);
    judge(at, variance, options, fit);
    fit.covariance.row(0).setZero();
    fit.covariance.col(0).setZero();
    fit.covariance(0, 0) = variance * kUnexcited;
    fit.inertia.state = ParameterState::kNotExcited;
    fit.inertia.sd = std::numeric_limits<double>::infinity();
  }
  if (options.inertia_limit && !free_run_only && fit.inertia.state != ParameterState::kValid) {
    fit.inertia.at_most = largest_inertia(problem.segments(), most_memory(period_s, options));
  }
  fit.stop = at.stop;
  fit.iterations = at.steps;
  fit.gradient = at.gradient;
  fit.curvature_ok = at.curvature_ok;
  fit.excitation = excitation(fit.covariance, fit.wheel(), options.valid_relative_sd);
  fit.noise = problem.noise();
  fit.noise_sd_rad = std::sqrt(variance);
  report_run(problem, at, record.size(), fit);
  if (options.convergence_factor)
    fit.convergence_factor = convergence_factor(at.equations, problem.curvature_columns(at.x));
  return fit;
}

}  // namespace steerid
