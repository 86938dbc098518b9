// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

#include "experiment/signal_point.hpp"
#include "experiment/triangle.hpp"
#include "fit/gauss_newton.hpp"
#include "fit/output_error.hpp"
#include "fit/segments.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/linear_response.hpp"
#include "sensors/random.hpp"

namespace steerid {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kNear = 1e-3;  // relative distance that counts as being there
constexpr int kMostSteps = 60;
constexpr double kWidest = 30.0;  // of the starts, either way

/// The least squares problem of a record with white weights, as the paper has it.
OutputError problem_of(const Record& record) {
  return {gap_free_segments(record, TorqueSignal::Between::kBandLimited), false};
}

Eigen::VectorXd gauss_newton_step(OutputError& problem, const Eigen::VectorXd& x) {
  const NormalEquations equations = problem.evaluate(x);
  return -equations.solve(equations.gradient);
}

double length(const NormalEquations& metric, const Eigen::VectorXd& v) { return std::sqrt(v.dot(metric.times(v))); }

double measured_factor(OutputError& problem, const NormalEquations& metric, const Eigen::VectorXd& minimum) {
  constexpr double kShort = 1e-4;
  const double reach = kShort * length(metric, minimum);
  Eigen::VectorXd e = Eigen::VectorXd::Zero(minimum.size());
  e.head<3>() = minimum.head<3>();
  double factor = 0;
  for (int i = 0; i < 12; ++i) {
    e *= reach / length(metric, e);
    const Eigen::VectorXd forth = minimum + e;
    const Eigen::VectorXd back = minimum - e;
    const Eigen::VectorXd after =
        (forth + gauss_newton_step(problem, forth) - back - gauss_newton_step(problem, back)) / 2;
    const double grown = length(metric, after) / reach;
    if (!(grown > 0)) return 0;
    const bool settled = std::abs(grown - factor) < 1e-4 * grown;
    factor = grown;
    if (settled) break;
    e = after;
  }
  return factor;
}

/// cos of the angle between the step and steepest descent, every column of the Jacobian in units of its length.
double descent_cosine(const NormalEquations& here, const Eigen::VectorXd& step) {
  const Eigen::VectorXd unit = here.diagonal.cwiseSqrt();
  const Eigen::VectorXd g = here.gradient.cwiseQuotient(unit);
  const Eigen::VectorXd p = step.cwiseProduct(unit);
  return -g.dot(p) / (g.norm() * p.norm());
}

/// One step of unit length, halved until f falls and J stays positive. False when none does.
bool descend(OutputError& problem, Eigen::VectorXd& x, double cost, const Eigen::VectorXd& step) {
  double alpha = 1;
  for (int halving = 0; halving < 30; ++halving, alpha /= 2) {
    const Eigen::VectorXd next = x + alpha * step;
    if (next[0] <= 0) continue;
    const double there = problem.evaluate(next).cost;
    if (std::isfinite(there) && there < cost) {
      x = next;
      return true;
    }
  }
  return false;
}

/// The minimum nearby, to rounding: steps of unit length, halved where f would rise, then as they are.
Eigen::VectorXd minimum_from(OutputError& problem, const WheelArm& near) {
  Eigen::VectorXd x = problem.complete(near).x;
  for (int i = 0; i < 4 * kMostSteps; ++i) {
    const NormalEquations equations = problem.evaluate(x);
    const Eigen::VectorXd step = -equations.solve(equations.gradient);
    if (step.head<3>().cwiseQuotient(x.head<3>()).norm() < 1e-12 || !descend(problem, x, equations.cost, step)) break;
  }
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i) {  // f is flat to rounding long before its gradient is
    const Eigen::VectorXd step = gauss_newton_step(problem, x);
    const double size = step.head<3>().cwiseQuotient(x.head<3>()).norm();
    if (!(size < last)) break;
    last = size;
    x += step;
  }
  return x;
}

ConvergenceTrace trace_from(OutputError& problem, const NormalEquations& metric, const Eigen::VectorXd& minimum,
                            const WheelArm& start) {
  const double whole = length(metric, minimum);
  ConvergenceTrace trace{start, {}, {}, false};
  Eigen::VectorXd x = problem.complete(start).x;
  for (int i = 0; i <= kMostSteps; ++i) {
    trace.distance.push_back(length(metric, x - minimum) / whole);
    if (trace.distance.back() < 1e-13) break;
    const NormalEquations equations = problem.evaluate(x);
    const Eigen::VectorXd step = -equations.solve(equations.gradient);
    const double cosine = descent_cosine(equations, step);
    if (!descend(problem, x, equations.cost, step)) break;
    trace.cosine.push_back(cosine);
  }
  trace.reached = *std::min_element(trace.distance.begin(), trace.distance.end()) < kNear;
  return trace;
}

