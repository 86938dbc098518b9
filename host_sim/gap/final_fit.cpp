#include "gap/final_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/hypotheses.hpp"
#include "gap/simulated_model.hpp"

namespace steerid {
namespace {

constexpr int kSimulations = 45;
constexpr double kNormal95 = 1.96;

/// Standard deviations from an information matrix; infinite where there is next to none. `inflate`: the variance is
/// larger than the floor's where the model misses something.
Eigen::VectorXd deviations(const Eigen::MatrixXd& information, double inflate) {
  const Eigen::Index n = information.rows();
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = information(i, i) > 0 ? 1 / std::sqrt(information(i, i)) : 0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  const Eigen::VectorXd root = solver.eigenvalues().cwiseMax(1e-12).cwiseInverse();
  const Eigen::MatrixXd covariance = solver.eigenvectors() * root.asDiagonal() * solver.eigenvectors().transpose();
  Eigen::VectorXd out(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    out[i] = scale[i] > 0 ? scale[i] * std::sqrt(inflate * covariance(i, i)) : std::numeric_limits<double>::infinity();
  }
  return out;
}

BoundedValue around(double value, double sd) { return {value, value - kNormal95 * sd, value + kNormal95 * sd}; }

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
  Whittle::Fit fit;
  if (motion && candidate.simulated) {
    SimulatedModel model(*prepared.spectral, types);
    SpectralModel slopes(*prepared.spectral, parts);
    fit = prepared.whittle->fit(model, candidate.fit.x, fitted, kSeen, slow, kSimulations, &slopes);
  } else {
    SpectralModel model(*prepared.spectral, parts);
    fit = prepared.whittle->fit(model, candidate.fit.x, fitted, kSeen, slow, 200);
  }
  FinalFit out;
  out.wheel = wheel_of(fit.x);
  out.floor = fit.floor;
  out.excess = fit.excess(kSeen);
  out.nats = fit.cost(kSeen);
  const Eigen::VectorXd sd = deviations(fit.information, std::max(1.0, out.excess));
  out.inertia_kgm2 = around(fit.x[0], sd[0]);
  out.damping_nms_per_rad = around(fit.x[1], sd[1]);
  out.stiffness_nm_per_rad = around(fit.x[2], sd[2]);
  Eigen::Index at = 3;
  for (Effect& effect : effects) {
    std::vector<BoundedValue> intervals;
    const bool known = std::ranges::find(types, effect.type) != types.end();
    for (double& value : effect.values) {
      if (known) {
        value = fit.x[at];
        intervals.push_back(around(value, sd[at]));
        ++at;
      } else {
        intervals.push_back({value, value, value});
      }
    }
    out.effects.push_back(effect);
    out.parameters.push_back(std::move(intervals));
  }
  return out;
}

}  // namespace steerid
