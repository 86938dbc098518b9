// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/instrumented_rows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>

#include "fit/gaussian_taps.hpp"
#include "log/record_quality.hpp"

namespace steerid {
namespace {

constexpr double kPeriodS = 0.01;
constexpr double kSigmaS = 0.02;
constexpr double kSlowSigmaS = 0.0663;  // 3 dB at 2 Hz
constexpr std::size_t kOneIn = 4;
constexpr std::size_t kShortestStretch = 20;  // rows
// At a stretch's start the functions are of a source that was 0 before, which the record does not say. After 1.2 s that
// is 0.4 % of the power of the eighth, which remembers longest. Left in, that start is told by no other part of the
// record: by a probe of 0.2 to 1.5 Hz an arm of J 0.07 kg m2 and C 20 Nm/rad had J -0.13 to 6.6, and 0.060 to 0.079
// without it.
constexpr std::size_t kSettling = 120;  // samples
constexpr double kBlockS = 3;
constexpr Eigen::Index kMostBlocks = 40;
constexpr double kPole = 0.8607;  // exp(-15/s 10 ms): spans wheels of 1 to 6 Hz
constexpr Eigen::Index kFunctions = InstrumentedRows::kFunctions;

const GaussianTaps& taps() {
  static const GaussianTaps all(kSigmaS, kPeriodS);
  return all;
}

/// The Laguerre functions of `source` over one gap-free stretch, one a vector.
std::array<std::vector<double>, kFunctions> laguerre(const std::vector<double>& source) {
  std::array<std::vector<double>, kFunctions> all;
  std::vector<double> in = source;
  for (double& x : in) x *= std::sqrt(1 - kPole * kPole);
  for (std::vector<double>& function : all) {
    function.resize(in.size());
    double before = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
      function[i] = kPole * before + in[i];
      // The next section's all-pass (q^-1 - pole) / (1 - pole q^-1), by what this one was and is.
      in[i] = before - kPole * function[i];
      before = function[i];
    }
  }
  return all;
}

struct Spread {
  double mean = 0;
  double deviation = 0;
};

Spread spread(const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  Spread out;
  for (const double value : x) out.mean += value / n;
  for (const double value : x) out.deviation += std::pow(value - out.mean, 2) / n;
  out.deviation = std::sqrt(out.deviation);
  return out;
}

/// About its mean, in its deviation.
std::vector<double> standardized(std::vector<double> x) {
  const auto [mean, deviation] = spread(x);
  if (deviation > 0) {
    for (double& value : x) value = (value - mean) / deviation;
  }
  return x;
}

std::vector<double> product(const std::vector<double>& one, const std::vector<double>& other) {
  std::vector<double> out(one.size());
  std::ranges::transform(one, other, out.begin(), std::multiplies<>());
  return out;
}

std::vector<double> part(const std::vector<double>& x, const GapFreeRows& rows) {
  return {x.begin() + static_cast<std::ptrdiff_t>(rows.begin), x.begin() + static_cast<std::ptrdiff_t>(rows.end)};
}

/// Every column behind the prediction-error filter of `noise`.
Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns, const Autoregression& noise) {
  constexpr Eigen::Index kAtOnce = Autoregression::kColumns;
  Eigen::MatrixXd out(columns.rows(), columns.cols());
  Autoregression::Rows rows(columns.rows(), kAtOnce);
  Autoregression::Rows white;
  for (Eigen::Index first = 0; first < columns.cols(); first += kAtOnce) {
    const Eigen::Index here = std::min(kAtOnce, columns.cols() - first);
    rows.setZero();
    rows.leftCols(here) = columns.middleCols(first, here);
    noise.whiten(rows, white);
    out.middleCols(first, here) = white.leftCols(here);
  }
  return out;
}

/// Least squares from normal equations; a direction without information gets nothing.
Eigen::VectorXd solved(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(normal).solve(right);
}

}  // namespace

