#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gap/likelihood/whittle.hpp"

namespace steerid {

Whittle::Whitened::Whitened(const BlockSpectra& spectra, const Response& response, const NoiseFloor& floor,
                            const Roles& roles)
    : weight_(spectra.bins()) {
  const Eigen::VectorXd gain = response.gain.cwiseAbs2();
  weight_ = floor.density(spectra, gain).cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd counted = floor.counted_density(spectra, gain);
  const double highest = 2 * std::numbers::pi * kHighest_hz;
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    if (!is_among(roles, bins.block.role)) continue;
    weight_[bins.first] *= std::numbers::sqrt2 / 2;  // the line at zero is real: half a line
    const Eigen::Index n = bins.count;
    Eigen::MatrixXd ends(2 * n, kEnds);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index bin = bins.first + k;
      std::complex<double> term = weight_[bin] * response.ends[bin];
      for (int power = 0; power < kEnds; ++power) {
        ends(k, power) = term.real();
        ends(n + k, power) = term.imag();
        term *= std::complex<double>(0, spectra.omega()[bin] / highest);
      }
    }
    for (int power = 0; power < kEnds; ++power) ends.col(power).normalize();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(ends);
    parts_.push_back({bins, qr.householderQ() * Eigen::MatrixXd::Identity(2 * n, kEnds), {}, {}, {}, {}});
    add_trends(spectra, response, floor, parts_.back());
    add_hidden(response, parts_.back());
    rows_ += 2 * n + parts_.back().hidden.cols();
    lines_ += static_cast<double>(n) - 0.5 - kEnds / 2.0;
    sum_log_density_ += counted.segment(bins.first, n).array().log().sum() - std::log(counted[bins.first]) / 2;
  }
}

/// What a block begins with and ends with differs by as much as the slow torque changed in between: in the block's
/// lines a saw-tooth, 1/(i w), and one of the slope, 1/(i w)^2, far above the torque's own density. Both are normal
/// with a known variance, one real number each: a covariance of rank two on top of the lines' own.
void Whittle::Whitened::add_trends(const BlockSpectra& spectra, const Response& response, const NoiseFloor& floor,
                                   Part& part) {
  constexpr int kTrends = 2;
  const Eigen::Index n = part.bins.count;
  part.trends = Eigen::MatrixXd::Zero(2 * n, kTrends);
  part.shrink = Eigen::VectorXd::Zero(kTrends);
  if (!(floor.slow_variance > 0)) return;
  // Two values far apart are independent: their difference has twice the variance. A row's own variance is a half.
  const double jump = std::sqrt(4 * floor.slow_variance / static_cast<double>(part.bins.block.count)) * floor.rate_hz;
  const std::array<double, kTrends> size = {jump, jump * std::sqrt(floor.slow_colour.rate_variance())};
  for (Eigen::Index k = 1; k < n; ++k) {
    const Eigen::Index bin = part.bins.first + k;
    const std::complex<double> integral = 1.0 / std::complex<double>(0, spectra.omega()[bin]);
    std::complex<double> term = weight_[bin] * response.gain[bin];
    for (int power = 0; power < kTrends; ++power) {
      term *= integral;
      part.trends(k, power) = size[static_cast<std::size_t>(power)] * term.real();
      part.trends(n + k, power) = size[static_cast<std::size_t>(power)] * term.imag();
    }
  }
  part.trends -= part.ends * (part.ends.transpose() * part.trends).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(Eigen::Matrix2d(part.trends.transpose() * part.trends));
  const Eigen::Vector2d power = solver.eigenvalues().cwiseMax(1e-12);
  part.trends = (part.trends * solver.eigenvectors() * power.cwiseSqrt().cwiseInverse().asDiagonal()).eval();
  for (int i = 0; i < kTrends; ++i) {
    part.shrink[i] = 1 - 1 / std::sqrt(1 + power[i]);
    sum_log_density_ += std::log1p(power[i]) / 2;
  }
}

