// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/varying_arm.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "fit/instrumental_fit.hpp"
#include "fit/instrumented_rows.hpp"
#include "fit/random_walk.hpp"

namespace steerid {
namespace {

constexpr int kRounds = 4;
constexpr double kMemoryS = 20;
constexpr double kDiffuse = 1e4;  // times the square of the constant arm's value: nothing is known
/// What a share of its value a number wanders within a second.
constexpr std::array<double, 12> kRates = {0, 0.003, 0.006, 0.012, 0.025, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8};

using Path = std::vector<Eigen::Vector4d>;

struct Rates {
  double damping = 0;
  double stiffness = 0;
};

RandomWalk walk_of(const Eigen::Vector4d& usual, const Rates& rates, double variance) {
  RandomWalk walk{.start = usual, .start_variance = kDiffuse * usual.cwiseAbs2() / variance};
  walk.start_variance[3] = kDiffuse / variance;  // of 1 Nm
  walk.variance_per_s[1] = std::pow(rates.damping * usual[1], 2) / variance;
  walk.variance_per_s[2] = std::pow(rates.stiffness * usual[2], 2) / variance;
  return walk;
}

/// y - (phi - z)' p.
Eigen::VectorXd by_instrument(const InstrumentedRows::White& white, const Path& path) {
  Eigen::VectorXd y = white.torque;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    y[k] -= (white.motion.row(k) - white.instrument.row(k)).dot(path[static_cast<std::size_t>(k)]);
  }
  return y;
}

struct Likeliest {
  Rates rates;
  double log_likelihood = 0;
  double staying = 0;  // of an arm that stays
};

Likeliest likeliest(const Eigen::VectorXd& y, const InstrumentedRows& rows, const InstrumentedRows::White& white,
                    const Eigen::Vector4d& usual, double variance) {
  const auto likelihood = [&](const Rates& rates) {
    return log_likelihood(y, white.instrument, rows.time_s(), walk_of(usual, rates, variance));
  };
  Likeliest best;
  best.log_likelihood = best.staying = likelihood({});
  for (const double damping : kRates) {
    for (const double stiffness : kRates) {
      const double here = likelihood({damping, stiffness});
      if (here > best.log_likelihood) best = {{damping, stiffness}, here, best.staying};
    }
  }
  return best;
}

}  // namespace

VaryingArm fit_varying_arm(const Record& record) {
  VaryingArm out;
  const InstrumentedRows rows(record);
  if (!rows.by_probe() && !voluntary_torque_known(record.equation())) return out;
  const InstrumentalFit fit = fit_by_instrument(rows);
  const Eigen::Vector4d usual(fit.inertia.value, fit.damping.value, fit.stiffness.value, fit.constant_nm);
  if (fit.rows == 0 || !(usual.head<3>().minCoeff() > 0)) return out;

  Path path(static_cast<std::size_t>(rows.size()), usual);
  double variance = fit.noise_nm * fit.noise_nm;
  Autoregression noise = fit.noise;
  for (int round = 0; round < kRounds; ++round) {
    const InstrumentedRows::White white = rows.whitened(noise, kMemoryS);
    const Eigen::VectorXd y = by_instrument(white, path);
    const Likeliest best = likeliest(y, rows, white, usual, variance);
    if (round == 0) {  // the arm that stays is its own reference: the two are compared on equal terms
      out.compared = true;
      out.likelihood_ratio = 2 * (best.log_likelihood - best.staying);
      out.changes = out.likelihood_ratio > VaryingArm::kSurelyChanges;
      if (!out.changes) return out;
    }
    const SmoothedWalk smoothed = smooth_walk(y, white.instrument, rows.time_s(), walk_of(usual, best.rates, variance));
    path = smoothed.value;
    variance = smoothed.variance;
    noise = Autoregression::fit(rows.unexplained(path), InstrumentalFit::kLongestNoise);
    out.damping_per_root_s = best.rates.damping * usual[1];
    out.stiffness_per_root_s = best.rates.stiffness * usual[2];
    out.damping.clear(), out.damping_sd.clear(), out.stiffness.clear(), out.stiffness_sd.clear();
    for (std::size_t k = 0; k < path.size(); ++k) {
      out.damping.push_back(path[k][1]);
      out.damping_sd.push_back(smoothed.sd[k][1]);
      out.stiffness.push_back(path[k][2]);
      out.stiffness_sd.push_back(smoothed.sd[k][2]);
    }
  }
  out.time_s = rows.time_s();
  return out;
}

}  // namespace steerid
