// Dry friction whose contacts bend before they slip, as every machine's do: what a simulation with friction that turns
// round at once leaves out.
//
//   J th'' + B th' + C th + k z = T,   z' = th' while k |z| < F(th'), else k z = F sgn th';   k = Fs/x
//
// x is the bend at which the larger breakaway torque Fs slips, some tenths of a milliradian: nothing that an angle
// sensor shows by itself, but after every reversal the friction is short of what it will be, which a fit without
// bristles takes for less friction and less inertia (Dahl 1968; Dupont et al., Single state elastoplastic friction
// models, IEEE TAC 47 (2002), with its two thresholds joined). A diagnosis fits it beside the simulation's friction to
// know how far J, B, C and the friction may be off.
//
// The leapfrog with kStep_s and the return map of plasticity for z. Cost: some 5 ms for 100 s.
#pragma once

#include <vector>

#include "gap/spectral_model.hpp"
#include "plant/torque_signal.hpp"

namespace steerid {

/// Coulomb's, Stribeck's and asymmetric friction: the kinds that can have bristles.
[[nodiscard]] bool is_dry(const EffectType& type);

/// The range of x that a fit may try, rad.
inline constexpr Fitted kBend = {2e-5, 5e-3, 2e-4};
inline constexpr double kUsualBend_rad = 3e-4;

class BristleRun {
 public:
  /// A wheel under the record's torques over the stretches, each of which says where it begins.
  BristleRun(const Record& record, std::vector<RunStretch> stretches, TorqueSignal::Between between);

  /// One angle a sample, rad; NaN outside the stretches. `friction` is dry.
  [[nodiscard]] const std::vector<double>& operator()(const WheelArm& wheel, const Effect& friction, double bend_rad);

 private:
  std::vector<double> time_s_;
  std::vector<Cubic> torque_;  // net, one a sample
  std::vector<RunStretch> stretches_;
  std::vector<double> angle_rad_;
};

/// x = J, B, C, the friction's values, and the bend.
class BristleModel final : public ResidualModel {
 public:
  BristleModel(const SpectralRecord& record, const EffectType& friction);
  void evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& response) override;

 private:
  const SpectralRecord& record_;
  const EffectType& type_;
  BristleRun run_;
};

}  // namespace steerid
