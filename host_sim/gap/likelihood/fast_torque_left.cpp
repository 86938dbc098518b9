// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/fast_torque_left.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "gap/hypotheses/slow_share.hpp"
#include "gap/likelihood/torque_lines.hpp"

namespace steerid::gap {
namespace {

/// The power of every line that its neighbours do not predict from the drive: what is left of `clean` where a response
/// that hardly changes over them is taken off, by the floor's density, unbiased for noise.
Eigen::VectorXd beside_the_drive(const BlockSpectra& spectra, const Whittle::Roles& roles,
                                 const Eigen::VectorXd& density, const Spectrum& clean, const Spectrum& driven) {
  constexpr Eigen::Index kNeighbours = 4;  // to each side
  Eigen::VectorXd power = clean.cwiseAbs2();
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    if (!is_among(roles, bins.block.role)) continue;
    const Eigen::Index end = bins.first + bins.count;
    for (Eigen::Index k = bins.first + 1; k < end; ++k) {
      std::complex<double> along = 0;
      double weight = 0;
      for (Eigen::Index j = std::max(bins.first + 1, k - kNeighbours); j < std::min(end, k + kNeighbours + 1); ++j) {
        if (j == k) continue;
        along += std::conj(driven[j]) * clean[j] / density[j];
        weight += std::norm(driven[j]) / density[j];
      }
      if (!(weight > 0)) continue;
      power[k] = std::norm(clean[k] - along / weight * driven[k]) / (1 + std::norm(driven[k]) / (density[k] * weight));
    }
  }
  return power;
}

/// Both on the same lines: minus log likelihood beside the slow torque of the floor.
struct Reading {
  const TorqueLines& lines;
  const NoiseFloor& floor;

  [[nodiscard]] double cost(const FastTorque& fast) const {
    NoiseFloor with = floor;
    with.fast = fast;
    return lines.cost(with.unmeasured_density(lines.f_hz));
  }
};

struct Candidate {
  FastTorque torque;
  double price;  ///< minus log of the prior, up to a constant
};

/// The likeliest of the candidates, where the record speaks strongly for them and against `without`.
FastTorque likelier(const Reading& reading, const FastTorque& without, const std::vector<Candidate>& candidates) {
  FastTorque best = without;
  double most = -std::numeric_limits<double>::infinity();
  double sum = 0;  // over that of the likeliest
  double prior = 0;
  for (const Candidate& one : candidates) {
    const double own = -reading.cost(one.torque) - one.price;
    if (own > most) {
      sum *= std::exp(most - own);
      most = own;
      best = one.torque;
    }
    sum += std::exp(own - most);
    prior += std::exp(-one.price);
  }
  const double log_odds = most + std::log(sum / prior) + reading.cost(without);
  return log_odds > kStrong_nats ? best : without;
}

/// `fast` with a tail or without, its size as likely before as that of a slow torque.
FastTorque with_tail(const Reading& reading, double applied_rms_nm, SlowTorque slow, FastTorque fast) {
  constexpr std::array kCorners_hz = {0.3, 0.4, 0.5, 0.6};
  constexpr double kMuscle_hz = 3;  // the low pass between a muscle's nerve and its force
  std::vector<Candidate> candidates;
  for (double share = kSmallestSlowShare; share < kLargestSlowShare; share *= kSlowShareStep) {
    fast.tail_variance = std::pow(share * applied_rms_nm, 2);
    for (const double corner_hz : kCorners_hz) {
      fast.tail_corner_hz = corner_hz;
      for (const double second_hz : {corner_hz, kMuscle_hz}) {
        fast.tail_second_hz = second_hz;
        candidates.push_back({fast, slow_penalty(share, slow)});
      }
    }
  }
  fast.tail_variance = 0;
  return likelier(reading, fast, candidates);
}

/// `fast` with a tremor or without, its rms half-normal.
FastTorque with_tremor(const Reading& reading, FastTorque fast) {
  constexpr std::array kTremors_hz = {6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0};
  constexpr std::array kDampings = {0.03, 0.1, 0.3};
  constexpr double kUsualTremor_nm = 0.03;
  constexpr double kStep = 0.1;  // of that
  constexpr int kSizes = 30;
  std::vector<Candidate> candidates;
  for (int size = 1; size <= kSizes; ++size) {
    const double deviations = kStep * size;
    fast.tremor_variance = std::pow(deviations * kUsualTremor_nm, 2);
    for (const double hz : kTremors_hz) {
      fast.tremor_hz = hz;
      for (const double damping : kDampings) {
        fast.tremor_damping = damping;
        candidates.push_back({fast, deviations * deviations / 2});
      }
    }
  }
  fast.tremor_variance = 0;
  return likelier(reading, fast, candidates);
}

}  // namespace

FastTorque fast_torque_left(const Whittle& whittle, const Spectrum& drive, const Whittle::Fit& fit, SlowTorque slow,
                            const Whittle::Roles& roles) {
  FastTorque out;
  NoiseFloor floor = fit.floor;
  if (floor.lowest_hz > 0) return out;
  const BlockSpectra& spectra = whittle.spectra();
  // The blocks' ends are taken out by what the noise is, and take much of a torque with them that is not known yet;
  // slow torque, its tail and a tremor are read beside each other.
  constexpr int kTimes = 4;
  for (int time = 0; time < kTimes; ++time) {
    floor.fast = out;
    whittle.fit_slow(fit.residual, fit.response, roles, slow, floor);
    const Whittle::Whitened whitened(spectra, fit.response, floor, roles);
    const Eigen::VectorXd power = beside_the_drive(
        spectra, roles, floor.density(spectra, fit.response.gain.cwiseAbs2()), whitened.without_ends(fit.residual),
        whitened.without_ends(fit.response.gain_of_recorded().cwiseProduct(drive)));
    floor.fast = {};
    const TorqueLines lines(spectra, roles, floor, fit.response, power,
                            whitened.known(spectra, 2 * std::numbers::pi * kHighest_hz), kHighest_hz);
    const Reading reading{lines, floor};
    out = with_tail(reading, whittle.applied_rms_nm(), slow, out);
    out = with_tremor(reading, out);
  }
  return out;
}

}  // namespace steerid::gap
