// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A quantity over a fleet: against sums done by hand, and by how often intervals hold the truth of drawn fleets.
#include "fleet/spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "fleet/sample.hpp"
#include "support/seed.hpp"

namespace steerid::fleet {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 2> kNever = {kNone, kNone};

TEST(Spread, IsTheAnalysisOfVarianceOfABalancedTable) {
  // Three vehicles of three: means 2, 6, 10; squares inside 2, 8, 8, so that within is sqrt(18 / 6); between the means
  // 3 * 32 / 2 = 48, and (48 - 3) / 3 = 15 is the variance between vehicles.
  Spread spread;
  std::size_t vehicle = 0;
  for (const auto& values : {std::vector{1.0, 2.0, 3.0}, {4.0, 6.0, 8.0}, {8.0, 10.0, 12.0}}) {
    for (const double y : values) spread.add(1e6 + y, kNever);  // from an offset that would swamp plain sums of squares
    spread.end_vehicle(vehicle++);
  }
  EXPECT_EQ(spread.records(), 9U);
  EXPECT_EQ(spread.vehicles(), 3U);
  EXPECT_NEAR(spread.mean().value, 1e6 + 6, 1e-6);
  EXPECT_NEAR(spread.within().value, std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(spread.between().value, std::sqrt(15.0), 1e-9);
  EXPECT_TRUE(std::isnan(spread.mean().low));  // of three vehicles nobody knows how sure it is
  EXPECT_FALSE(spread.drift(Spread::kDays).has_value());
}

TEST(Spread, OfVehiclesWithOneRecordHasNoParts) {
  Spread spread;
  for (std::size_t v = 0; v < 10; ++v) {
    spread.add(static_cast<double>(v), kNever);
    spread.end_vehicle(v);
  }
  EXPECT_NEAR(spread.mean().value, 4.5, 1e-12);
  // Ten groups of one: the jackknife is the standard error, sqrt(55/6 / 10), times Student's 2.262 of nine degrees.
  EXPECT_NEAR(spread.mean().high - 4.5, 2.262 * std::sqrt(55.0 / 60.0), 0.01);
  EXPECT_TRUE(std::isnan(spread.between().value));
  EXPECT_TRUE(std::isnan(spread.within().value));
}

TEST(Spread, DriftsWithinVehiclesAndNotBecauseOldOnesDiffer) {
  Spread spread;
  for (std::size_t v = 0; v < 20; ++v) {
    const double bought = 1000.0 * static_cast<double>(v);
    for (int i = 0; i < 3; ++i) spread.add(0.01 * bought + 0.5 * i, {20'000 + bought + 100 * i, kNone});
    spread.end_vehicle(v);
  }
  const auto drift = spread.drift(Spread::kDays);
  ASSERT_TRUE(drift.has_value());
  EXPECT_TRUE(drift->within_vehicles);
  EXPECT_EQ(drift->records, 60U);
  EXPECT_NEAR(drift->slope.value, 0.005, 1e-9);  // and 0.01 across vehicles
  EXPECT_FALSE(spread.drift(Spread::kKilometres).has_value());
}

TEST(Spread, DriftsAcrossVehiclesWhereEachHasOneRecord) {
  Spread spread;
  for (std::size_t v = 0; v < 20; ++v) {
    spread.add(3 + 0.25 * static_cast<double>(v), {kNone, 100.0 * static_cast<double>(v)});
    spread.end_vehicle(v);
  }
  const auto drift = spread.drift(Spread::kKilometres);
  ASSERT_TRUE(drift.has_value());
  EXPECT_FALSE(drift->within_vehicles);
  EXPECT_NEAR(drift->slope.value, 0.0025, 1e-12);
  EXPECT_NEAR(drift->slope.high, 0.0025, 1e-9);
}

TEST(Spread, IntervalsHoldTheTruth) {
  std::mt19937_64 draw(test::seed(3));  // NOLINT(cert-msc51-cpp)
  std::normal_distribution<double> normal;
  constexpr int kFleets = 400;
  constexpr double kSlope = 0.02;
  int mean = 0;
  int between = 0;
  int within = 0;
  int slope = 0;
  for (int fleet = 0; fleet < kFleets; ++fleet) {
    Spread spread;
    for (std::size_t v = 0; v < 80; ++v) {
      const double own = 2 * normal(draw);
      const int records = 1 + static_cast<int>(v % 6);
      for (int i = 0; i < records; ++i) {
        const double days = 30 * normal(draw);
        spread.add(7 + own + kSlope * days + normal(draw), {days, kNone});
      }
      spread.end_vehicle(v);
    }
    const auto holds = [](const Interval& found, double truth) { return found.low <= truth && truth <= found.high; };
    mean += holds(spread.mean(), 7) ? 1 : 0;
    between += holds(spread.between(), 2) ? 1 : 0;
    within += holds(spread.within(), std::sqrt(1 + kSlope * kSlope * 900)) ? 1 : 0;
    slope += holds(spread.drift(Spread::kDays)->slope, kSlope) ? 1 : 0;
  }
  // 95 % of 400 with four standard deviations (1.1 %); the jackknife of a standard deviation is a little short.
  for (const int held : {mean, between, within, slope}) {
    EXPECT_GT(held, 0.89 * kFleets);
    EXPECT_LT(held, 0.995 * kFleets);
  }
}

TEST(Sample, KeepsEachWithEqualProbability) {
  Sample<int> sample(2000);
  for (int i = 0; i < 100'000; ++i) sample.add(i);
  EXPECT_EQ(sample.seen(), 100'000U);
  ASSERT_EQ(sample.kept().size(), 2000U);
  std::vector<double> kept(sample.kept().begin(), sample.kept().end());
  // Of a uniform sample of 2,000 the median is within four times 0.5/sqrt(2000) of the middle.
  EXPECT_NEAR(quantile(kept, 0.5) / 100'000, 0.5, 0.045);
  EXPECT_NEAR(quantile(kept, 0.05) / 100'000, 0.05, 0.02);
}

TEST(Foremost, NamesTheLargestAndOfEqualOnesTheFirst) {
  Foremost<int> foremost(3);
  for (const auto& [key, item] : std::vector<std::pair<double, int>>{{1, 1}, {3, 2}, {3, 3}, {2, 4}, {3, 5}, {9, 6}}) {
    foremost.add(key, item);
  }
  ASSERT_EQ(foremost.items().size(), 3U);
  EXPECT_EQ(foremost.items()[0].second, 6);
  EXPECT_EQ(foremost.items()[1].second, 2);
  EXPECT_EQ(foremost.items()[2].second, 3);
}

TEST(Quantile, LiesBetweenNeighbours) {
  EXPECT_NEAR(quantile({4, 1, 2, 3}, 0.5), 2.5, 1e-12);
  EXPECT_NEAR(quantile({4, 1, 2, 3}, 1), 4, 1e-12);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace steerid::fleet
