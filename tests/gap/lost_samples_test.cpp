// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Lost angle samples, put back: held against sines and white noise, whose values between the samples are known.
#include "gap/preparation/lost_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "gap/drawn_drive.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

struct Lossy {
  std::vector<double> whole;
  std::vector<double> held;
  std::vector<char> lost;
};

/// 60 s at 100 Hz of which `share` is lost, the last value repeated.
Lossy lossy(double frequency_hz, double noise, double share, std::uint64_t seed) {
  test::Noise draw(seed);
  Lossy out;
  for (int i = 0; i < 6000; ++i) {
    out.whole.push_back(std::sin(2 * std::numbers::pi * frequency_hz * i / 100) + noise * draw());
    const bool loses = i > 0 && draw.uniform() < share;
    out.lost.push_back(loses ? 1 : 0);
    out.held.push_back(loses ? out.held.back() : out.whole.back());
  }
  return out;
}

/// The amplitude of the rebuilt sine over the true one, by projection on it.
double amplitude(const std::vector<double>& rebuilt, const std::vector<double>& sine) {
  double both = 0;
  double own = 0;
  for (std::size_t i = 0; i < sine.size(); ++i) {
    both += rebuilt[i] * sine[i];
    own += sine[i] * sine[i];
  }
  return both / own;
}

std::vector<double> straight(const Lossy& record) {
  std::vector<double> out = record.held;
  for (std::size_t i = 1, kept = 0; i < out.size(); ++i) {
    if (record.lost[i] != 0) continue;
    for (std::size_t k = kept + 1; k < i; ++k) {
      out[k] = out[kept] + (out[i] - out[kept]) * static_cast<double>(k - kept) / static_cast<double>(i - kept);
    }
    kept = i;
  }
  return out;
}

/// A straight line over a gap of m samples is short of a curve by k (m - k)/2 of its second difference at the k-th of
/// them: over gaps as they come by chance share/(1 - share)^2/2 of it, which for a sine of 5 Hz with three in ten lost
/// is 3.0 %.
TEST(LostSamples, CubicsKeepTheAmplitudeThatStraightLinesCut) {
  const Lossy record = lossy(5, 0, 0.3, test::seed(71));
  EXPECT_NEAR(amplitude(straight(record), record.whole), 1 - 0.030, 0.003);  // a tenth: 1,800 lost samples
  EXPECT_NEAR(amplitude(over_lost_samples(record.held, record.lost), record.whole), 1, 0.003);
}

/// White noise through a rebuilding of the test's own draws, against what the pattern of losses says beforehand.
TEST(LostSamples, NoiseOfARebuiltAngleIsWhatThePatternSays) {
  for (const double share : {0.05, 0.3}) {
    const std::vector<double> bands_hz{1, 3, 6, 11};
    Eigen::VectorXd omega(std::ssize(bands_hz));
    for (std::size_t b = 0; b < bands_hz.size(); ++b) {
      omega[static_cast<Eigen::Index>(b)] = 2 * std::numbers::pi * bands_hz[b];
    }
    Eigen::VectorXd power = Eigen::VectorXd::Zero(omega.size());
    Eigen::VectorXd said = power;
    constexpr int kDraws = 200;  // of a periodogram's line each, so that their mean is good to 1/sqrt(200)
    for (int draw = 0; draw < kDraws; ++draw) {
      const Lossy record = lossy(0, 1, share, test::seed(73) + static_cast<std::uint64_t>(draw));
      const std::vector<double> angle = over_lost_samples(record.held, record.lost);
      said += rebuilt_noise_gain(record.lost, omega, 100) / kDraws;
      for (Eigen::Index b = 0; b < omega.size(); ++b) {
        std::complex<double> sum = 0;
        for (std::size_t i = 0; i < angle.size(); ++i) {
          sum += angle[i] * std::polar(1.0, -omega[b] * static_cast<double>(i) / 100);
        }
        power[b] += std::norm(sum) / static_cast<double>(angle.size()) / kDraws;
      }
    }
    for (Eigen::Index b = 0; b < omega.size(); ++b) {
      EXPECT_NEAR(power[b] / said[b], 1, 4 / std::sqrt(kDraws))
          << share << " at " << bands_hz[static_cast<std::size_t>(b)];
    }
    EXPECT_GT(said.minCoeff(), share < 0.1 ? 1.02 : 1.7);
    EXPECT_LT(said.maxCoeff(), share < 0.1 ? 1.15 : 2.3);
  }
}

TEST(LostSamples, WhatWasKeptStaysAndCubicsAreExactOnCubics) {
  Lossy record = lossy(1, 0, 0.2, test::seed(72));
  const auto cubic = [](std::size_t i) {
    const double t = static_cast<double>(i) / 1000 - 3;
    return 0.3 + t * (0.7 + t * (-0.2 + 0.05 * t));
  };
  for (std::size_t i = 0; i < record.held.size(); ++i) {
    record.held[i] = record.lost[i] != 0 ? record.held[i - 1] : cubic(i);
  }
  const std::vector<double> rebuilt = over_lost_samples(record.held, record.lost);
  for (std::size_t i = 20; i + 20 < rebuilt.size(); ++i) ASSERT_NEAR(rebuilt[i], cubic(i), 1e-12) << i;
}

/// Some 1,000 of the 6,000 samples have four kept neighbours, which overlap: the variance is known to 8 % or so.
TEST(LostSamples, TheNoiseOfWhatWasKeptIsReadOffWhole) {
  const Lossy record = lossy(1, 0.02, 0.3, test::seed(73));
  EXPECT_NEAR(kept_noise_variance(record.held, record.lost), 0.0004, 0.25 * 0.0004);
  EXPECT_EQ(kept_noise_variance(record.held, std::vector<char>(record.held.size(), 1)), 0);
}

}  // namespace
}  // namespace steerid::gap
