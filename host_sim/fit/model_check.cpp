// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/model_check.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fit/certainty.hpp"
#include "fit/segments.hpp"
#include "log/neighbours.hpp"

namespace steerid {
namespace {

constexpr int kKinds = 6;
constexpr int kShared = 4;       // J, B, C, offset
constexpr double kUsable = 0.1;  // of a value

using Rows = Autoregression::Rows;
using Kind = Alternative::Kind;
constexpr std::array kAll{Kind::kDelay,       Kind::kClockDrift,    Kind::kDryFriction,
                          Kind::kCubicSpring, Kind::kSquareDamping, Kind::kAsymmetricStiffness};

/// The angle that a torque alone makes of a wheel at rest.
std::vector<double> response(const WheelArm& wheel, const std::vector<double>& time_s,
                             const std::vector<double>& torque_nm, TorqueSignal::Between between) {
  return free_run(wheel, TorqueSignal::from_samples(time_s, torque_nm, between), time_s, {}, 0);
}

std::vector<double> derivative(Kind kind, const WheelArm& wheel, const Segment& segment,
                               const std::vector<WheelState>& run, double from_s) {
  std::vector<double> torque_nm(run.size());
  std::vector<double> opposite_rate(run.size());
  for (std::size_t i = 0; i < run.size(); ++i) {
    const auto [angle, speed] = run[i];
    opposite_rate[i] = -speed;
    switch (kind) {
      case Kind::kDelay:
        break;
      case Kind::kClockDrift:
        opposite_rate[i] *= segment.time_s[i] - from_s;
        break;
      case Kind::kDryFriction: {  // a rate that passes zero has either sign for its share of the interval
        const double next = i + 1 < run.size() ? run[i + 1].rate_rad_s : speed;
        const double either = std::abs(speed) + std::abs(next);
        torque_nm[i] = either > 0 ? -(speed + next) / either : 0.0;
        break;
      }
      case Kind::kCubicSpring:
        torque_nm[i] = -angle * angle * angle;
        break;
      case Kind::kSquareDamping:
        torque_nm[i] = -speed * std::abs(speed);
        break;
      case Kind::kAsymmetricStiffness:
        torque_nm[i] = -angle * angle;
        break;
    }
  }
  if (kind == Kind::kDelay || kind == Kind::kClockDrift) return opposite_rate;
  return response(wheel, segment.time_s, torque_nm,
                  kind == Kind::kDryFriction ? TorqueSignal::Between::kHeld : TorqueSignal::Between::kBandLimited);
}

/// Products of all columns of all segments, the states at each segment's start eliminated.
/// Columns: J, B, C, offset, the alternatives, the residual; then what the torque's noise adds to each of the others,
/// and to the angle.
constexpr int kResidual = kShared + kKinds;
constexpr int kNoise = kResidual + 1;
constexpr int kNoiseAngle = kNoise + kResidual;
constexpr int kColumns = kNoiseAngle + 1;
using Table = Eigen::Matrix<double, Eigen::Dynamic, kColumns>;

struct Products {
  Eigen::Matrix<double, kColumns, kColumns> of = Eigen::Matrix<double, kColumns, kColumns>::Zero();
  std::size_t samples = 0;
};

/// `table` and the two columns of the start, each whitened.
void whiten(const Autoregression& noise, Table& table, Eigen::Matrix<double, Eigen::Dynamic, 2>& start) {
  Rows rows = Rows::Zero(table.rows(), Autoregression::kColumns);
  Rows white;
  rows.leftCols<2>() = start;
  noise.whiten(rows, white);
  start = white.leftCols<2>();
  for (int first = 0; first < kColumns; first += Autoregression::kColumns) {
    const int count = std::min(Autoregression::kColumns, kColumns - first);
    rows.setZero();
    rows.leftCols(count) = table.middleCols(first, count);
    noise.whiten(rows, white);
    table.middleCols(first, count) = white.leftCols(count);
  }
}

/// Squares of what samples are off the cubic through their neighbours, which no motion is fast enough for.
double fast_power(const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = 2; i + 2 < x.size(); ++i) sum += std::pow(x[i] - by_neighbours(x, i), 2);
  return sum;
}

/// What a segment's samples are of `values`, one a sample of the record.
std::vector<double> of_segment(const std::vector<double>& values, const Segment& segment) {
  std::vector<double> some;
  for (const std::size_t i : segment.sample) some.push_back(values[i]);
  return some;
}

/// The states with `share` of what noise adds to them.
std::vector<WheelState> moved(std::vector<WheelState> states, const std::vector<WheelState>& noise, double share) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].angle_rad += share * noise[i].angle_rad;
    states[i].rate_rad_s += share * noise[i].rate_rad_s;
  }
  return states;
}

