// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A slow torque that no sensor sees, added by the driver: coloured, below 1 Hz.
//
// Its course in time is a uniform cubic B-spline, sum c_k b(t/D - k), whose spectrum falls as sinc^4(f D) and is zero
// at 1/D: with D = 1 s nothing is left above 1 Hz. The torque is linear in the coefficients, so a fit of them is a
// linear matter. They are
//   drawn from the seed     one independent number each, a hash of seed and k: any instant at once, for ever
//   or given                as the time course, c_0 belonging to the origin; zero beyond its ends
// A replay without a time course has no such torque: what was not recorded cannot be drawn.
// Signature: residual torque below 1 Hz that nothing in the record explains.
// Source: C. de Boor, A Practical Guide to Splines; the hash is the finaliser of SplitMix64 (Steele et al. 2014).
#include <cmath>
#include <cstdint>
#include <utility>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"rms_nm", 0.4, 0.0, 20.0, 0.02, "root mean square when drawn from the seed"},
    Parameter{"knot_interval_s", 1.0, 0.1, 60.0, 0.5, "distance D of the spline's knots"},
};

std::uint64_t mixed(std::uint64_t word) {
  word = (word ^ (word >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27U)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31U);
}

class UnmeasuredTorque final : public PlantEffect {
 public:
  UnmeasuredTorque(std::span<const double> values, std::span<const double> time_course_nm, const RunSetting& setting)
      : knot_interval_s_(values[1]),
        time_course_nm_(time_course_nm.begin(), time_course_nm.end()),
        drawn_(time_course_nm.empty() && !setting.replay),
        seed_(mixed(setting.seed + 0x9e3779b97f4a7c15ULL)),
        // The mean square of the spline is 151/315 of that of its coefficients; a uniform number on +-1 has 1/3.
        reach_nm_(values[0] * std::sqrt(3.0 * 315.0 / 151.0)) {}

  [[nodiscard]] PlantTraits traits() const override {
    return {.acts = drawn_ || !time_course_nm_.empty(), .in_time_only = true};
  }

  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    double u = now.time_s / knot_interval_s_ - from_knot_;
    if (!(u >= 0 && u < 1)) u = enter(now.time_s / knot_interval_s_);
    balance.torque_nm += piece_[0] + u * (piece_[1] + u * (piece_[2] + u * piece_[3]));
  }

 private:
  /// Takes the spline's polynomial between the knots around `knots`; returns the place in it.
  double enter(double knots) const {
    from_knot_ = std::floor(knots);
    const auto k = static_cast<std::int64_t>(from_knot_);
    const double c0 = coefficient(k - 1);
    const double c1 = coefficient(k);
    const double c2 = coefficient(k + 1);
    const double c3 = coefficient(k + 2);
    piece_ = {(c0 + 4 * c1 + c2) / 6, (c2 - c0) / 2, (c0 - 2 * c1 + c2) / 2, (c3 - c0 + 3 * (c1 - c2)) / 6};
    return knots - from_knot_;
  }

  [[nodiscard]] double coefficient(std::int64_t k) const {
    if (!drawn_)
      return k >= 0 && std::cmp_less(k, time_course_nm_.size()) ? time_course_nm_[static_cast<std::size_t>(k)] : 0;
    const std::uint64_t word = mixed(seed_ + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(k));
    return reach_nm_ * (0x1p-52 * static_cast<double>(word >> 11U) - 1);
  }

  double knot_interval_s_;
  std::vector<double> time_course_nm_;
  bool drawn_;
  std::uint64_t seed_;
  double reach_nm_;
  mutable double from_knot_ = std::numeric_limits<double>::infinity();  // where piece_ begins; it is kept, not changed
  mutable std::array<double, 4> piece_{};                               // of rising powers
};

std::unique_ptr<PlantEffect> make(std::span<const double> values, std::span<const double> time_course_nm,
                                  const RunSetting& setting) {
  return std::make_unique<UnmeasuredTorque>(values, time_course_nm, setting);
}

}  // namespace

constinit const EffectType unmeasured_torque{
    .id = "unmeasured_torque",
    .says = "an unmeasured slow torque of the driver",
    .parameters = kParameters,
    .in_plant = make,
    .takes_time_course = true,
};

}  // namespace steerid::effect
