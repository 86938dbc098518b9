// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/hidden_samples.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "plant/cubic.hpp"

namespace steerid {
namespace {

constexpr std::size_t kSlopeSamples = 3;

/// A smooth beginning: a Hermite cubic from the last known sample to the next one, with the slopes of a line through
/// the known samples beside the stretch.
void bridge(std::span<double> signal, const HiddenStretch& stretch, double level) {
  const std::size_t begin = stretch.first;
  const std::size_t end = begin + stretch.count;
  if (begin < kSlopeSamples || end + kSlopeSamples > signal.size()) return;  // no known samples to lean on
  const auto slope = [&](std::size_t from) {
    return (signal[from + kSlopeSamples - 1] - signal[from]) / static_cast<double>(kSlopeSamples - 1);
  };
  const Cubic peak = Cubic::hermite(signal[begin - 1], slope(begin - kSlopeSamples), signal[end], slope(end),
                                    static_cast<double>(stretch.count + 1));
  for (std::size_t i = begin; i < end; ++i) {
    const double value = peak.at(static_cast<double>(i - begin + 1));
    signal[i] = stretch.side * std::max(stretch.side * value, level);
  }
}

}  // namespace

std::vector<HiddenStretch> clipped_stretches(std::span<const double> signal, double level) {
  constexpr double kNearly = 0.98;  // anti-alias filters keep clipped samples off the exact level
  constexpr double kDeviations = 4;
  double squares = 0;
  double beyond = 0;
  for (const double value : signal) {
    if (std::abs(value) <= level) continue;
    squares += std::pow(std::abs(value) - level, 2);
    beyond += 1;
  }
  const double noise = beyond > 0 ? std::sqrt(squares / beyond) : 0;
  const double least = std::min(kNearly * level, level - kDeviations * noise);
  std::vector<HiddenStretch> stretches;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    if (std::abs(signal[i]) < least) continue;
    const int side = signal[i] > 0 ? 1 : -1;
    const bool goes_on =
        !stretches.empty() && stretches.back().side == side && stretches.back().first + stretches.back().count == i;
    if (goes_on) {
      ++stretches.back().count;
    } else {
      stretches.push_back({i, 1, side});
    }
  }
  return stretches;
}

HiddenSamples::HiddenSamples(std::span<double> signal, std::vector<HiddenStretch> stretches, double level)
    : stretches_(std::move(stretches)) {
  for (const HiddenStretch& stretch : stretches_) bridge(signal, stretch, level);
  constexpr std::size_t kOrder = 40;
  constexpr std::size_t kSamplesACoefficient = 10;
  const std::size_t order = std::min(kOrder, signal.size() / kSamplesACoefficient);
  if (stretches_.empty() || order < 4) return;
  coefficients_.resize(static_cast<Eigen::Index>(order) + 1);
  constexpr int kTurns = 8;
  for (int turn = 0; turn < kTurns; ++turn) {
    fit_coefficients(signal);
    fill(signal, level);
  }
}

/// Least squares over all samples that have enough others before them (the covariance method).
void HiddenSamples::fit_coefficients(std::span<const double> signal) {
  const Eigen::Index order = coefficients_.size() - 1;
  const auto x = [&](Eigen::Index i) { return signal[static_cast<std::size_t>(i)]; };
  const auto samples = static_cast<Eigen::Index>(signal.size());
  Eigen::MatrixXd products(order + 1, order + 1);
  for (Eigen::Index lag = 0; lag <= order; ++lag) {
    double sum = 0;
    for (Eigen::Index t = order; t < samples; ++t) sum += x(t) * x(t - lag);
    products(0, lag) = sum;
    for (Eigen::Index i = 1; i + lag <= order; ++i) {
      const Eigen::Index j = i + lag;
      products(i, j) = products(i - 1, j - 1) + x(order - i) * x(order - j) - x(samples - i) * x(samples - j);
    }
  }
  products.triangularView<Eigen::StrictlyLower>() = products.transpose();
  constexpr double kAccuracy = 1e-10;  // a formula has no innovations, and no rounding may pass for them
  products.diagonal().array() += kAccuracy * products(0, 0);
  coefficients_[0] = 1;
  coefficients_.tail(order) = -products.bottomRightCorner(order, order).ldlt().solve(products.col(0).tail(order));
  innovation_variance_ = coefficients_.dot(products * coefficients_) / static_cast<double>(samples - 2 * order);
  coupled_.resize(order + 1);
  for (Eigen::Index lag = 0; lag <= order; ++lag) {
    coupled_[lag] = coefficients_.head(order + 1 - lag).dot(coefficients_.tail(order + 1 - lag));
  }
}

