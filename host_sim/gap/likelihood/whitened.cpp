// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gap/likelihood/whittle.hpp"
#include "log/resample.hpp"

namespace steerid::gap {

namespace {

/// What a block's ends leak, weighed: columns of 1, i w, (i w)^2 and so on times `term`, real parts above imaginary
/// ones. Where a driver steers two more: the filter's flank lets pass some of what is just below the lowest line, and a
/// sinusoid of w0 that does not end where the block does leaks as w0/(w0^2 - w^2) and i w/(w0^2 - w^2).
Eigen::MatrixXd ends_of(const Spectrum& term, const Eigen::ArrayXd& omega, double lowest_hz) {
  const Eigen::Index n = term.size();
  const Eigen::ArrayXd w = omega / (2 * std::numbers::pi * kHighest_hz);
  Eigen::MatrixXd ends(2 * n, lowest_hz > 0 ? kEnds + 2 : kEnds);
  ends.col(0) << term.real(), term.imag();
  ends.col(1) << (-w * term.imag().array()).matrix(), (w * term.real().array()).matrix();
  const Eigen::ArrayXd square = w * w;  // a sign of a column says nothing
  for (Eigen::Index power = 2; power < kEnds; ++power) {
    ends.col(power).head(n) = square * ends.col(power - 2).head(n).array();
    ends.col(power).tail(n) = square * ends.col(power - 2).tail(n).array();
  }
  if (lowest_hz > 0) {
    const double flank = (lowest_hz - kTransition_hz / 2) / kHighest_hz;
    for (Eigen::Index power = 0; power < 2; ++power) {
      ends.col(kEnds + power).head(n) = ends.col(power).head(n).array() / (square - flank * flank);
      ends.col(kEnds + power).tail(n) = ends.col(power).tail(n).array() / (square - flank * flank);
    }
  }
  return ends;
}

/// Gram and Schmidt's method, twice, which is enough (Giraud, Langou and Rozloznik, Computers and Mathematics with
/// Applications 50, 2005). Columns of even and of odd powers are orthogonal as they are.
void make_orthonormal(Eigen::MatrixXd& ends) {
  for (Eigen::Index power = 0; power < ends.cols(); ++power) {
    auto column = ends.col(power);
    column.normalize();
    for (int time = 0; time < 2; ++time) {
      for (Eigen::Index before = power - 2; before >= 0; before -= 2) {
        column -= ends.col(before).dot(column) * ends.col(before);
      }
      column.normalize();
    }
  }
}

}  // namespace

Whittle::Whitened::Whitened(const BlockSpectra& spectra, const Response& response, const NoiseFloor& floor,
                            const Roles& roles)
    : weight_(spectra.bins()) {
  const double rate_variance = floor.slow_variance * floor.slow_colour.rate_variance() + floor.fast.rate_variance();
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    if (!is_among(roles, bins.block.role)) continue;
    const Eigen::Index n = bins.count;
    const Eigen::VectorXd gain = response.gain.segment(bins.first, n).cwiseAbs2();
    auto weight = weight_.segment(bins.first, n);
    weight = floor.density(spectra, gain, bins.first).cwiseSqrt().cwiseInverse();
    const double half = bins.below == 0 ? 0.5 : 0;  // the line at zero is real
    weight[0] *= std::sqrt(1 - half);
    Part& part = parts_.emplace_back();
    part.bins = &bins;
    part.ends = ends_of(weight.cwiseProduct(response.ends.segment(bins.first, n)),
                        spectra.omega().segment(bins.first, n).array(), floor.lowest_hz);
    make_orthonormal(part.ends);
    add_trends(spectra, response, floor.slow_variance, rate_variance, part);
    add_hidden(response, part);
    part.lines = static_cast<double>(n) - half - static_cast<double>(part.ends.cols()) / 2;
    const Eigen::VectorXd counted = floor.counted_density(spectra, gain, bins.first);
    part.sum_log_density += counted.array().log().sum() - half * std::log(counted[0]);
    rows_ += part.rows();
  }
}

/// What a block begins with and ends with differs by as much as the slow torque changed in between: in the block's
/// lines a saw-tooth, 1/(i w), and one of the slope, 1/(i w)^2, far above the torque's own density. Both are normal
/// with a known variance, one real number each: a covariance of rank two on top of the lines' own.
void Whittle::Whitened::add_trends(const BlockSpectra& spectra, const Response& response, double variance,
                                   double rate_variance, Part& part) const {
  const Eigen::Index first = part.bins->first;
  const Eigen::Index n = part.bins->count;
  part.trends = Eigen::MatrixXd::Zero(2 * n, 2);
  part.shrink = Eigen::VectorXd::Zero(part.trends.cols());
  if (!(variance > 0)) return;
  // Two values far apart are independent: their difference has twice the variance. A row's own variance is a half.
  const double unit = 2 * kResampledRateHz / std::sqrt(static_cast<double>(part.bins->block.count));
  const double jump = unit * std::sqrt(variance);
  const double slope = unit * std::sqrt(rate_variance);
  // Beyond the line at zero, whose own value is whatever it is.
  const Spectrum passed = weight_.segment(first + 1, n - 1).cwiseProduct(response.gain.segment(first + 1, n - 1));
  const Eigen::ArrayXd integral = spectra.omega().segment(first + 1, n - 1).array().inverse();
  const auto set = [&](Eigen::Index column, const Eigen::ArrayXd& real, const Eigen::ArrayXd& imaginary) {
    part.trends.col(column).segment(1, n - 1) = real;
    part.trends.col(column).segment(n + 1, n - 1) = imaginary;
  };
  set(0, jump * integral * passed.imag().array(), -jump * integral * passed.real().array());
  const Eigen::ArrayXd twice = -slope * integral * integral;
  set(1, twice * passed.real().array(), twice * passed.imag().array());
  part.trends -= part.ends * (part.ends.transpose() * part.trends).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(Eigen::Matrix2d(part.trends.transpose() * part.trends));
  const Eigen::Vector2d power = solver.eigenvalues().cwiseMax(1e-12);
  part.trends = (part.trends * solver.eigenvectors() * power.cwiseSqrt().cwiseInverse().asDiagonal()).eval();
  for (Eigen::Index i = 0; i < part.trends.cols(); ++i) {
    part.shrink[i] = 1 - 1 / std::sqrt(1 + power[i]);
    part.sum_log_density += std::log1p(power[i]) / 2;
  }
}

