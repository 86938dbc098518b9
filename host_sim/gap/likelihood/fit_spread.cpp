// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/fit_spread.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "gap/likelihood/student.hpp"

namespace steerid::gap {
namespace {

/// What a constant, a drift or a sinusoid is known by stands in one band, and an instant in one block.
constexpr double kLeastLeft = 0.25;

/// The whitened rows around a fit: what is left, and its slopes in the fitted numbers.
struct Linearised {
  Eigen::VectorXd rows;
  Eigen::MatrixXd slopes;
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;  ///< the gradient of what the loosened priors cost less
};

/// `residual` is what the model leaves at the fit. Central differences over the number's own deviation, all others
/// known: where sticking and impacts make the rows jagged it is their course over the interval that counts, and not a
/// corner.
Linearised linearise(ResidualModel& model, Spectrum residual, const Whittle::Fit& fit,
                     const std::vector<Fitted>& fitted, const Whittle::Whitened& whitened) {
  Linearised out;
  Response response;
  out.rows = whitened(residual);
  const auto count = static_cast<Eigen::Index>(fitted.size());
  out.slopes = Eigen::MatrixXd::Zero(out.rows.size(), count);
  out.information = Eigen::MatrixXd::Zero(count, count);
  out.pull = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Fitted& one = fitted[static_cast<std::size_t>(i)];
    if (!(one.scale > 0)) continue;  // a choice, not a number
    const double h = std::clamp(1 / std::sqrt(std::max(fit.information(i, i), 1e-300)), 1e-3 * one.scale, one.scale);
    Eigen::VectorXd x = fit.x;
    x[i] = std::min(fit.x[i] + h, one.high);
    const double above = x[i];
    model.evaluate(x, residual, response);
    out.slopes.col(i) = whitened(residual);
    x[i] = std::max(fit.x[i] - h, one.low);
    model.evaluate(x, residual, response);
    out.slopes.col(i) = (out.slopes.col(i) - whitened(residual)) / (above - x[i]);
    const double loosened = 1 / (kPriorsLoosened * kPriorsLoosened);
    out.information(i, i) = loosened * one.prior.weight(fit.x[i]);
    out.pull[i] = (1 - loosened) * one.prior.slope(fit.x[i]);
  }
  out.information += 2 * out.slopes.transpose() * out.slopes;
  return out;
}

/// To which group each row belongs.
struct Groups {
  std::vector<std::size_t> of_row;
  std::size_t count = 0;
};

template <class GroupOfBin>
Groups grouped(const Whittle& whittle, const Whittle::Roles& roles, std::size_t count, GroupOfBin group) {
  Groups out{{}, count};
  std::size_t block = 0;
  for (const BlockSpectra::Bins& bins : whittle.spectra().blocks()) {
    if (!is_among(roles, bins.block.role)) continue;
    for (int part = 0; part < 2; ++part) {  // real and imaginary
      for (Eigen::Index k = 0; k < bins.count; ++k) out.of_row.push_back(group(block, bins.first + k));
    }
    for (const auto& shape : bins.hidden.colwise()) {  // of the line where it is largest
      Eigen::Index largest = 0;
      shape.cwiseAbs2().maxCoeff(&largest);
      out.of_row.push_back(group(block, bins.first + largest));
    }
    ++block;
  }
  return out;
}

Groups by_block(const Whittle& whittle, const Whittle::Roles& roles) {
  const auto counts = [&](const BlockSpectra::Bins& bins) { return is_among(roles, bins.block.role); };
  const auto blocks = static_cast<std::size_t>(std::ranges::count_if(whittle.spectra().blocks(), counts));
  return grouped(whittle, roles, blocks, [](std::size_t block, Eigen::Index) { return block; });
}

/// Bands of equal shares in what the rows tell of the numbers.
Groups by_band(const Whittle& whittle, const Whittle::Roles& roles, const Linearised& around) {
  constexpr std::size_t kBands = 8;
  const Eigen::VectorXd scale = around.information.diagonal().cwiseMax(1e-300).cwiseInverse();
  const Eigen::VectorXd told = around.slopes.cwiseAbs2() * scale;
  const Groups rows =
      grouped(whittle, roles, 0, [](std::size_t, Eigen::Index bin) { return static_cast<std::size_t>(bin); });
  std::vector<std::pair<double, double>> by_rate;  // rad/s, told
  for (Eigen::Index row = 0; row < told.size(); ++row) {
    const auto bin = static_cast<Eigen::Index>(rows.of_row[static_cast<std::size_t>(row)]);
    by_rate.emplace_back(whittle.spectra().omega()[bin], told[row]);
  }
  std::ranges::sort(by_rate);
  std::vector<double> edges;  // the upper ones, but for the last band's
  double sum = 0;
  for (const auto& [rate, share] : by_rate) {
    sum += share;
    if (edges.size() + 1 < kBands && sum > told.sum() * static_cast<double>(edges.size() + 1) / kBands)
      edges.push_back(rate);
  }
  return grouped(whittle, roles, kBands, [&](std::size_t, Eigen::Index bin) {
    return static_cast<std::size_t>(std::ranges::lower_bound(edges, whittle.spectra().omega()[bin]) - edges.begin());
  });
}

/// Jackknife: what the fit moves by as one group after the other is left out, as a variance. Zero for a number of which
/// less than kLeastLeft of what is known is left without one of them: such groups cannot be compared.
Eigen::VectorXd variance_by(const Groups& groups, const Linearised& around) {
  const Eigen::Index count = around.slopes.cols();
  std::vector<Eigen::VectorXd> score(groups.count, Eigen::VectorXd::Zero(count));
  std::vector<Eigen::MatrixXd> others(groups.count, around.information);
  for (Eigen::Index row = 0; row < around.rows.size(); ++row) {
    const std::size_t group = groups.of_row[static_cast<std::size_t>(row)];
    const auto slopes = around.slopes.row(row);
    score[group] += 2 * around.rows[row] * slopes.transpose();
    others[group].noalias() -= 2 * slopes.transpose() * slopes;
  }
  Eigen::MatrixXd moved(count, static_cast<Eigen::Index>(groups.count));
  const Eigen::VectorXd all = covariance_of(around.information).diagonal();
  Eigen::VectorXd counts = Eigen::VectorXd::Ones(count);
  for (std::size_t group = 0; group < groups.count; ++group) {
    const Eigen::MatrixXd without = covariance_of(others[group]);
    moved.col(static_cast<Eigen::Index>(group)) = without * score[group];
    for (Eigen::Index i = 0; i < count; ++i) {
      if (all[i] < kLeastLeft * without(i, i)) counts[i] = 0;
    }
  }
  const auto n = static_cast<double>(groups.count);
  const Eigen::VectorXd variance = (moved.colwise() - moved.rowwise().mean()).rowwise().squaredNorm() * (n - 1) / n;
  return variance.cwiseProduct(counts);
}

}  // namespace

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information) {
  const Eigen::Index n = information.rows();
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = information(i, i) > 0 ? 1 / std::sqrt(information(i, i)) : 0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  const Eigen::VectorXd root = solver.eigenvalues().cwiseMax(1e-12).cwiseInverse();
  return scale.asDiagonal() * solver.eigenvectors() * root.asDiagonal() * solver.eigenvectors().transpose() *
         scale.asDiagonal();
}

