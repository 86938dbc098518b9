#include "fit/autoregression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

Autoregression Autoregression::fit(std::span<const Eigen::VectorXd> residuals, int max_order) {
  std::vector<Eigen::VectorXd> forward(residuals.begin(), residuals.end());
  std::vector<Eigen::VectorXd> backward = forward;
  double samples = 0;
  double power = 0;
  for (const Eigen::VectorXd& r : residuals) {
    samples += static_cast<double>(r.size());
    power += r.squaredNorm();
  }
  Autoregression model;
  if (!(power > 0)) return model;
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
    const double spare = samples - order - 2;
    if (!(power > 0) || spare <= 0) break;
    const double criterion = samples * std::log(power) + 2 * (order + 1) * samples / spare;
    if (criterion < best_criterion) {
      best_criterion = criterion;
      best = order;
    }
  }
  predictors.resize(static_cast<std::size_t>(best));
  model.predictors_ = std::move(predictors);
  for (int k = 0; k <= best; ++k) {
    model.start_scale_.push_back(
        std::sqrt(powers[static_cast<std::size_t>(best)] / powers[static_cast<std::size_t>(k)]));
  }
  return model;
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

}  // namespace steerid
