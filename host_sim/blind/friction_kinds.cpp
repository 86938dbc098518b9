// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction as bristles: a spring that follows the wheel until it slips, and hysteresis over a visible angle.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

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

/// The same curve of first loading from many springs, each with a slider: small loops within large ones close.
class ManySprings final : public Element {
 public:
  ManySprings(const Numbers& n, const Setting&) : friction_nm_(n["friction_nm"]) {
    // The curve through as many points as there are springs, at equal steps of z; s = int dz/(1 - z^n).
    constexpr int kSprings = 60;
    constexpr int kPieces = 20;  // of an integral
    constexpr double kHighest = 0.998;
    std::vector<double> slope;
    double at = 0;
    for (int k = 1; k <= kSprings; ++k) {
      const double before = at;
      for (int i = 0; i < kPieces; ++i) {
        const double z = kHighest * (k - 1 + (i + 0.5) / kPieces) / kSprings;
        at += kHighest / kSprings / kPieces / (1 - std::pow(z, n["sharpness"]));
      }
      slope.push_back(kHighest / kSprings / (at - before));
      springs_.push_back({.slips_at_rad = at * n["presliding_rad"]});
    }
    for (std::size_t k = 0; k < springs_.size(); ++k) {
      const double stiffer = slope[k] - (k + 1 < slope.size() ? slope[k + 1] : 0);
      springs_[k].stiffness_per_rad = stiffer / n["presliding_rad"];
    }
  }

  void start(const Instant& now, std::span<double>) override { angle_rad_ = now.angle_rad; }
  void act(const Instant& now, std::span<const double>, std::span<double>, Balance& balance) const override {
    double z = 0;
    for (const Spring& spring : springs_) z += spring.stiffness_per_rad * bend(spring, now);
    balance.torque_nm -= friction_nm_ * z;
  }
  [[nodiscard]] double guard(const Instant& now, std::span<const double>) const override {
    return direction_ * now.rate_rad_s;
  }
  void cross(const Instant& now, std::span<double>) override {
    direction_ = -direction_;
    for (Spring& spring : springs_) spring.bend_rad = bend(spring, now);
    angle_rad_ = now.angle_rad;
  }

 private:
  struct Spring {
    double slips_at_rad = 0;
    double stiffness_per_rad = 0;  ///< of z
    double bend_rad = 0;           ///< where the wheel turned last
  };
  [[nodiscard]] double bend(const Spring& spring, const Instant& now) const {
    return std::clamp(spring.bend_rad + now.angle_rad - angle_rad_, -spring.slips_at_rad, spring.slips_at_rad);
  }

  double friction_nm_;
  std::vector<Spring> springs_;
  double angle_rad_ = 0;
  int direction_ = 1;
};

std::unique_ptr<Element> make_hysteresis(const Numbers& numbers, const Setting& setting) {
  if (numbers["loop_shape"] > 0) return std::make_unique<ManySprings>(numbers, setting);
  return std::make_unique<Hysteresis>(numbers, setting);
}

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
                          {"sharpness", d.chance(0.5) ? 1.0 : d.between(1.0, 2.0)},
                          {"loop_shape", d.chance(0.4) ? 1.0 : 0.0}};
         },
         make_hysteresis},
};

}  // namespace

std::span<const Kind> friction_kinds() { return kKinds; }

}  // namespace steerid::blind
