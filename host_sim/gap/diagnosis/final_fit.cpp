// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/final_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "gap/likelihood/fit_spread.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/simulated_model.hpp"
#include "sensors/random.hpp"

namespace steerid::gap {
namespace {

constexpr int kDrawn = 8;

std::vector<Point> drawn_from(const Whittle::Fit& fit, const FitSpread& spread, const std::vector<Fitted>& fitted,
                              const Parts& parts) {
  Random random(1, 19);
  std::vector<Point> out;
  for (int draw = 0; draw < kDrawn; ++draw) {
    Eigen::VectorXd normals(fit.x.size());
    for (double& one : normals) one = random.normal();
    Eigen::VectorXd x = fit.x + spread.root * normals;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Fitted& one = fitted[static_cast<std::size_t>(i)];
      x[i] = one.scale > 0 ? std::clamp(x[i], one.low, one.high) : fit.x[i];
    }
    out.push_back(Point::of(x, parts));
  }
  return out;
}

FinalFit described(const Whittle::Fit& fit, const FitSpread& spread, const std::vector<Fitted>& fitted,
                   const Parts& parts) {
  FinalFit out;
  out.at = Point::of(fit.x, parts);
  out.floor = fit.floor;
  out.excess = fit.excess(kSeen);
  out.choose_lines = fit.misfit[static_cast<std::size_t>(Block::Role::kChoose)].lines;
  const auto bounded = [&](Eigen::Index i) { return BoundedValue{fit.x[i], spread.low[i], spread.high[i]}; };
  out.base = {bounded(0), bounded(1), bounded(2)};
  out.drawn = drawn_from(fit, spread, fitted, parts);
  Eigen::Index next = 3;
  for (const Effect& effect : out.at.effects) {
    std::vector<BoundedValue>& intervals = out.parameters.emplace_back();
    for (std::size_t i = 0; i < effect.values.size(); ++i) intervals.push_back(bounded(next++));
  }
  return out;
}

}  // namespace

FinalFit final_fit(const PreparedRecord& prepared, const SetFitter& fitter, const FittedSet& one) {
  const Parts parts = one.set.hypotheses();
  std::vector<Fitted> fitted = fitter.fitted(one);
  for (Eigen::Index i = 0; i < one.told_elsewhere.size(); ++i) {
    if (!(one.told_elsewhere[i] > 0)) continue;
    Fitted& number = fitted[static_cast<std::size_t>(i)];
    number.prior = Prior::normal(one.fit.x[i], one.told_elsewhere[i] / kPriorsLoosened);  // it is no guess
  }
  SimulatedModel run(*prepared.spectral, parts, one.course);
  if (one.motion == Motion::kFreeRuns) {
    return described(one.fit, spread_of(*prepared.whittle, run, one.fit, fitted, kSeen), fitted, parts);
  }
  std::optional<SpectralRecord> carried;
  if (one.motion == Motion::kCarried) carried.emplace(carried_record(*prepared.spectral, run, one.at()));
  SpectralModel model(carried ? *carried : *prepared.spectral, parts);
  return described(one.fit, spread_of(*prepared.whittle, model, one.fit, fitted, kSeen), fitted, parts);
}

}  // namespace steerid::gap
