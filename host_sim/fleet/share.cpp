// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/share.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace steerid::fleet {
namespace {

constexpr double kNodeStep = 0.5;
constexpr double kFirstNode = -14.0;  // of logit q_v; the last is 14
constexpr double kShareStep = 0.3;
constexpr double kFirstShare = -12.0;  // of logit share; the last is 12
constexpr std::array<double, Share::kSpreads> kSpreadsOfLogit = {0.5, 2.0, 8.0};
constexpr double kMostCertain = 1e-6;
constexpr double kLeast = 1e-35;          // of a vehicle's likelihood, relative to its best node
constexpr std::size_t kNear = 8;          // shares that a point between them is interpolated from
constexpr std::size_t kTogether = 8;      // 1e-35 to the power of 8 is still a double
constexpr std::size_t kFinePoints = 384;  // between two shares: eight to the sd of 100,000 sure records

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

/// Lagrange's polynomial through the shares next to a place between them: the logarithm of a likelihood is a sum of
/// smooth functions of the logit.
struct Interpolation {
  std::size_t first;
  std::array<double, kNear> weight{};

  explicit Interpolation(double at)
      : first(static_cast<std::size_t>(std::clamp(std::floor(at) - static_cast<double>(kNear / 2 - 1), 0.0,
                                                  static_cast<double>(Share::kShares - kNear)))) {
    for (std::size_t k = 0; k < kNear; ++k) {
      weight[k] = 1;
      for (std::size_t j = 0; j < kNear; ++j) {
        if (j == k) continue;
        weight[k] *= (at - static_cast<double>(first + j)) / (static_cast<double>(k) - static_cast<double>(j));
      }
    }
  }

  [[nodiscard]] double of(const double* logs) const {
    double out = 0;
    for (std::size_t k = 0; k < kNear; ++k) out += weight[k] * logs[first + k];
    return out;
  }
};

}  // namespace

struct Share::Grid {
  PerNode q = {};
  std::array<PerShare, kNodes> weight = {};  // of each node, by spread and share

  Grid() {
    for (std::size_t g = 0; g < kNodes; ++g) q[g] = logistic(kFirstNode + kNodeStep * static_cast<double>(g));
    for (std::size_t s = 0; s < kSpreads; ++s) {
      for (std::size_t m = 0; m < kShares; ++m) {
        const PerNode one = weights(kSpreadsOfLogit[s], logistic(kFirstShare + kShareStep * static_cast<double>(m)));
        for (std::size_t g = 0; g < kNodes; ++g) weight[g][s * kShares + m] = one[g];
      }
    }
  }

  /// Of a normal logit whose q has the mean `share` on these nodes; by bisection, since the mean rises with the centre.
  [[nodiscard]] PerNode weights(double spread, double share) const {
    double low = -60;
    double high = 60;
    PerNode out = normal(0, spread);
    for (int i = 0; i < 60; ++i) {
      const double centre = (low + high) / 2;
      out = normal(centre, spread);
      double mean = 0;
      for (std::size_t g = 0; g < kNodes; ++g) mean += out[g] * q[g];
      (mean < share ? low : high) = centre;
    }
    return out;
  }

  static PerNode normal(double centre, double spread) {
    PerNode out{};
    // Beyond the nodes the density's largest value may underflow: it is taken relative to the nearest node.
    const double nearest = std::clamp(centre, kFirstNode, -kFirstNode);
    const double least = std::pow((nearest - centre) / spread, 2);
    double sum = 0;
    for (std::size_t g = 0; g < kNodes; ++g) {
      const double away = (kFirstNode + kNodeStep * static_cast<double>(g) - centre) / spread;
      sum += out[g] = std::exp((least - away * away) / 2);
    }
    for (double& one : out) one /= sum;
    return out;
  }
};

const Share::Grid& Share::grid() {
  static const Grid kGrid;
  return kGrid;
}

Share::Share() {
  vehicle_.fill(1);
  product_.fill(1);
  log_.fill(0);
}

void Share::add(double probability, double prior) {
  const double p = std::clamp(probability, kMostCertain, 1 - kMostCertain);
  const double ratio = p / (1 - p) * (1 - prior) / prior;
  const PerNode& q = grid().q;
  double largest = 0;
  for (std::size_t g = 0; g < kNodes; ++g) {
    vehicle_[g] *= q[g] * ratio + (1 - q[g]);
    largest = std::max(largest, vehicle_[g]);
  }
  for (double& one : vehicle_) one /= largest;
  empty_ = false;
}

void Share::end_vehicle() {
  if (empty_) return;
  const Grid& all = grid();
  PerShare likelihood{};
  for (std::size_t g = 0; g < kNodes; ++g) {
    for (std::size_t i = 0; i < likelihood.size(); ++i) likelihood[i] += all.weight[g][i] * vehicle_[g];
  }
  for (std::size_t i = 0; i < likelihood.size(); ++i) product_[i] *= std::max(likelihood[i], kLeast);
  vehicle_.fill(1);
  empty_ = true;
  if (++held_ == kTogether) take_logarithm();
}

void Share::take_logarithm() {
  for (std::size_t i = 0; i < product_.size(); ++i) log_[i] += std::log(product_[i]);
  product_.fill(1);
  held_ = 0;
}

Interval Share::interval() const {
  Share whole = *this;
  whole.take_logarithm();
  constexpr std::size_t kPoints = (kShares - 1) * kFinePoints + 1;
  std::vector<double> share(kPoints);
  std::vector<std::array<double, kSpreads>> log_posterior(kPoints);
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double at = static_cast<double>(i) / kFinePoints;
    share[i] = logistic(kFirstShare + kShareStep * at);
    const Interpolation between(at);
    for (std::size_t s = 0; s < kSpreads; ++s) {
      // Beta(1/2, 1/2) of the share is this of its logit.
      log_posterior[i][s] = between.of(&whole.log_[s * kShares]) + 0.5 * std::log(share[i] * (1 - share[i]));
      best = std::max(best, log_posterior[i][s]);
    }
  }
  std::vector<double> below(kPoints);  // mass up to the middle of a point's own
  double sum = 0;
  double mean = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    double mass = 0;
    for (const double one : log_posterior[i]) mass += std::exp(one - best);
    below[i] = sum + mass / 2;
    sum += mass;
    mean += mass * share[i];
  }
  const auto quantile = [&](double part) {
    const auto next = static_cast<std::size_t>(std::ranges::lower_bound(below, part * sum) - below.begin());
    if (next == 0) return share.front();
    if (next == kPoints) return share.back();
    const double step = (part * sum - below[next - 1]) / (below[next] - below[next - 1]);
    return share[next - 1] + step * (share[next] - share[next - 1]);
  };
  return {mean / sum, quantile(0.025), quantile(0.975)};
}

}  // namespace steerid::fleet