/// How much two samples' innovations have in common. Those near the signal's ends take part in fewer.
double HiddenSamples::coupling(std::size_t one, std::size_t other, std::size_t samples) const {
  const auto order = static_cast<std::size_t>(coefficients_.size() - 1);
  const std::size_t low = std::min(one, other);
  const std::size_t high = std::max(one, other);
  if (high - low > order) return 0;
  if (low >= order && high + order < samples) return coupled_[static_cast<Eigen::Index>(high - low)];
  double sum = 0;
  for (std::size_t t = std::max(order, high); t <= std::min(samples - 1, low + order); ++t) {
    sum += coefficients_[static_cast<Eigen::Index>(t - one)] * coefficients_[static_cast<Eigen::Index>(t - other)];
  }
  return sum;
}

/// The hidden samples of the least innovations; those that would come to lie within the level stay on it.
void HiddenSamples::fill(std::span<double> signal, double level) const {
  const auto order = static_cast<std::size_t>(coefficients_.size() - 1);
  const std::size_t samples = signal.size();
  std::vector<int> side(samples, 0);
  for (const HiddenStretch& stretch : stretches_) {
    std::fill_n(side.begin() + static_cast<std::ptrdiff_t>(stretch.first), stretch.count, stretch.side);
  }
  std::vector<int> free = side;
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::size_t> hidden;
    std::vector<Eigen::Index> place(samples, -1);
    for (std::size_t i = 0; i < samples; ++i) {
      if (free[i] == 0) continue;
      place[i] = static_cast<Eigen::Index>(hidden.size());
      hidden.push_back(i);
    }
    if (hidden.empty()) return;
    const auto count = static_cast<Eigen::Index>(hidden.size());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index row = 0; row < count; ++row) {
      const std::size_t i = hidden[static_cast<std::size_t>(row)];
      const std::size_t from = i > order ? i - order : 0;
      for (std::size_t j = from; j <= std::min(samples - 1, i + order); ++j) {
        const double shared = coupling(i, j, samples);
        if (free[j] == 0) {
          right[row] -= shared * signal[j];
        } else if (j <= i) {
          entries.emplace_back(row, place[j], shared);
        }
      }
    }
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> solver(matrix);
    if (solver.info() != Eigen::Success) return;
    const Eigen::VectorXd values = solver.solve(right);
    bool again = false;
    for (Eigen::Index row = 0; row < count; ++row) {
      const std::size_t i = hidden[static_cast<std::size_t>(row)];
      signal[i] = values[row];
      if (side[i] * values[row] >= level) continue;
      signal[i] = side[i] * level;
      free[i] = 0;
      again = true;
    }
    if (!again) return;
  }
}

Eigen::MatrixXd HiddenSamples::uncertain(const HiddenStretch& stretch, double negligible_variance,
                                         double highest) const {
  const auto length = static_cast<Eigen::Index>(stretch.count);
  if (coefficients_.size() == 0) return Eigen::MatrixXd::Zero(length, 0);
  const auto wanted = static_cast<Eigen::Index>(std::ceil(2 * highest * static_cast<double>(length + 1)));
  const Eigen::Index waves = std::min(length, std::max<Eigen::Index>(wanted, 4));
  // Sines that are zero just outside of the stretch.
  Eigen::MatrixXd sines(length, waves);
  for (Eigen::Index m = 0; m < waves; ++m) {
    for (Eigen::Index i = 0; i < length; ++i) {
      sines(i, m) =
          std::sqrt(2.0 / static_cast<double>(length + 1)) *
          std::sin(std::numbers::pi * static_cast<double>((m + 1) * (i + 1)) / static_cast<double>(length + 1));
    }
  }
  Eigen::MatrixXd coupled = Eigen::MatrixXd::Zero(length, waves);
  for (Eigen::Index i = 0; i < length; ++i) {
    const Eigen::Index reach = coupled_.size() - 1;
    for (Eigen::Index j = std::max<Eigen::Index>(0, i - reach); j <= std::min(length - 1, i + reach); ++j) {
      coupled.row(i) += coupled_[std::abs(i - j)] * sines.row(j);
    }
  }
  const Eigen::MatrixXd precision = sines.transpose() * coupled / innovation_variance_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(precision);
  Eigen::Index kept = 0;  // the smallest precisions come first
  while (kept < waves && 1 / std::max(solver.eigenvalues()[kept], 1e-300) > negligible_variance) ++kept;
  return sines * solver.eigenvectors().leftCols(kept) *
         solver.eigenvalues().head(kept).cwiseMax(1e-300).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace steerid