bool has_a_probe(const Record& record) {
  constexpr double kRounding = 1e-6;  // of its value: the last of seven digits
  if (!record.has(kProbeValid)) return false;
  const auto [mean, deviation] = spread(record.probe_nm);
  return deviation > kRounding * std::abs(mean);
}

InstrumentedRows::InstrumentedRows(const Record& record) {
  by_probe_ = !voluntary_torque_known(record.equation()) && has_a_probe(record);
  const std::vector<double> torque = record.net_torque_nm();
  const std::vector<double> source = standardized(by_probe_ ? record.probe_nm : torque);
  const double middle_rad = spread(record.angle_rad).mean;
  const std::size_t reach = taps().reach();
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    const std::size_t first = std::max(reach, kSettling);
    if (rows.size() < first + reach + kOneIn * kShortestStretch) continue;
    const std::vector<double> torque_here = part(torque, rows);
    const std::vector<double> angle_here = part(record.angle_rad, rows);
    const auto functions = laguerre(part(source, rows));
    std::vector<double> from_middle = angle_here;
    for (double& angle : from_middle) angle -= middle_rad;
    const std::vector<double> square = product(from_middle, from_middle);
    std::array<std::vector<double>, kFunctions> times_angle;
    std::ranges::transform(functions, times_angle.begin(),
                           [&](const std::vector<double>& function) { return product(from_middle, function); });
    const std::size_t count = (rows.size() - first - reach + kOneIn - 1) / kOneIn;
    Eigen::MatrixXd stretch(static_cast<Eigen::Index>(count), kColumns);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = first + k * kOneIn;
      auto row = stretch.row(static_cast<Eigen::Index>(k));
      row[kTorque] = taps().at(taps().smooth, torque_here, i);
      row.segment<3>(kMotion) << taps().at(taps().second, angle_here, i), taps().at(taps().first, angle_here, i),
          taps().at(taps().smooth, angle_here, i);
      row[kConstant] = 1;
      row[kSquare] = taps().at(taps().smooth, square, i);
      for (Eigen::Index f = 0; f < kFunctions; ++f) {
        const std::vector<double>& function = functions[static_cast<std::size_t>(f)];
        row.segment<3>(kSource + 3 * f) << taps().at(taps().second, function, i), taps().at(taps().first, function, i),
            taps().at(taps().smooth, function, i);
        row[kTimesAngle + f] = taps().at(taps().smooth, times_angle[static_cast<std::size_t>(f)], i);
      }
      time_s_.push_back(record.time_s[rows.begin + i]);
    }
    stretches_.push_back(std::move(stretch));
  }
}

double InstrumentedRows::slow_torque_power() const { return slow_unexplained_power(Eigen::Vector4d::Zero()); }

double InstrumentedRows::slow_unexplained_power(const Eigen::Vector4d& parameters) const {
  double n = 0, sum = 0, squares = 0;
  for (const double x : slow_unexplained(parameters)) n += 1, sum += x, squares += x * x;
  return n > 0 ? std::max(0.0, squares / n - sum * sum / n / n) : 0;
}

std::vector<double> InstrumentedRows::slow_unexplained(const Eigen::Vector4d& parameters) const {
  static const GaussianTaps slow(kSlowSigmaS, 1 / kRowsPerS);
  std::vector<double> out;
  for (const Eigen::VectorXd& part : unexplained(parameters)) {
    const std::span<const double> series(part.data(), static_cast<std::size_t>(part.size()));
    for (std::size_t i = slow.reach(); i + slow.reach() < series.size(); ++i) {
      out.push_back(slow.at(slow.smooth, series, i));
    }
  }
  return out;
}

std::vector<Eigen::VectorXd> InstrumentedRows::unexplained(const Eigen::Vector4d& parameters) const {
  std::vector<Eigen::VectorXd> out;
  for (const Eigen::MatrixXd& stretch : stretches_) {
    out.emplace_back(stretch.col(kTorque) - stretch.middleCols<kUnknowns>(kMotion) * parameters);
  }
  return out;
}

