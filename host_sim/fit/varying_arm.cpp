// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/varying_arm.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "fit/instrumental_fit.hpp"
#include "fit/instrumented_rows.hpp"
#include "fit/probe_misfit.hpp"
#include "fit/random_walk.hpp"

namespace steerid {
namespace {

constexpr int kRounds = 4;
constexpr double kMemoryS = 20;
constexpr double kDiffuse = 1e4;  // times the square of the constant arm's value: nothing is known
/// What a share of its value a number wanders within a second.
constexpr std::array<double, 12> kRates = {0, 0.003, 0.006, 0.012, 0.025, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8};

/// What is not known cannot be said to change: a probe that drives B or C out of the driver's torque. Where all torque
/// is known, what the arm's change leaves of it is in the deviations themselves.
bool shows_an_arm(const InstrumentalFit& fit) {
  if (fit.rows == 0 || !(fit.inertia.value > 0 && fit.damping.value > 0 && fit.stiffness.value > 0)) return false;
  if (!fit.by_probe) return true;
  const auto known = [](const FittedParameter& number) { return number.state == ParameterState::kValid; };
  return drives(probe_misfit(fit)) && (known(fit.damping) || known(fit.stiffness));
}

using Path = std::vector<Eigen::Vector4d>;

struct Rates {
  double inertia = 0;
  double damping = 0;
  double stiffness = 0;
};

RandomWalk walk_of(const Eigen::Vector4d& usual, const Rates& rates, double variance) {
  RandomWalk walk{.start = usual, .start_variance = kDiffuse * usual.cwiseAbs2() / variance};
  walk.start_variance[3] = kDiffuse / variance;  // of 1 Nm
  walk.variance_per_s[0] = std::pow(rates.inertia * usual[0], 2) / variance;
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

/// `y` is that of an arm that stays.
Alternative asymmetric_stiffness(const InstrumentedRows::White& white, const Eigen::VectorXd& y) {
  constexpr int kNumbers = InstrumentedRows::kUnknowns + 1;
  Eigen::Matrix<double, Eigen::Dynamic, kNumbers> instrument(y.size(), kNumbers);
  Eigen::Matrix<double, Eigen::Dynamic, kNumbers> motion(y.size(), kNumbers);
  instrument << white.instrument, white.square_instrument;
  motion << white.motion, white.square;
  const auto left = [&](const auto& columns) {
    return (y - columns * columns.colPivHouseholderQr().solve(y)).squaredNorm();
  };
  const auto rows = static_cast<double>(y.size());
  const Eigen::Vector<double, kNumbers> found =
      (instrument.transpose() * motion).fullPivLu().solve(instrument.transpose() * white.torque);
  return {.kind = Alternative::Kind::kAsymmetricStiffness,
          .size = found[kNumbers - 1],
          .evidence_nats = rows / 2 * std::log(left(white.instrument) / left(instrument)) - std::log(rows) / 2,
          .value = {found[0], found[1], found[2]}};
}

struct Likeliest {
  Rates rates;
  double log_likelihood = 0;
  double staying = 0;  // of an arm that stays
};

Likeliest likeliest(const Eigen::VectorXd& y, const InstrumentedRows& rows, const InstrumentedRows::White& white,
                    const Eigen::Vector4d& usual, double variance, double surely_inertia) {
  const auto likelihood = [&](const Rates& rates) {
    return log_likelihood(y, white.instrument, rows.time_s(), walk_of(usual, rates, variance));
  };
  Likeliest best;
  best.log_likelihood = best.staying = likelihood({});
  const auto better = [&](const Likeliest& than, const Rates& rates) {
    const double here = likelihood(rates);
    return here > than.log_likelihood ? Likeliest{rates, here, than.staying} : than;
  };
  const auto with_inertia = [&](Likeliest from, double inertia) {
    for (const double damping : kRates) {
      for (const double stiffness : kRates) from = better(from, {inertia, damping, stiffness});
    }
    return from;
  };
  best = with_inertia(best, 0);
  Likeliest beside = best;  // a hand that comes brings its own inertia
  for (const double inertia : kRates) beside = better(beside, {inertia, best.rates.damping, best.rates.stiffness});
  if (2 * (beside.log_likelihood - best.log_likelihood) < surely_inertia) return best;
  return with_inertia(beside, beside.rates.inertia);
}

VaryingArm::Course course_of(const SmoothedWalk& smoothed, Eigen::Index number) {
  VaryingArm::Course course;
  for (const Eigen::Vector4d& value : smoothed.value) course.value.push_back(value[number]);
  for (const Eigen::Vector4d& sd : smoothed.sd) course.sd.push_back(sd[number]);
  return course;
}

}  // namespace

VaryingArm fit_varying_arm(const Record& record) {
  VaryingArm out;
  const InstrumentedRows rows(record);
  if (!rows.by_probe() && !voluntary_torque_known(record.equation())) return out;
  const InstrumentalFit fit = fit_by_instrument(rows);
  const Eigen::Vector4d usual(fit.inertia.value, fit.damping.value, fit.stiffness.value, fit.constant_nm);
  if (!shows_an_arm(fit)) return out;

  const double surely_inertia =
      voluntary_torque_known(record.equation()) ? VaryingArm::kSurelyInertiaKnown : VaryingArm::kSurelyInertia;
  Path path(static_cast<std::size_t>(rows.size()), usual);
  double variance = fit.noise_nm * fit.noise_nm;
  Autoregression noise = fit.noise;
  for (int round = 0; round < kRounds; ++round) {
    const InstrumentedRows::White white = rows.whitened(noise, kMemoryS);
    const Eigen::VectorXd y = by_instrument(white, path);
    const Likeliest best = likeliest(y, rows, white, usual, variance, surely_inertia);
    if (round == 0) {  // the arm that stays is its own reference: the two are compared on equal terms
      out.compared = true;
      out.likelihood_ratio = 2 * (best.log_likelihood - best.staying);
      out.changes = out.likelihood_ratio > VaryingArm::kSurelyChanges;
      if (!out.changes) return out;
      out.stays_otherwise = asymmetric_stiffness(white, y);
    }
    const SmoothedWalk smoothed = smooth_walk(y, white.instrument, rows.time_s(), walk_of(usual, best.rates, variance));
    path = smoothed.value;
    variance = smoothed.variance;
    noise = Autoregression::fit(rows.unexplained(path), InstrumentalFit::kLongestNoise);
    out.inertia_per_root_s = best.rates.inertia * usual[0];
    out.damping_per_root_s = best.rates.damping * usual[1];
    out.stiffness_per_root_s = best.rates.stiffness * usual[2];
    out.inertia = course_of(smoothed, 0);
    out.damping = course_of(smoothed, 1);
    out.stiffness = course_of(smoothed, 2);
  }
  out.time_s = rows.time_s();
  return out;
}

}  // namespace steerid