bool is_near(const WheelArm& a, const WheelArm& b) {
  const auto close = [](double x, double y) { return std::abs(x - y) <= kNear * std::abs(y); };
  return close(a.inertia_kgm2, b.inertia_kgm2) && close(a.damping_nms_per_rad, b.damping_nms_per_rad) &&
         close(a.stiffness_nm_per_rad, b.stiffness_nm_per_rad);
}

/// Steps of unit length to the minimum from `start`; NaN when they leave J > 0, diverge or end elsewhere.
double unit_steps_to(OutputError& problem, const WheelArm& minimum, const WheelArm& start) {
  Eigen::VectorXd x = problem.complete(start).x;
  for (int i = 0; i <= kMostSteps; ++i) {
    if (!x.allFinite() || x[0] <= 0) return kNothing;
    if (is_near({x[0], x[1], x[2]}, minimum)) return i;
    x += gauss_newton_step(problem, x);
  }
  return kNothing;
}

double line_search_steps_to(const Record& record, const WheelArm& minimum, const WheelArm& start) {
  FitOptions options;
  options.noise = FitOptions::Noise::kWhite;
  options.start = start;
  options.max_iterations = kMostSteps;
  options.convergence_factor = false;
  const BatchFit fit = fit_batch(record, options);
  return is_near(fit.wheel(), minimum) ? fit.iterations : kNothing;
}

double share_reached(const std::vector<std::vector<double>>& steps) {
  double reached = 0;
  double all = 0;
  for (const auto& row : steps) {
    for (const double one : row) {
      reached += std::isfinite(one) ? 1 : 0;
      ++all;
    }
  }
  return all > 0 ? reached / all : 0;
}

std::vector<double> spread_about(double middle, std::size_t side) {
  std::vector<double> out;
  for (std::size_t i = 0; i < side; ++i) {
    const double part = 2.0 * static_cast<double>(i) / static_cast<double>(side - 1) - 1;
    out.push_back(middle * std::pow(kWidest, part));
  }
  return out;
}

/// The direction of natural units that the record does not show, as changes of J, B and C at `wheel`.
std::string unexcited_in_words(const Excitation& seen, const WheelArm& wheel) {
  constexpr std::array kSymbols{"J", "B", "C"};
  constexpr std::array kUnits{"kg m2", "Nms/rad", "Nm/rad"};
  const Eigen::Vector3d change = seen.unexcited_direction.cwiseProduct(
      Eigen::Vector3d(wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad));
  Eigen::Index most = 0;
  seen.unexcited_direction.cwiseAbs().maxCoeff(&most);
  std::string with;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i == most || std::abs(seen.unexcited_direction[i]) < 0.005) continue;
    const auto at = static_cast<std::size_t>(i);
    with += fmt::format("{}{} by {:.3g} {}", with.empty() ? ", and with it " : " and ", kSymbols[at],
                        change[i] / change[most], kUnits[at]);
  }
  const auto at = static_cast<std::size_t>(most);
  if (!with.empty()) with += fmt::format(" for each {} of {}", kUnits[at], kSymbols[at]);
  return fmt::format("{} is unexcited{}", kSymbols[at], with);
}

}  // namespace

ConvergenceCase measure_convergence(const std::string& name, const Record& record, const WheelArm& near,
                                    const std::vector<WheelArm>& starts) {
  OutputError problem = problem_of(record);
  const Eigen::VectorXd minimum = minimum_from(problem, near);
  const NormalEquations metric = problem.evaluate(minimum);
  ConvergenceCase out{name, {minimum[0], minimum[1], minimum[2]}, 0, 0, {}};
  out.predicted_factor = convergence_factor(metric, problem.curvature_columns(minimum));
  out.measured_factor = measured_factor(problem, metric, minimum);
  for (const WheelArm& start : starts) out.traces.push_back(trace_from(problem, metric, minimum, start));
  return out;
}

std::optional<double> order_of(const ConvergenceTrace& trace) {
  std::optional<double> order;
  for (std::size_t k = 1; k + 1 < trace.distance.size(); ++k) {
    const double before = trace.distance[k - 1];
    const double here = trace.distance[k];
    const double after = trace.distance[k + 1];
    if (before > 1e-1 || after < 1e-8 || !(here < before) || !(after < here)) continue;
    order = std::log(after / here) / std::log(here / before);
  }
  return order;
}