void Whittle::Whitened::clean(const Part& part, Eigen::Ref<Eigen::MatrixXd> rows) {
  rows -= part.ends * (part.ends.transpose() * rows).eval();
  rows -= part.trends * part.shrink.asDiagonal() * (part.trends.transpose() * rows).eval();
}

/// What a clipped torque hid (plant/hidden_samples.hpp): shapes of known variance that passed through the response, so
/// many ranks more of covariance. Instead of its root the most likely sizes of the shapes are taken off and stand as
/// rows of their own: the sum of squares is the same.
void Whittle::Whitened::add_hidden(const Response& response, Part& part) const {
  const Eigen::Index shapes = part.bins->hidden.cols();
  const Eigen::Index n = part.bins->count;
  part.hidden.resize(2 * n, shapes);
  if (shapes == 0) return;
  const Spectrum gain =
      weight_.segment(part.bins->first, n).cwiseProduct(response.gain_of_recorded().segment(part.bins->first, n));
  const Eigen::MatrixXcd through = std::numbers::sqrt2 * gain.asDiagonal() * part.bins->hidden;
  part.hidden << through.real(), through.imag();
  clean(part, part.hidden);
  Eigen::MatrixXd square = Eigen::MatrixXd::Identity(shapes, shapes);
  square.selfadjointView<Eigen::Lower>().rankUpdate(part.hidden.transpose());
  part.root = square.selfadjointView<Eigen::Lower>().llt().matrixL();
  part.sum_log_density += part.root.diagonal().array().log().sum();
}

Eigen::VectorXd Whittle::Whitened::known(const BlockSpectra& spectra, double highest_rad_s) const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(spectra.bins());
  for (const Part& part : parts_) {
    if (part.hidden.cols() == 0) continue;
    const Eigen::Index n = part.bins->count;
    const auto omega = spectra.omega().segment(part.bins->first, n);
    const Eigen::Index slow = std::ranges::upper_bound(omega, highest_rad_s) - omega.begin();
    for (const Eigen::Index from : {Eigen::Index{0}, n}) {
      const Eigen::MatrixXd rows = part.hidden.middleRows(from, slow).transpose();
      out.segment(part.bins->first, slow) -=
          part.root.triangularView<Eigen::Lower>().solve(rows).colwise().squaredNorm().transpose() / 2;
    }
  }
  return out;
}

Eigen::VectorXd Whittle::Whitened::operator()(const Spectrum& signal) const {
  Eigen::VectorXd out(rows_);
  Eigen::Index at = 0;
  for (const Part& part : parts_) {
    const Eigen::Index n = part.bins->count;
    const Eigen::Index shapes = part.hidden.cols();
    auto rows = out.segment(at, 2 * n);
    const auto weight = weight_.segment(part.bins->first, n);
    rows.head(n) = weight.cwiseProduct(signal.segment(part.bins->first, n).real());
    rows.tail(n) = weight.cwiseProduct(signal.segment(part.bins->first, n).imag());
    clean(part, rows);
    if (shapes > 0) {
      const auto root = part.root.triangularView<Eigen::Lower>();
      out.segment(at + 2 * n, shapes) = root.transpose().solve(root.solve(part.hidden.transpose() * rows));
      rows -= part.hidden * out.segment(at + 2 * n, shapes);
    }
    at += part.rows();
  }
  return out;
}

std::array<Misfit, 3> Whittle::Whitened::misfits(const Spectrum& residual) const {
  std::array<Misfit, 3> out;
  const Eigen::VectorXd all = (*this)(residual);
  Eigen::Index at = 0;
  for (const Part& part : parts_) {
    const double chi = all.segment(at, part.rows()).squaredNorm();
    out[static_cast<std::size_t>(part.bins->block.role)] +=
        Misfit{.cost = chi + part.sum_log_density, .chi = chi, .lines = part.lines};
    at += part.rows();
  }
  return out;
}

double Whittle::Whitened::sum_log_density() const {
  double sum = 0;
  for (const Part& part : parts_) sum += part.sum_log_density;
  return sum;
}

double Whittle::Whitened::lines() const {
  double sum = 0;
  for (const Part& part : parts_) sum += part.lines;
  return sum;
}

Spectrum Whittle::Whitened::without_ends(const Spectrum& signal) const {
  Spectrum out = Spectrum::Zero(signal.size());
  const Eigen::VectorXd rows = (*this)(signal);
  Eigen::Index at = 0;
  for (const Part& part : parts_) {
    const Eigen::Index n = part.bins->count;
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index bin = part.bins->first + k;
      out[bin] = std::complex<double>(rows[at + k], rows[at + n + k]) / weight_[bin];
    }
    at += part.rows();
  }
  return out;
}

}  // namespace steerid::gap
