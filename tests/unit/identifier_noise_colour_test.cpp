// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The colour of what no sensor sees, learned from signals whose statistics are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "identifier/noise_colour.hpp"
#include "support/seed.hpp"
#include "support/two_lags.hpp"

namespace steerid {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Share of the power below 0.5 Hz, by a transform of the test's own over the lowest frequencies.
double slow_share(const std::vector<double>& x) {
  const double n = static_cast<double>(x.size());
  double slow = 0;
  double all = 0;
  for (const double v : x) all += v * v / n;
  for (int bin = 1; bin * 100.0 / n <= 0.5; ++bin) {
    double re = 0;
    double im = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      re += x[k] * std::cos(kTurn * bin * static_cast<double>(k) / n);
      im += x[k] * std::sin(kTurn * bin * static_cast<double>(k) / n);
    }
    slow += 2 * (re * re + im * im) / (n * n);
  }
  return slow / all;
}

struct Whitened {
  double depth = 0;
  double mean_depth = 0;
  std::vector<double> residual;
};

/// 120 s of white noise of variance 1 with slow torque of `slow_sd` beside it. What is kept is the last 60 s.
Whitened whiten(double slow_sd, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  NoiseColour<double> colour;
  WhiteningFilter<double> whitening;
  Whitened out;
  test::TwoLags slow_torque(slow_sd);
  for (int k = 0; k < 12000; ++k) {
    const double slow = slow_torque(normal(random));
    const double coloured = slow + normal(random);
    const double residual = whitening.step(coloured, WhiteningShape<double>::of_depth(colour.depth()));
    colour.learn(coloured);
    if (k < 6000) continue;
    out.residual.push_back(residual);
    out.mean_depth += colour.depth() / 6000;
  }
  out.depth = colour.depth();
  return out;
}

// The memory of 15 s holds some 15 independent values behind the low-pass at 0.5 Hz: their mean square scatters by
// sqrt(2/15) = 0.37, and passes 1.75, where the depth begins with 0.2, one time in forty.
TEST(NoiseColour, LeavesWhiteNoiseAlone) {
  double mean = 0;
  for (std::uint64_t run = 0; run < 20; ++run) mean += whiten(0.0, test::seed(100 + run)).mean_depth / 20;
  EXPECT_LT(mean, 0.05);
}

TEST(NoiseColour, TakesSlowTorqueDownToWhatWhiteNoiseWouldHave) {
  double share_after = 0;
  double depth = 0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    const Whitened w = whiten(1.0, test::seed(200 + run));
    depth += w.mean_depth / 20;
    share_after += slow_share(w.residual) / 20;
  }
  // In closed form: the density at rest is R = gain^2 / 1 = 212 times white noise's, of which 30 s take 1.4 times to be
  // safe, and 1 - (1 + 1.4 212)^-1/4 = 0.759. One R from 30 s scatters by some 26 %, the depth by 0.065 (1 - 0.759) =
  // 0.016 and by less over 20 runs of 60 s.
  EXPECT_NEAR(depth, 0.759, 0.05);
  // Half of the power was slow; what is left is within a factor of two of white noise's 1 %.
  EXPECT_GT(share_after, 0.005);
  EXPECT_LT(share_after, 0.02);
}

TEST(NoiseColour, ConcludesNothingFromSilence) {
  NoiseColour<float> colour;
  for (int k = 0; k < 100000; ++k) {
    colour.learn(0.0F);
    ASSERT_EQ(colour.depth(), 0.0F);
  }
}

// 5.5 /s^2 (12 s / t)^2 over the sum of the squares of the motion's angular frequency and of 2 pi 0.3 Hz; 3 s for 12 s
// where another arm of the same driver is searched for. Within the four figures that the corner is given with.
TEST(NoiseColour, IsTheMoreCautiousTheSlowerTheMotion) {
  NoiseColour<double> colour;
  for (const double doubt_s : {12.0, 3.0}) {
    for (int k = 1; k <= 4000; ++k) {
      colour.learn(0.1);
      const double seconds = 0.01 * std::min(k, 3000);
      for (const double w : {0.0, 1.5, 12.0}) {
        const double more = 5.5 * std::pow(doubt_s / seconds, 2) / (w * w + std::pow(kTurn * 0.3, 2));
        ASSERT_NEAR(colour.caution(w * w), k < 100 ? 1 : 1 + more, 1e-4 * (1 + more)) << k;
      }
    }
    colour.start_anew();
  }
}

}  // namespace
}  // namespace steerid