FitSpread spread_of(const Whittle& whittle, ResidualModel& model, const Whittle::Fit& fit,
                    const std::vector<Fitted>& fitted, const Whittle::Roles& roles) {
  const auto count = static_cast<Eigen::Index>(fitted.size());
  Spectrum residual;
  Response response;
  model.evaluate(fit.x, residual, response);
  const Whittle::Whitened whitened(whittle.spectra(), response, fit.floor, roles);
  const Linearised around = linearise(model, residual, fit, fitted, whitened);
  const Eigen::MatrixXd covariance = covariance_of(around.information);
  const double inflate = std::max(1.0, fit.excess(roles));
  const Groups blocks = by_block(whittle, roles);
  const Groups bands = by_band(whittle, roles, around);
  const Eigen::VectorXd by_blocks = variance_by(blocks, around);
  const Eigen::VectorXd by_bands = variance_by(bands, around);
  const double blocks95 = blocks.count > 2 ? student95(static_cast<double>(blocks.count) - 1) : 0;
  const double bands95 = student95(static_cast<double>(bands.count) - 1);
  // Where the record alone, without so much of the priors' pull, would have it.
  const Eigen::VectorXd loosened = covariance * around.pull;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  FitSpread out{Eigen::VectorXd::Constant(count, -infinity), Eigen::VectorXd::Constant(count, infinity), {}};
  Eigen::VectorXd widened = Eigen::VectorXd::Zero(count);  // over the deviation from the model
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!(around.information(i, i) > 0)) continue;
    const double model_sd = std::sqrt(inflate * covariance(i, i));
    const double half_width =
        std::max({kNormal95 * model_sd, blocks95 * std::sqrt(by_blocks[i]), bands95 * std::sqrt(by_bands[i])});
    const Fitted& one = fitted[static_cast<std::size_t>(i)];
    out.low[i] = std::max(fit.x[i] + std::min(0.0, loosened[i]) - half_width, std::min(one.low, fit.x[i]));
    out.high[i] = std::min(fit.x[i] + std::max(0.0, loosened[i]) + half_width, std::max(one.high, fit.x[i]));
    widened[i] = half_width / kNormal95 / std::sqrt(covariance(i, i));
  }
  const Eigen::LDLT<Eigen::MatrixXd> factors(covariance);
  out.root = factors.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  out.root =
      (widened.asDiagonal() * (factors.transpositionsP().transpose() * (factors.matrixL() * out.root).eval())).eval();
  return out;
}

}  // namespace steerid::gap
