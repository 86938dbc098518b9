// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/block_spectra.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace steerid::gap {

using Complex = std::complex<double>;

Complex zero_order_hold(double turn) {
  const double half = turn / 2;
  return half > 0 ? std::polar(std::sin(half) / half, -half) : Complex(1);
}

BlockSpectra::BlockSpectra(std::vector<Block> blocks, double highest_hz, double lowest_hz) {
  std::vector<double> omega;
  for (const Block& block : blocks) {
    const double step_hz = kResampledRateHz / static_cast<double>(block.count);
    const auto below = static_cast<Eigen::Index>(std::ceil(lowest_hz / step_hz));
    const auto end = std::min<Eigen::Index>(static_cast<Eigen::Index>(highest_hz / step_hz) + 1,
                                            static_cast<Eigen::Index>(block.count / 2));
    blocks_.push_back({block, static_cast<Eigen::Index>(omega.size()), end - below, below});
    for (Eigen::Index k = below; k < end; ++k) {
      omega.push_back(2 * std::numbers::pi * step_hz * static_cast<double>(k));
    }
  }
  omega_ = Eigen::Map<const Eigen::VectorXd>(omega.data(), static_cast<Eigen::Index>(omega.size()));
}

Spectrum BlockSpectra::of(std::span<const double> signal) const {
  Spectrum out(bins());
  thread_local Eigen::FFT<double> transform;  // keeps its tables
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd time;
  Eigen::VectorXcd lines;
  for (const Bins& bins : blocks_) {
    time = Eigen::Map<const Eigen::VectorXd>(signal.data() + bins.block.first,
                                             static_cast<Eigen::Index>(bins.block.count));
    transform.fwd(lines, time);
    out.segment(bins.first, bins.count) =
        lines.segment(bins.below, bins.count) / std::sqrt(static_cast<double>(bins.block.count));
  }
  return out;
}

void BlockSpectra::hide(std::size_t first, const Eigen::MatrixXd& shapes, bool held) {
  for (Bins& bins : blocks_) {
    const std::size_t begin = std::max(first, bins.block.first);
    const std::size_t end =
        std::min(first + static_cast<std::size_t>(shapes.rows()), bins.block.first + bins.block.count);
    if (begin >= end || shapes.cols() == 0) continue;
    const auto length = static_cast<Eigen::Index>(end - begin);
    Eigen::MatrixXcd waves(bins.count, length);
    for (Eigen::Index k = 0; k < bins.count; ++k) {
      const double turn = omega_[bins.first + k] / kResampledRateHz;
      const Complex hold = held ? zero_order_hold(turn) : Complex(1);
      const Complex step = std::polar(1.0, -turn);
      Complex wave = hold * std::polar(1 / std::sqrt(static_cast<double>(bins.block.count)),
                                       -turn * static_cast<double>(begin - bins.block.first));
      for (Eigen::Index i = 0; i < length; ++i, wave *= step) waves(k, i) = wave;
    }
    const Eigen::Index before = bins.hidden.cols();
    bins.hidden.conservativeResize(bins.count, before + shapes.cols());
    bins.hidden.rightCols(shapes.cols()) = waves * shapes.middleRows(static_cast<Eigen::Index>(begin - first), length);
  }
}

void BlockSpectra::condense_hidden(const Eigen::VectorXd& weight, double least) {
  for (Bins& bins : blocks_) {
    if (bins.hidden.cols() == 0) continue;
    const Eigen::MatrixXcd weighed = weight.segment(bins.first, bins.count).asDiagonal() * bins.hidden;
    const Eigen::MatrixXd square = (weighed.adjoint() * weighed).real();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(square);
    // Where most of a block was clipped the largest have to do: every one more is paid for with every response.
    constexpr Eigen::Index kMost = 48;
    const Eigen::Index plain = std::ranges::count_if(solver.eigenvalues(), [&](double power) { return power > least; });
    bins.hidden = (bins.hidden * solver.eigenvectors().rightCols(std::min(plain, kMost))).eval();
  }
}

}  // namespace steerid::gap
