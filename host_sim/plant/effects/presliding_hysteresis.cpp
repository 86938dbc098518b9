// Elastic-plastic hysteresis over a visible angle: the torque F z with dz/dth = (1 - sgn(th' z) |z|^n)/x, |z| <= 1.
//
// n = 1 is Dahl's model; larger n make the knee sharper, towards a spring in series with dry friction (Bouc and Wen
// with beta = 1, gamma = 0). x is the angle over which the elastic part would reach F.
// Signature: added stiffness F/x for small movements, friction F for large ones; loops that do not depend on speed.
// z is 0 at the start of a run, since the record before it is unknown.
// Source: P. Dahl 1968; Y.-K. Wen, J. Eng. Mech. 102 (1976).
#include <cmath>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"friction_nm", 0.8, 0.0, 50.0, 0.05, "torque F of the fully developed loop"},
    Parameter{"presliding_rad", 0.15, 0.005, 2.0, 0.02, "angle x over which it develops"},
    Parameter{"sharpness", 1.0, 1.0, 6.0, 0.5, "exponent n of the knee, 1 is Dahl's"},
};

class PreslidingHysteresis final : public PlantEffect {
 public:
  explicit PreslidingHysteresis(std::span<const double> values)
      : friction_nm_(values[0]), presliding_rad_(values[1]), sharpness_(values[2]) {}

  [[nodiscard]] PlantTraits traits() const override {
    // Unloading starts with twice the elastic stiffness, for a part of the loop only: half will do
    // (tests/unit/plant_convergence_test.cpp). z settles on its limit at a rate of n th'/x.
    return {.states = 1,
            .turns_at_rest = true,
            .passing_stiffness_nm_per_rad = friction_nm_ / presliding_rad_,
            .fastest_per_rad = sharpness_ / presliding_rad_};
  }
  void start(const Instant&, double* own) override { own[0] = 0; }
  /// A loop fully developed stays so until the wheel turns round.
  [[nodiscard]] bool engaged(const Instant& now, const double* own) const override {
    constexpr double kDeveloped = 0.99;
    return now.direction * own[0] < kDeveloped;
  }

  void act(const Instant& now, const double* own, double* own_rate, Balance& balance) const override {
    const double z = own[0];
    const double developed = sharpness_ == 1 ? std::abs(z) : std::pow(std::abs(z), sharpness_);
    const double towards = z < 0 ? -now.direction : now.direction;
    own_rate[0] = now.rate_rad_s * (1 - towards * developed) / presliding_rad_;
    balance.torque_nm -= friction_nm_ * z;
  }

 private:
  double friction_nm_;
  double presliding_rad_;
  double sharpness_;
};

}  // namespace

constinit const EffectType presliding_hysteresis{
    .id = "presliding_hysteresis",
    .says = "elastic-plastic hysteresis over a visible angle",
    .parameters = kParameters,
    .in_plant = plant_effect<PreslidingHysteresis>,
};

}  // namespace steerid::effect
