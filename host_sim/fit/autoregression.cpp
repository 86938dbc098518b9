// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/autoregression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/akaike.hpp"

namespace steerid {
namespace {

// Orders tried past the best one before giving up: the criterion is bumpy, but not that bumpy.
constexpr int kPatience = 10;

// One lattice stage on every segment: the reflection coefficient that makes forward and backward errors smallest
// together, then the errors of the next order. The backward error is kept one sample late.
double lattice_stage(std::vector<Eigen::VectorXd>& forward, std::vector<Eigen::VectorXd>& backward) {
  double cross = 0;
  double power = 0;
  for (std::size_t s = 0; s < forward.size(); ++s) {
    const Eigen::Index n = forward[s].size() - 1;
    if (n < 1) continue;
    const auto ahead = forward[s].tail(n);
    const auto behind = backward[s].head(n);
    cross += ahead.dot(behind);
    power += ahead.squaredNorm() + behind.squaredNorm();
  }
  const double reflection = power > 0 ? -2 * cross / power : 0;
  for (std::size_t s = 0; s < forward.size(); ++s) {
    const Eigen::Index n = std::max<Eigen::Index>(forward[s].size() - 1, 0);
    const Eigen::VectorXd ahead = forward[s].tail(n);
    const Eigen::VectorXd behind = backward[s].head(n);
    forward[s] = ahead + reflection * behind;
    backward[s] = behind + reflection * ahead;
  }
  return reflection;
}

std::vector<double> step_up(const std::vector<double>& lower, double reflection) {
  std::vector<double> next = lower;
  for (std::size_t i = 0; i < lower.size(); ++i) next[i] += reflection * lower[lower.size() - 1 - i];
  next.push_back(reflection);
  return next;
}

}  // namespace

Autoregression::Autoregression(std::vector<std::vector<double>> predictors, std::span<const double> powers, int numbers)
    : predictors_(std::move(predictors)), numbers_(numbers) {
  for (const double power : powers) start_scale_.push_back(std::sqrt(powers.back() / power));
}

Autoregression Autoregression::fit(std::span<const Eigen::VectorXd> residuals, int max_order) {
  std::vector<Eigen::VectorXd> forward(residuals.begin(), residuals.end());
  std::vector<Eigen::VectorXd> backward = forward;
  double samples = 0;
  double power = 0;
  for (const Eigen::VectorXd& r : residuals) {
    samples += static_cast<double>(r.size());
    power += r.squaredNorm();
  }
  if (!(power > 0)) return {};
  power /= samples;

  std::vector<std::vector<double>> predictors;
  std::vector<double> powers = {power};
  int best = 0;
  double best_criterion = std::numeric_limits<double>::infinity();
  for (int order = 0; order <= max_order && order < best + kPatience; ++order) {
    if (order > 0) {
      const double reflection = lattice_stage(forward, backward);
      predictors.push_back(step_up(predictors.empty() ? std::vector<double>{} : predictors.back(), reflection));
      power *= 1 - reflection * reflection;
      powers.push_back(power);
    }
    if (!(power > 0)) break;
    const double criterion = corrected_akaike(samples * std::log(power), samples, order + 1);
    if (criterion < best_criterion) {
      best_criterion = criterion;
      best = order;
    }
  }
  predictors.resize(static_cast<std::size_t>(best));
  powers.resize(static_cast<std::size_t>(best) + 1);
  return {std::move(predictors), powers, best};
}

std::optional<Autoregression> Autoregression::from_autocovariance(std::span<const double> c, int numbers,
                                                                  double relative_loss) {
  std::vector<std::vector<double>> predictors;
  std::vector<double> powers = {c.front()};
  for (std::size_t order = 1; order < c.size(); ++order) {
    double sum = c[order];
    for (std::size_t k = 1; k < order; ++k) sum += predictors.back()[k - 1] * c[order - k];
    const double reflection = -sum / powers.back();
    if (!(std::abs(reflection) < 1)) return std::nullopt;
    predictors.push_back(step_up(predictors.empty() ? std::vector<double>{} : predictors.back(), reflection));
    powers.push_back(powers.back() * (1 - reflection * reflection));
  }
  const double enough = (1 + relative_loss) * powers.back();
  while (powers.size() > 1 && powers[powers.size() - 2] <= enough) powers.pop_back();
  predictors.resize(powers.size() - 1);
  return Autoregression(std::move(predictors), powers, numbers);
}

std::span<const double> Autoregression::coefficients() const {
  if (predictors_.empty()) return {};
  return predictors_.back();
}

void Autoregression::whiten(const Rows& rows, Rows& white) const {
  white.resize(rows.rows(), Eigen::NoChange);
  if (predictors_.empty()) {
    white = rows;
    return;
  }
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::Index order = std::min<Eigen::Index>(i, this->order());
    Eigen::Matrix<double, 1, kColumns> sum = rows.row(i);
    if (order > 0) {
      const std::vector<double>& a = predictors_[static_cast<std::size_t>(order - 1)];
      for (Eigen::Index k = 1; k <= order; ++k) sum += a[static_cast<std::size_t>(k - 1)] * rows.row(i - k);
    }
    white.row(i) = start_scale_[static_cast<std::size_t>(order)] * sum;
  }
}

double Autoregression::misfit(std::span<const Eigen::VectorXd> segments) const {
  double samples = 0;
  double squares = 0;
  double log_scales = 0;
  for (const Eigen::VectorXd& y : segments) {
    const Eigen::Index start = std::min<Eigen::Index>(y.size(), order());
    for (Eigen::Index i = 0; i < start; ++i) {
      double error = y[i];
      for (Eigen::Index k = 1; k <= i; ++k) {
        error += predictors_[static_cast<std::size_t>(i - 1)][static_cast<std::size_t>(k - 1)] * y[i - k];
      }
      const double scale = start_scale_[static_cast<std::size_t>(i)];
      squares += scale * scale * error * error;
      log_scales += std::log(scale);
    }
    const Eigen::Index rest = y.size() - start;
    Eigen::VectorXd errors = y.tail(rest);
    for (Eigen::Index k = 1; rest > 0 && k <= order(); ++k) {
      errors += coefficients()[static_cast<std::size_t>(k - 1)] * y.segment(start - k, rest);
    }
    squares += errors.squaredNorm();
    samples += static_cast<double>(y.size());
  }
  return samples * std::log(squares / samples) - 2 * log_scales;
}

}  // namespace steerid