/// The first row that tells of the wheel, and how many do. At a segment's ends the log's filter had the samples beyond
/// them and filtered_alike() has not, which the whitening remembers for as many rows as it looks back.
std::pair<Eigen::Index, Eigen::Index> told_rows(Eigen::Index rows, const Resampled& resampled, int order) {
  if (!resampled.filtered) return {0, rows};
  const auto reach = std::lround(anti_alias_for(resampled.source_rate_hz).half_length_s * kResampledRateHz);
  const Eigen::Index first = std::min<Eigen::Index>(reach + order, rows);
  return {first, std::max<Eigen::Index>(rows - first - reach, 0)};
}

void add(const Segment& segment, const FitSegment& from, const BatchFit& fit, const Resampled& resampled,
         const std::vector<double>& noise_nm, Products& sum) {
  const WheelArm wheel = fit.wheel();
  const double offset = fit.torque_offset ? fit.torque_offset->value : 0.0;
  FreeRunSensitivities run;
  free_run_sensitivities(wheel, segment.torque, segment.time_s, from.initial, offset, run);
  const std::vector<WheelState> states = free_run_states(wheel, segment.torque, segment.time_s, from.initial, offset);
  Table table(run.by.rows(), kColumns);
  table.leftCols<3>() = run.by.leftCols<3>();
  table.col(3) = run.by.col(kByTorqueOffset);
  const auto alternative = [&](int kind, const std::vector<WheelState>& of) -> Eigen::VectorXd {
    const std::vector<double> by = filtered_alike(resampled, derivative(kAll[static_cast<std::size_t>(kind)], wheel,
                                                                        segment, of, resampled.record.time_s.front()));
    return Eigen::Map<const Eigen::VectorXd>(by.data(), table.rows());
  };
  for (int kind = 0; kind < kKinds; ++kind) table.col(kShared + kind) = alternative(kind, states);
  table.col(kResidual) = Eigen::Map<const Eigen::VectorXd>(segment.angle_rad.data(), table.rows()) - run.angle_rad;
  Eigen::Matrix<double, Eigen::Dynamic, 2> start = run.by.middleCols<2>(kByInitialAngle);

  const auto torque =
      TorqueSignal::from_samples(segment.time_s, of_segment(noise_nm, segment), TorqueSignal::Between::kBandLimited);
  free_run_sensitivities(wheel, torque, segment.time_s, {}, 0, run);
  const std::vector<WheelState> noise = free_run_states(wheel, torque, segment.time_s, {}, 0);
  table.middleCols<3>(kNoise) = run.by.leftCols<3>();
  table.col(kNoise + 3).setZero();
  for (int kind = 0; kind < kKinds; ++kind) {
    table.col(kNoise + kShared + kind) =
        (alternative(kind, moved(states, noise, 1)) - alternative(kind, moved(states, noise, -1))) / 2;
  }
  table.col(kNoiseAngle) = run.angle_rad;

  whiten(fit.noise, table, start);
  const auto [first, rows] = told_rows(table.rows(), resampled, fit.noise.order());
  if (rows < static_cast<Eigen::Index>(kShortestSegment)) return;
  table = table.middleRows(first, rows).eval();
  start = start.middleRows(first, rows).eval();
  const Eigen::HouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 2>> qr(start);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(table.rows(), 2);
  table.leftCols<kNoise>() -= basis * (basis.transpose() * table.leftCols<kNoise>());
  sum.of += table.transpose() * table;
  sum.samples += static_cast<std::size_t>(rows);
}

/// The least-squares solution of some columns for the residual, and the sum of squares that it leaves.
struct Solution {
  Eigen::VectorXd x;
  double left = 0;
};