std::vector<Eigen::VectorXd> InstrumentedRows::unexplained(std::span<const Eigen::Vector4d> parameters) const {
  std::vector<Eigen::VectorXd> out;
  std::size_t at = 0;
  for (const Eigen::MatrixXd& stretch : stretches_) {
    Eigen::VectorXd left = stretch.col(kTorque);
    for (Eigen::Index i = 0; i < left.size(); ++i)
      left[i] -= stretch.row(i).segment<kUnknowns>(kMotion) * parameters[at++];
    out.push_back(std::move(left));
  }
  return out;
}

InstrumentedRows::White InstrumentedRows::whitened(const Autoregression& noise, double memory_s) const {
  Eigen::MatrixXd all(size(), kColumns);
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& stretch : stretches_) {
    all.middleRows(at, stretch.rows()) = whiten(stretch, noise);
    at += stretch.rows();
  }
  // Functions and constant explain the angle: what of it the source has caused.
  Eigen::MatrixXd functions(size(), kFunctions + 1);
  for (Eigen::Index f = 0; f < kFunctions; ++f) functions.col(f) = all.col(kSource + 3 * f + 2);
  functions.col(kFunctions) = all.col(kConstant);
  const Eigen::VectorXd angle = all.col(kMotion + 2);

  const auto rows_a_block = static_cast<Eigen::Index>(kBlockS * kRowsPerS);
  const Eigen::Index blocks = std::clamp(size() / rows_a_block, Eigen::Index{2}, kMostBlocks);
  const auto begin_of = [&](Eigen::Index block) { return block * size() / blocks; };
  // Of each block: products of the functions with one another and with the angle.
  std::vector<Eigen::MatrixXd> own;
  std::vector<Eigen::VectorXd> own_right;
  for (Eigen::Index block = 0; block < blocks; ++block) {
    const auto here = functions.middleRows(begin_of(block), begin_of(block + 1) - begin_of(block));
    own.emplace_back(here.transpose() * here);
    own_right.emplace_back(here.transpose() * angle.segment(begin_of(block), here.rows()));
  }
  const double block_s = static_cast<double>(size()) / kRowsPerS / static_cast<double>(blocks);
  const auto caused_in_all_but = [&](Eigen::Index block) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kFunctions + 1, kFunctions + 1);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(kFunctions + 1);
    for (Eigen::Index other = 0; other < blocks; ++other) {
      if (other == block) continue;
      const double weight = std::exp(-static_cast<double>(std::abs(other - block)) * block_s / memory_s);
      normal += weight * own[static_cast<std::size_t>(other)];
      right += weight * own_right[static_cast<std::size_t>(other)];
    }
    return solved(normal, right);
  };

  White white{all.col(kTorque), all.middleCols<kUnknowns>(kMotion), {}, all.col(kSquare), {}, {}};
  white.driven.setZero(size(), 4);
  white.instrument.setZero(size(), kUnknowns);
  white.square_instrument.setZero(size());
  white.instrument.col(3) = all.col(kConstant);
  for (Eigen::Index block = 0; block < blocks; ++block) {
    const Eigen::Index begin = begin_of(block);
    const Eigen::Index length = begin_of(block + 1) - begin;
    const Eigen::VectorXd caused = caused_in_all_but(block);
    for (Eigen::Index f = 0; f < kFunctions; ++f) {
      white.instrument.block(begin, 0, length, 3) += caused[f] * all.block(begin, kSource + 3 * f, length, 3);
      white.square_instrument.segment(begin, length) += caused[f] * all.col(kTimesAngle + f).segment(begin, length);
    }
  }
  // Each on its own: what an arm leaves of these is then the source's part of v, and of nothing else.
  Eigen::MatrixXd measured(size(), 4);
  measured << white.torque, white.motion.leftCols<3>();
  const Eigen::MatrixXd normal = functions.transpose() * functions;
  for (int i = 0; i < 4; ++i) {
    const Eigen::VectorXd caused = solved(normal, functions.transpose() * measured.col(i));
    white.driven.col(i) = functions.leftCols(kFunctions) * caused.head(kFunctions);
  }
  return white;
}

}  // namespace steerid
