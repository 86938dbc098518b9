// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/line_nats.hpp"

#include <algorithm>
#include <cmath>

namespace steerid::gap {

SetLines::SetLines(const FittedSet& one, const Whittle& whittle) {
  const BlockSpectra& spectra = whittle.spectra();
  const Whittle::Fit& fit = one.fit;
  residual = Whittle::Whitened(spectra, fit.response, fit.floor, kSeen).without_ends(fit.residual);
  density = Eigen::ArrayXd::Ones(spectra.bins());
  counted = Eigen::ArrayXd::Zero(spectra.bins());
  const Eigen::VectorXd all = fit.floor.density(spectra, fit.response.gain.cwiseAbs2());
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    if (!is_among(kSeen, bins.block.role)) continue;
    density.segment(bins.first, bins.count) = all.segment(bins.first, bins.count);
    counted.segment(bins.first, bins.count) = 1;
    if (bins.below == 0) counted[bins.first] = 0.5;
  }
}

void SetLines::append(const SetLines& other) {
  const auto put_behind = [](auto& all, const auto& more) {
    const Eigen::Index had = all.size();
    all.conservativeResize(had + more.size());
    all.tail(more.size()) = more;
  };
  put_behind(residual, other.residual);
  put_behind(density, other.density);
  put_behind(counted, other.counted);
}

Eigen::ArrayXd expected_nats(const SetLines& with, const SetLines& without) {
  const Eigen::ArrayXd mean = (with.density + without.density) / 2;
  const Eigen::ArrayXd apart = (with.residual - without.residual).cwiseAbs2().array() / mean;
  return with.counted * (4 * mean.log() - 2 * (with.density * without.density).log() + apart);
}

Eigen::ArrayXd acting_on(const Eigen::ArrayXd& nats) {
  const double square = nats.square().sum();
  if (!(square > 0)) return Eigen::ArrayXd::Zero(nats.size());
  return nats * (nats.sum() / square);
}

double nats_beside(const Eigen::ArrayXd& nats, const Eigen::ArrayXd& all) {
  const Eigen::ArrayXd share = (nats > 0).select(nats / all.max(nats), 0);
  const double shared = (nats * share).sum();
  return shared > 0 ? nats.sum() * nats.sum() / shared : 0;
}

double left_nats_on(const Eigen::ArrayXd& weights, const SetLines& one) {
  const Eigen::ArrayXd above = one.residual.cwiseAbs2().array() / one.density - 1;
  return std::max((weights * one.counted * above).sum(), 0.0) + std::max(weights.matrix().norm(), 1.0) / 2;
}

}  // namespace steerid::gap
