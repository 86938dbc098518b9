// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/final_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gap/likelihood/fit_spread.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/compared_parts.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"
#include "sensors/random.hpp"

namespace steerid::gap {
namespace {

constexpr int kDrawn = 8;

/// The effects with the fitted values in place of those that a hypothesis describes.
std::vector<Effect> with_values(std::vector<Effect> effects, const Eigen::VectorXd& x) {
  Eigen::Index at = 3;
  for (Effect& effect : effects) {
    if (hypothesis_of(*effect.type) == nullptr) continue;
    for (double& value : effect.values) value = x[at++];
  }
  return effects;
}

std::vector<FinalFit::Drawn> drawn_from(const Whittle::Fit& fit, const FitSpread& spread,
                                        const std::vector<Fitted>& fitted, const std::vector<Effect>& effects) {
  Random random(1, 19);
  std::vector<FinalFit::Drawn> out;
  for (int draw = 0; draw < kDrawn; ++draw) {
    Eigen::VectorXd normals(fit.x.size());
    for (double& one : normals) one = random.normal();
    Eigen::VectorXd x = fit.x + spread.root * normals;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Fitted& one = fitted[static_cast<std::size_t>(i)];
      x[i] = one.scale > 0 ? std::clamp(x[i], one.low, one.high) : fit.x[i];
    }
    out.push_back({wheel_of(x), with_values(effects, x)});
  }
  return out;
}

FinalFit described(const Whittle::Fit& fit, const FitSpread& spread, const std::vector<Fitted>& fitted,
                   const std::vector<Effect>& effects) {
  FinalFit out;
  out.wheel = wheel_of(fit.x);
  out.floor = fit.floor;
  out.excess = fit.excess(kSeen);
  out.nats = fit.cost(kSeen);
  out.choose_lines = fit.misfit[static_cast<std::size_t>(Block::Role::kChoose)].lines;
  const auto bounded = [&](Eigen::Index i) { return BoundedValue{fit.x[i], spread.low[i], spread.high[i]}; };
  out.inertia_kgm2 = bounded(0);
  out.damping_nms_per_rad = bounded(1);
  out.stiffness_nm_per_rad = bounded(2);
  out.drawn = drawn_from(fit, spread, fitted, effects);
  out.effects = with_values(effects, fit.x);
  Eigen::Index at = 3;
  for (const Effect& effect : out.effects) {
    std::vector<BoundedValue> intervals;
    const bool known = hypothesis_of(*effect.type) != nullptr;
    for (const double value : effect.values) {
      if (known) {
        intervals.push_back(bounded(at));
        ++at;
      } else {
        intervals.push_back({value, value, value});
      }
    }
    out.parameters.push_back(std::move(intervals));
  }
  return out;
}

}  // namespace

FinalFit final_fit(const PreparedRecord& prepared, const SetFitter& fitter, const FittedSet& one) {
  const SpectralModel::Parts parts = one.set.hypotheses();
  const std::vector<Fitted> fitted = fitter.fitted(one.set);
  SimulatedModel run(*prepared.spectral, parts, fitter.setting().fixed, one.course);
  if (one.motion == Motion::kFreeRuns) {
    return described(one.fit, spread_of(*prepared.whittle, run, one.fit, fitted, kSeen), fitted,
                     effects_at(one.fit.x, parts, {}));
  }
  std::optional<SpectralRecord> carried;
  if (one.motion == Motion::kCarried) carried.emplace(carried_record(*prepared.spectral, run, one.fit.x));
  SpectralModel model(carried ? *carried : *prepared.spectral, parts);
  return described(one.fit, spread_of(*prepared.whittle, model, one.fit, fitted, kSeen), fitted,
                   effects_at(one.fit.x, parts, {}));
}

}  // namespace steerid::gap