Solution solve(const Products& sum, const std::vector<int>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd gram(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    right[i] = sum.of(columns[static_cast<std::size_t>(i)], kResidual);
    for (Eigen::Index k = 0; k < n; ++k) {
      gram(i, k) = sum.of(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(k)]);
    }
  }
  const Eigen::VectorXd unit = gram.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::MatrixXd scaled = unit.asDiagonal() * gram * unit.asDiagonal();
  const Eigen::VectorXd x =
      unit.asDiagonal() * scaled.completeOrthogonalDecomposition().solve(unit.asDiagonal() * right);
  return {x, sum.of(kResidual, kResidual) - right.dot(x)};
}

bool possible(Kind kind, double size) {
  return size > 0 || (kind != Kind::kDryFriction && kind != Kind::kSquareDamping);
}

}  // namespace

ModelCheck check_model(const Resampled& resampled, const BatchFit& fit) {
  ModelCheck out;
  if (fit.stop == StopReason::kNoData || fit.stop == StopReason::kExact || !(fit.inertia.value > 0)) return out;
  const std::vector<Segment> segments = gap_free_segments(resampled.record, TorqueSignal::Between::kBandLimited);
  if (segments.size() != fit.segments.size()) return out;
  std::vector<double> noise_nm = resampled_white_noise(resampled);
  double fast = 0;
  double white = 0;
  for (const Segment& segment : segments) {
    fast += fast_power(segment.net_torque_nm);
    white += fast_power(of_segment(noise_nm, segment));
  }
  if (white > 0) out.torque_noise_nm = std::sqrt(fast / white);
  for (double& torque_nm : noise_nm) torque_nm *= out.torque_noise_nm;
  Products sum;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    add(segments[i], fit.segments[i], fit, resampled, noise_nm, sum);
  }
  if (!sum.of.allFinite() || !(sum.of(kResidual, kResidual) > 0)) return out;

  std::vector<int> base{0, 1, 2};
  if (fit.torque_offset) base.push_back(3);
  // What noise on the torque adds to the products with the residual is taken off them again, and moves the fit by that.
  Products corrected = sum;
  for (int i = 0; i < kResidual; ++i) corrected.of(i, kResidual) += sum.of(kNoise + i, kNoiseAngle);
  const Solution as_fitted = solve(sum, base);
  const Solution without = solve(corrected, base);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    out.torque_noise_bias[i] = as_fitted.x[at] - without.x[at];
  }

  const auto n = static_cast<double>(sum.samples);
  const std::array fitted{&fit.inertia, &fit.damping, &fit.stiffness};
  for (int kind = 0; kind < kKinds; ++kind) {
    std::vector<int> columns = base;
    // Clocks that drift apart need not have begun together.
    if (kAll[static_cast<std::size_t>(kind)] == Kind::kClockDrift) columns.push_back(kShared);
    columns.push_back(kShared + kind);
    const auto numbers = static_cast<double>(columns.size() - base.size());
    const Solution with = solve(corrected, columns);
    Alternative one;
    one.kind = kAll[static_cast<std::size_t>(kind)];
    one.size = with.x[with.x.size() - 1];
    one.evidence_nats =
        n / 2 * std::log(without.left / with.left) - numbers * std::log(n) / 2 - std::log(double{kKinds});
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double moved = with.x[at] - without.x[at];
      one.value[i] = fitted[i]->value + moved;
      const double sd = std::hypot(fitted[i]->sd, out.torque_noise_bias[i]);
      const bool out_of_interval = std::abs(moved) > kNormal95 * sd;
      const bool usable = std::abs(moved) <= kUsable * std::abs(fitted[i]->value);
      const bool claimed = fitted[i]->state == ParameterState::kValid;
      if (!claimed || !out_of_interval || !(one.evidence_nats > 0)) continue;
      one.shifts = true;
      one.matters = one.matters || !usable;
    }
    if (std::isfinite(one.evidence_nats) && possible(one.kind, one.size)) out.alternatives.push_back(one);
  }
  std::ranges::sort(out.alternatives, std::greater<>(), &Alternative::evidence_nats);
  return out;
}

ModelCheck check_model(const Resampled& resampled, bool torque_offset) {
  FitOptions options;
  options.torque_offset = torque_offset;
  options.convergence_factor = false;
  return check_model(resampled, fit_batch(resampled.record, options));
}

}  // namespace steerid