double Basin::unit_share() const { return share_reached(unit_steps); }
double Basin::line_search_share() const { return share_reached(line_search); }

Basin draw_basin(const Record& record, const WheelArm& near, std::size_t side, unsigned threads,
                 const std::function<void(std::size_t done)>& at_start) {
  OutputError problem = problem_of(record);
  const Eigen::VectorXd x = minimum_from(problem, near);
  Basin basin;
  basin.minimum = {x[0], x[1], x[2]};
  basin.inertia_kgm2 = spread_about(x[0], side);
  basin.damping_nms_per_rad = x[1];
  basin.stiffness_nm_per_rad = spread_about(x[2], side);
  basin.unit_steps.assign(side, std::vector<double>(side, kNothing));
  basin.line_search = basin.unit_steps;
  work_in_parallel(side * side, threads, at_start, [&](std::size_t job) {
    const std::size_t i = job / side;
    const std::size_t j = job % side;
    const WheelArm start{basin.inertia_kgm2[j], basin.damping_nms_per_rad, basin.stiffness_nm_per_rad[i]};
    OutputError own = problem_of(record);
    basin.unit_steps[i][j] = unit_steps_to(own, basin.minimum, start);
    basin.line_search[i][j] = line_search_steps_to(record, basin.minimum, start);
  });
  return basin;
}

RankCase examine_rank(const std::string& name, const Record& record, const WheelArm& scale) {
  const FitOptions options;
  const BatchFit fit = fit_batch(record, options);
  if (fit.stop == StopReason::kNoData) {
    return {name, 0, 0, "nothing moves: no direction of J, B, C has any information"};
  }
  const Excitation seen = excitation(fit.covariance, scale, options.valid_relative_sd);
  const bool all = seen.rank == 3;
  return {name, seen.rank, seen.smallest_singular_value,
          all ? "all of J, B and C are seen" : unexcited_in_words(seen, scale)};
}

Record sine_record(const WheelArm& wheel, double frequency_hz, double amplitude_nm, double duration_s,
                   double angle_noise_rad, std::uint64_t seed) {
  const double w = 2 * std::numbers::pi * frequency_hz;
  const std::complex<double> gain = 1.0 / std::complex<double>(wheel.stiffness_nm_per_rad - wheel.inertia_kgm2 * w * w,
                                                               wheel.damping_nms_per_rad * w);
  Random random(seed);
  Record record;
  const auto rows = static_cast<std::size_t>(std::llround(duration_s / kTickS));
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = static_cast<double>(i) * kTickS;
    const std::complex<double> turn = std::polar(amplitude_nm, w * t);
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(turn.real());
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back((gain * turn).real() + angle_noise_rad * random.normal());
  }
  return record;
}

Record triangle_record(const WheelArm& wheel, double duration_s, double angle_noise_rad, std::uint64_t seed) {
  Triangle triangle(5.0, 4000);
  Random random(seed);
  Record record;
  std::vector<double> net;
  const auto rows = static_cast<std::size_t>(std::llround(duration_s / kTickS));
  for (std::size_t i = 0; i < rows; ++i) {
    record.time_s.push_back(static_cast<double>(i) * kTickS);
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(triangle.next().value);
    net.push_back(-record.torque_motor_nm.back());
  }
  const TorqueSignal torque = TorqueSignal::from_samples(record.time_s, net, TorqueSignal::Between::kBandLimited);
  // The torque rises by 0.5 Nm a second: in balance the angle follows with the lag of B/C.
  const double rate = -0.5 / wheel.stiffness_nm_per_rad;
  const WheelState balanced{-rate * wheel.damping_nms_per_rad / wheel.stiffness_nm_per_rad, rate};
  record.angle_rad = free_run(wheel, torque, record.time_s, balanced);
  for (double& angle : record.angle_rad) angle += angle_noise_rad * random.normal();
  return record;
}

Record constant_record(const WheelArm& wheel, double torque_nm, double duration_s, double angle_noise_rad,
                       std::uint64_t seed) {
  Random random(seed);
  Record record;
  const auto rows = static_cast<std::size_t>(std::llround(duration_s / kTickS));
  for (std::size_t i = 0; i < rows; ++i) {
    record.time_s.push_back(static_cast<double>(i) * kTickS);
    record.torque_driver_nm.push_back(torque_nm);
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(torque_nm / wheel.stiffness_nm_per_rad + angle_noise_rad * random.normal());
  }
  return record;
}

}  // namespace steerid
