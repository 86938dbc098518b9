// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// firmware/identifier/wheel_friction.hpp against a drawn motion.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identifier/wheel_friction.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

// An error d of F leaves a torque d sign(w); least squares on w takes it for a damping. 0.08 F is one deviation. A mean
// over 1e5 draws has a standard error of a third of a percent; three of them.
TEST(WheelFriction, TakesAnErrorOfItsSizeForADamping) {
  constexpr double kFriction_nm = 0.15;
  for (const double rate_rad_s : {0.05, 0.3, 2.0}) {
    std::mt19937_64 random(test::seed(91));
    std::normal_distribution<double> rate(0, rate_rad_s);
    double torque_times_rate = 0, rate_squared = 0;
    constexpr int kDraws = 100'000;
    for (int k = 0; k < kDraws; ++k) {
      const double w = rate(random);
      torque_times_rate += 0.08 * kFriction_nm * std::abs(w);
      rate_squared += w * w;
    }
    const double deviation = std::sqrt(WheelFriction<double>::damping_variance(kFriction_nm, rate_rad_s * rate_rad_s));
    EXPECT_NEAR(deviation, torque_times_rate / rate_squared, 0.01 * deviation) << rate_rad_s;
  }
}

TEST(WheelFriction, ThatIsNotThereCostsNothing) { EXPECT_EQ(WheelFriction<double>::damping_variance(0, 0), 0); }

}  // namespace
}  // namespace steerid
