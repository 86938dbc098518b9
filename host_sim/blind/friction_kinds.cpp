// Dry friction as bristles: a spring that follows the wheel until it slips, and hysteresis over a visible angle.
#include <array>
#include <cmath>

#include "blind/dry_friction.hpp"
#include "blind/kind.hpp"

namespace steerid::blind {
namespace {

constexpr double kBristleRad = 4e-4;  // what the bristles bend before they slip; below the angle's resolution

class Coulomb final : public DryFriction {
 public:
  Coulomb(const Numbers& n, const Setting&)
      : DryFriction({.forward_nm = n["friction_nm"], .backward_nm = n["friction_nm"], .bristle_rad = kBristleRad}) {}
};

class Stribeck final : public DryFriction {
 public:
  Stribeck(const Numbers& n, const Setting&)
      : DryFriction({.forward_nm = n["friction_nm"],
                     .backward_nm = n["friction_nm"],
                     .bristle_rad = kBristleRad,
                     .breakaway_ratio = n["breakaway_ratio"],
                     .stribeck_rate_rad_s = n["stribeck_rate_rad_s"]}) {}
};

class Asymmetric final : public DryFriction {
 public:
  Asymmetric(const Numbers& n, const Setting&)
      : DryFriction({.forward_nm = n["friction_forward_nm"],
                     .backward_nm = n["friction_backward_nm"],
                     .bristle_rad = kBristleRad}) {}
};

/// F z, dz/dth = (1 - sgn(th' z) |z|^n)/x: Dahl's for n = 1, sharper knees above. A corner where the rate turns.
class Hysteresis final : public Element {
 public:
  Hysteresis(const Numbers& n, const Setting&)
      : friction_nm_(n["friction_nm"]), presliding_rad_(n["presliding_rad"]), sharpness_(n["sharpness"]) {}

  [[nodiscard]] std::size_t states() const override { return 1; }
  void act(const Instant& now, std::span<const double> own, std::span<double> slope, Balance& balance) const override {
    const double z = own[0];
    const double knee = std::pow(std::abs(z), sharpness_) * (z < 0 ? -direction_ : direction_);
    slope[0] = now.rate_rad_s * (1 - knee) / presliding_rad_;
    balance.torque_nm -= friction_nm_ * z;
  }
  [[nodiscard]] double guard(const Instant& now, std::span<const double>) const override {
    return direction_ * now.rate_rad_s;
  }
  void cross(const Instant&, std::span<double>) override { direction_ = -direction_; }

 private:
  double friction_nm_;
  double presliding_rad_;
  double sharpness_;
  int direction_ = 1;
};

constexpr std::array kFriction = {Size{"friction_nm", 0.01, 2.5}};
constexpr std::array kBoth = {Size{"friction_forward_nm", 0.005, 2.5}, Size{"friction_backward_nm", 0.005, 2.5}};

const std::array kKinds = {
    Kind{"coulomb_friction", kFriction,
         [](Draw& d, const Setting& s) {
           return Numbers{{"friction_nm", d.between(0.05, 0.25) * s.torque_rms_nm}};
         },
         make_element<Coulomb>},
    Kind{"stribeck_friction", kFriction,
         [](Draw& d, const Setting& s) {
           return Numbers{{"friction_nm", d.between(0.05, 0.25) * s.torque_rms_nm},
                          {"breakaway_ratio", d.between(1.5, 2.4)},
                          {"stribeck_rate_rad_s", d.between(0.2, 0.6) * s.rate_rms_rad_s}};
         },
         make_element<Stribeck>},
    Kind{"asymmetric_friction", kBoth,
         [](Draw& d, const Setting& s) {
           const double larger = d.between(0.08, 0.3) * s.torque_rms_nm;
           const double smaller = d.between(0.2, 0.5) * larger;
           const bool forward = d.chance(0.5);
           return Numbers{{"friction_forward_nm", forward ? larger : smaller},
                          {"friction_backward_nm", forward ? smaller : larger}};
         },
         make_element<Asymmetric>},
    Kind{"presliding_hysteresis", kFriction,
         [](Draw& d, const Setting& s) {
           return Numbers{{"friction_nm", d.between(0.1, 0.4) * s.torque_rms_nm},
                          {"presliding_rad", d.between(0.35, 1.1) * s.angle_rms_rad},
                          {"sharpness", d.chance(0.5) ? 1.0 : d.between(1.0, 2.0)}};
         },
         make_element<Hysteresis>},
};

}  // namespace

std::span<const Kind> friction_kinds() { return kKinds; }

}  // namespace steerid::blind