void Whittle::Whitened::clean(const Part& part, Eigen::Ref<Eigen::MatrixXd> rows) {
  rows -= part.ends * (part.ends.transpose() * rows).eval();
  rows -= part.trends * part.shrink.asDiagonal() * (part.trends.transpose() * rows).eval();
}

/// What a clipped torque hid (plant/hidden_samples.hpp): shapes of known variance that passed through the response, so
/// many ranks more of covariance. Instead of its root the most likely sizes of the shapes are taken off and stand as
/// rows of their own: the sum of squares is the same.
void Whittle::Whitened::add_hidden(const Response& response, Part& part) {
  const Eigen::Index shapes = part.bins.hidden.cols();
  const Eigen::Index n = part.bins.count;
  part.hidden.resize(2 * n, shapes);
  if (shapes == 0) return;
  Spectrum gain = weight_.segment(part.bins.first, n).cwiseProduct(response.gain.segment(part.bins.first, n));
  if (response.late.size() > 0) gain = gain.cwiseProduct(response.late.segment(part.bins.first, n)).eval();
  const Eigen::MatrixXcd through = std::numbers::sqrt2 * gain.asDiagonal() * part.bins.hidden;
  part.hidden << through.real(), through.imag();
  clean(part, part.hidden);
  Eigen::MatrixXd square = Eigen::MatrixXd::Identity(shapes, shapes);
  square.selfadjointView<Eigen::Lower>().rankUpdate(part.hidden.transpose());
  part.root = square.selfadjointView<Eigen::Lower>().llt().matrixL();
  sum_log_density_ += part.root.diagonal().array().log().sum();
}

Eigen::VectorXd Whittle::Whitened::known(const BlockSpectra& spectra, double highest_rad_s) const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(spectra.bins());
  for (const Part& part : parts_) {
    if (part.hidden.cols() == 0) continue;
    const Eigen::Index n = part.bins.count;
    const auto omega = spectra.omega().segment(part.bins.first, n);
    const Eigen::Index slow = std::ranges::upper_bound(omega, highest_rad_s) - omega.begin();
    for (const Eigen::Index from : {Eigen::Index{0}, n}) {
      const Eigen::MatrixXd rows = part.hidden.middleRows(from, slow).transpose();
      out.segment(part.bins.first, slow) -=
          part.root.triangularView<Eigen::Lower>().solve(rows).colwise().squaredNorm().transpose() / 2;
    }
  }
  return out;
}

Eigen::VectorXd Whittle::Whitened::operator()(const Spectrum& signal) const {
  Eigen::VectorXd out(rows_);
  Eigen::Index at = 0;
  for (const Part& part : parts_) {
    const Eigen::Index n = part.bins.count;
    const Eigen::Index shapes = part.hidden.cols();
    auto rows = out.segment(at, 2 * n);
    const auto weight = weight_.segment(part.bins.first, n);
    rows.head(n) = weight.cwiseProduct(signal.segment(part.bins.first, n).real());
    rows.tail(n) = weight.cwiseProduct(signal.segment(part.bins.first, n).imag());
    clean(part, rows);
    if (shapes > 0) {
      const auto root = part.root.triangularView<Eigen::Lower>();
      out.segment(at + 2 * n, shapes) = root.transpose().solve(root.solve(part.hidden.transpose() * rows));
      rows -= part.hidden * out.segment(at + 2 * n, shapes);
    }
    at += 2 * n + shapes;
  }
  return out;
}

Spectrum Whittle::Whitened::without_ends(const Spectrum& signal) const {
  Spectrum out = Spectrum::Zero(signal.size());
  const Eigen::VectorXd rows = (*this)(signal);
  Eigen::Index at = 0;
  for (const Part& part : parts_) {
    const Eigen::Index n = part.bins.count;
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index bin = part.bins.first + k;
      out[bin] = std::complex<double>(rows[at + k], rows[at + n + k]) / weight_[bin];
    }
    at += 2 * n + part.hidden.cols();
  }
  return out;
}

}  // namespace steerid
