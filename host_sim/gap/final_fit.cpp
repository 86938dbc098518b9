#include "gap/final_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/bristles.hpp"
#include "gap/fit_spread.hpp"
#include "gap/hypotheses.hpp"
#include "gap/simulated_model.hpp"
#include "sensors/random.hpp"

namespace steerid {
namespace {

constexpr int kSimulations = 45;
constexpr int kBristleRuns = 60;
constexpr int kDrawn = 8;
constexpr std::uint64_t kDrawSeed = 1;

/// The effects with the fitted values in place of those of the known types.
std::vector<Effect> with_values(std::vector<Effect> effects, const std::vector<const EffectType*>& types,
                                const Eigen::VectorXd& x) {
  Eigen::Index at = 3;
  for (Effect& effect : effects) {
    if (std::ranges::find(types, effect.type) == types.end()) continue;
    for (double& value : effect.values) value = x[at++];
  }
  return effects;
}

/// Intervals that also hold what the fit finds of the same friction with bristles.
FinalFit::Bristled allow_for_bristles(const PreparedRecord& prepared, const EffectType& friction,
                                      const Whittle::Fit& fit, std::vector<Fitted> fitted, SlowTorque slow,
                                      FitSpread& spread) {
  const Eigen::Index count = fit.x.size();
  Eigen::VectorXd start(count + 1);
  start << fit.x, kUsualBend_rad;
  fitted.push_back(kBend);
  BristleModel model(*prepared.spectral, friction);
  const Whittle::Fit with = prepared.whittle->fit(model, start, fitted, kSeen, slow, kBristleRuns);
  const FitSpread own = spread_of(*prepared.whittle, model, with, fitted, kSeen);
  spread.low = spread.low.cwiseMin(own.low.head(count));
  spread.high = spread.high.cwiseMax(own.high.head(count));
  return {wheel_of(with.x), with_values({Effect(friction)}, {&friction}, with.x).front(), with.x[count]};
}

std::vector<FinalFit::Drawn> drawn_from(const Whittle::Fit& fit, const FitSpread& spread,
                                        const std::vector<Fitted>& fitted, const std::vector<Effect>& effects,
                                        const std::vector<const EffectType*>& types) {
  Random random(kDrawSeed, 19);
  std::vector<FinalFit::Drawn> out;
  for (int draw = 0; draw < kDrawn; ++draw) {
    Eigen::VectorXd normals(fit.x.size());
    for (double& one : normals) one = random.normal();
    Eigen::VectorXd x = fit.x + spread.root * normals;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Fitted& one = fitted[static_cast<std::size_t>(i)];
      x[i] = one.scale > 0 ? std::clamp(x[i], one.low, one.high) : fit.x[i];
    }
    out.push_back({wheel_of(x), with_values(effects, types, x)});
  }
  return out;
}

}  // namespace

FinalFit final_fit(const PreparedRecord& prepared, const Simulation& simulation, const Candidate& candidate,
                   const std::vector<Effect>& present, SlowTorque slow) {
  const Hypotheses library = hypotheses();
  std::vector<Effect> effects = simulation.effects;
  effects.insert(effects.end(), present.begin(), present.end());
  const bool adds = candidate.type != nullptr && candidate.id != "unmeasured_torque";
  if (adds) effects.emplace_back(*candidate.type);
  // Record effects of the simulation itself (lost samples and the like) were repaired away.
  SpectralModel::Parts parts;
  std::vector<const EffectType*> types;
  bool motion = false;
  for (const Effect& effect : effects) {
    const auto found = std::ranges::find_if(library, [&](const auto& one) { return &one->type() == effect.type; });
    if (found == library.end()) continue;
    parts.push_back(found->get());
    types.push_back(effect.type);
    motion = motion || (*found)->acts();
  }
  const WheelArm refit = prepared.refit;
  const std::vector<Fitted> fitted = fitted_parameters(simulation.wheel, refit, types);
  FinalFit out;
  Whittle::Fit fit;
  FitSpread spread;
  if (motion && candidate.simulated) {
    SimulatedModel model(*prepared.spectral, types);
    SpectralModel slopes(*prepared.spectral, parts);
    fit = prepared.whittle->fit(model, candidate.fit.x, fitted, kSeen, slow, kSimulations, &slopes);
    spread = spread_of(*prepared.whittle, model, fit, fitted, kSeen);
    if (types.size() == 1 && is_dry(*types.front())) {
      out.bristled = allow_for_bristles(prepared, *types.front(), fit, fitted, slow, spread);
    }
  } else {
    SpectralModel model(*prepared.spectral, parts);
    fit = prepared.whittle->fit(model, candidate.fit.x, fitted, kSeen, slow, 200);
    spread = spread_of(*prepared.whittle, model, fit, fitted, kSeen);
  }
  out.wheel = wheel_of(fit.x);
  out.floor = fit.floor;
  out.excess = fit.excess(kSeen);
  out.nats = fit.cost(kSeen);
  const auto bounded = [&](Eigen::Index i) { return BoundedValue{fit.x[i], spread.low[i], spread.high[i]}; };
  out.inertia_kgm2 = bounded(0);
  out.damping_nms_per_rad = bounded(1);
  out.stiffness_nm_per_rad = bounded(2);
  out.drawn = drawn_from(fit, spread, fitted, effects, types);
  out.effects = with_values(effects, types, fit.x);
  Eigen::Index at = 3;
  for (const Effect& effect : out.effects) {
    std::vector<BoundedValue> intervals;
    const bool known = std::ranges::find(types, effect.type) != types.end();
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

}  // namespace steerid
