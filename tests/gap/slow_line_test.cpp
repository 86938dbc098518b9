// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What passes for a slow torque on drawn drives (gap/drawn_drive.hpp): courses below 1 Hz, and tones.
#include "gap/likelihood/slow_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "gap/drawn_drive.hpp"
#include "gap/model/spectral_model.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// Of the linear wheel on a drive with the torque.
double share_with(const std::function<double(double)>& torque_nm, std::uint64_t seed) {
  test::DrawnDrive what;
  what.torque = [&](double t, double, double) { return torque_nm(t); };
  const Record record = test::drive(what, seed);
  const SpectralRecord spectral(record, what.wheel, held_out_split(record, 100), 100, false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel, 100), spectral.applied_rms_nm);
  SpectralModel model(spectral, {});
  const Eigen::Vector3d wheel(what.wheel.inertia_kgm2, what.wheel.damping_nms_per_rad, what.wheel.stiffness_nm_per_rad);
  const auto fitted = fitted_parameters(what.wheel, what.wheel, {});
  return slow_line_share(whittle, model, whittle.fit(model, wheel, fitted, kSeen, SlowTorque::kCause, 100));
}

TEST(SlowLine, ASinusoidHasNearlyAllOfIt) {
  const std::uint64_t seed = test::seed(71);
  for (const double f_hz : {0.7, 1.0, 1.25}) {
    const double share = share_with([=](double t) { return 0.2 * std::sin(2 * std::numbers::pi * f_hz * t); }, seed);
    EXPECT_GT(share, 0.78) << f_hz << " Hz";
    EXPECT_LE(share, 1) << f_hz << " Hz";
  }
}

TEST(SlowLine, ACourseHasItSpread) {
  const std::uint64_t seed = test::seed(72);
  for (int draw = 0; draw < 5; ++draw) {
    // As many sines as there are lines below 0.9 Hz in a minute, of random phase: a torque of even density.
    test::Noise noise(seed + static_cast<std::uint64_t>(draw));
    std::vector<double> phase;
    for (int k = 0; k < 54; ++k) phase.push_back(2 * std::numbers::pi * noise.uniform());
    const auto course = [&](double t) {
      double sum = 0;
      for (std::size_t k = 0; k < phase.size(); ++k) {
        sum += std::cos(2 * std::numbers::pi * static_cast<double>(k + 1) / 60 * t + phase[k]);
      }
      return 0.2 * std::sqrt(2.0 / static_cast<double>(phase.size())) * sum;
    };
    const double share = share_with(course, seed + static_cast<std::uint64_t>(draw));
    EXPECT_LT(share, 0.72) << draw;
    EXPECT_GT(share, 0.2) << draw;  // three lines of fewer than fifteen
  }
}

TEST(SlowLine, WhereThereIsHardlyASlowTorqueNothingIsSaid) {
  EXPECT_EQ(share_with([](double) { return 0.0; }, test::seed(73)), 0);
}

}  // namespace
}  // namespace steerid
