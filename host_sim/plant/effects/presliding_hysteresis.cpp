// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Elastic-plastic hysteresis over a visible angle: the torque F z, |z| <= 1, of either kind:
//   loop_shape 0  one spring that bends, dz/dth = (1 - sgn(th' z) |z|^n)/x
//   loop_shape 1  many springs with sliders in parallel, loaded along the same curve (sliding_springs.hpp)
//
// n = 1 is Dahl's model; larger n make the knee sharper, towards a spring in series with dry friction (Bouc and Wen
// with beta = 1, gamma = 0). x is the angle over which the elastic part would reach F.
// Signature: added stiffness F/x for small movements, friction F for large ones; loops that do not depend on speed. A
// small loop within a large one creeps along with one spring and closes with many.
// What was before a run is unknown: it begins as if the wheel had been turned from zero, where its spring holds it, to
// where it is. Begun at z = 0 there, the torque would be off by up to F until a larger swing wipes that out.
// Source: P. Dahl 1968; Y.-K. Wen, J. Eng. Mech. 102 (1976); W. Iwan, J. Appl. Mech. 33 (1966).
#include <cmath>

#include "plant/effects/sliding_springs.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"friction_nm", 0.8, 0.0, 50.0, 0.05, "torque F of the fully developed loop"},
    Parameter{"presliding_rad", 0.15, 0.005, 2.0, 0.02, "angle x over which it develops"},
    Parameter{"sharpness", 1.0, 0.5, 6.0, 0.5, "exponent n of the knee, 1 is Dahl's", {.mean = 1, .sd = 1}},
    Parameter{"loop_shape", 0, 0, 1, 1, "0 one spring that bends, 1 many with sliders", {}, true},
};

/// A loop fully developed stays so until the wheel turns round.
constexpr double kDeveloped = 0.99;

PlantTraits traits_of(std::span<const double> values) {
  // Unloading starts with twice the elastic stiffness, for a part of the loop only: half will do
  // (tests/unit/plant_convergence_test.cpp). z settles on its limit at a rate of n th'/x.
  return {.turns_at_rest = true,
          .passing_stiffness_nm_per_rad = values[0] / values[1],
          .fastest_per_rad = values[2] / values[1]};
}

class OneSpring final : public PlantEffect {
 public:
  explicit OneSpring(std::span<const double> values)
      : traits_(traits_of(values)),
        friction_nm_(values[0]),
        presliding_rad_(values[1]),
        sharpness_(values[2]),
        fresh_(values[2]) {
    traits_.states = 1;
  }

  [[nodiscard]] PlantTraits traits() const override { return traits_; }
  void start(const Instant& now, double* own) override {
    own[0] = fresh_.at(now.angle_rad / presliding_rad_, now.angle_rad < 0 ? -1 : 1);
  }
  [[nodiscard]] bool engaged(const Instant& now, const double* own) const override {
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
  PlantTraits traits_;
  double friction_nm_;
  double presliding_rad_;
  double sharpness_;
  SlidingSprings fresh_;  // along the same curve where it never turned
};

/// z is a function of the angle until the wheel turns round: no state has to be integrated.
class ManySprings final : public PlantEffect {
 public:
  explicit ManySprings(std::span<const double> values)
      : traits_(traits_of(values)), friction_nm_(values[0]), presliding_rad_(values[1]), fresh_(values[2]) {
    traits_.remembers = true;
  }

  [[nodiscard]] PlantTraits traits() const override { return traits_; }
  void start(const Instant& now, double*) override {
    springs_ = fresh_;
    springs_.go(place(now), now.angle_rad < 0 ? -1 : 1);
  }
  [[nodiscard]] bool engaged(const Instant& now, const double*) const override {
    return now.direction * z_at(now) < kDeveloped;
  }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    balance.torque_nm -= friction_nm_ * z_at(now);
  }
  void remember(const Instant& now) override {
    if (now.direction != 0) springs_.go(place(now), now.direction);
  }

 private:
  [[nodiscard]] double place(const Instant& now) const { return now.angle_rad / presliding_rad_; }
  [[nodiscard]] double z_at(const Instant& now) const {
    return now.direction == 0 ? springs_.here() : springs_.at(place(now), now.direction);
  }

  PlantTraits traits_;
  double friction_nm_;
  double presliding_rad_;
  SlidingSprings fresh_;
  SlidingSprings springs_ = fresh_;
};

std::unique_ptr<PlantEffect> make(std::span<const double> values, std::span<const double> /*time_course_nm*/,
                                  const RunSetting& /*setting*/) {
  if (values[3] > 0) return std::make_unique<ManySprings>(values);
  return std::make_unique<OneSpring>(values);
}

}  // namespace

constinit const EffectType presliding_hysteresis{
    .id = "presliding_hysteresis",
    .says = "elastic-plastic hysteresis over a visible angle",
    .parameters = kParameters,
    .in_plant = make,
};

}  // namespace steerid::effect
