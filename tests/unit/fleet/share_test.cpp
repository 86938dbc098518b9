// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The share of records that have a change: against the closed form where every record is sure, and by how often the
// interval holds the truth where none is.
#include "fleet/share.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "support/seed.hpp"

namespace steerid::fleet {
namespace {

/// Mean and quantiles of Beta(a, b), by summing its density over small steps of the logit.
Interval beta(double a, double b) {
  constexpr int kSteps = 200'000;
  constexpr double kReach = 16;
  const auto log_density = [&](double x) {  // of the logit
    return -a * std::log1p(std::exp(-x)) - b * std::log1p(std::exp(x));
  };
  const double best = log_density(std::log(a / b));
  const auto logit = [&](int i) { return kReach * (2.0 * i / kSteps - 1); };
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += std::exp(log_density(logit(i)) - best);
  Interval out{a / (a + b), 0, 0};
  double below = 0;
  for (int i = 0; i < kSteps; ++i) {
    below += std::exp(log_density(logit(i)) - best) / sum;
    const double share = 1 / (1 + std::exp(-logit(i)));
    if (below < 0.025) out.low = share;
    if (below < 0.975) out.high = share;
  }
  return out;
}

Interval of_sure_records(std::size_t with, std::size_t without) {
  Share share;
  for (std::size_t i = 0; i < with + without; ++i) {
    share.add(i < with ? 1 : 0, 0.5);
    share.end_vehicle();
  }
  return share.interval();
}

TEST(Share, OfSureRecordsIsJeffreysPosterior) {
  for (const auto& [with, without] : std::vector<std::pair<std::size_t, std::size_t>>{
           {3, 7}, {1, 99}, {40, 0}, {500, 500}, {200, 99'800}, {50'000, 50'000}}) {
    const Interval found = of_sure_records(with, without);
    const Interval expected = beta(static_cast<double>(with) + 0.5, static_cast<double>(without) + 0.5);
    const double width = expected.high - expected.low;
    EXPECT_NEAR(found.value, expected.value, 0.01 * width) << with << " " << without;
    EXPECT_NEAR(found.low, expected.low, 0.02 * width) << with << " " << without;
    EXPECT_NEAR(found.high, expected.high, 0.02 * width) << with << " " << without;
  }
}

TEST(Share, OfRecordsThatSayNothingIsThePrior) {
  Share share;
  for (int i = 0; i < 500; ++i) {
    share.add(0.04, 0.04);
    if (i % 5 == 4) share.end_vehicle();
  }
  const Interval found = share.interval();
  EXPECT_NEAR(found.value, 0.5, 0.01);
  EXPECT_LT(found.low, 0.0025);  // Beta(1/2, 1/2): sin^2(0.0125 pi) = 0.0015
  EXPECT_GT(found.high, 0.9975);
  EXPECT_NEAR(Share().interval().value, 0.5, 0.01);
}

TEST(Share, DoesNotDependOnThePriorThatARecordWasGiven) {
  const auto of = [](double prior) {
    Share share;
    for (int i = 0; i < 300; ++i) {
      const double odds = (i % 3 == 0 ? 20.0 : 0.2) * prior / (1 - prior);  // the record itself says 20 or 0.2
      share.add(odds / (1 + odds), prior);
      share.end_vehicle();
    }
    return share.interval();
  };
  EXPECT_NEAR(of(0.5).value, of(0.02).value, 1e-9);
  EXPECT_NEAR(of(0.5).low, of(0.02).low, 1e-9);
}

/// What a record makes of a change that it sees with a noise of one: a normal with the mean `seen` or with zero.
double probability(double measured, double seen, double prior) {
  const double odds = std::exp(seen * measured - seen * seen / 2) * prior / (1 - prior);
  return odds / (1 + odds);
}

TEST(Share, IntervalHoldsTheTruthOfDoubtfulRecords) {
  std::mt19937_64 draw(test::seed(1));  // NOLINT(cert-msc51-cpp)
  std::normal_distribution<double> normal;
  constexpr int kFleets = 200;
  constexpr double kTruth = 0.3;
  constexpr double kSeen = 1.5;
  constexpr double kPrior = 0.05;
  int held = 0;
  double sum_of_probabilities = 0;
  for (int fleet = 0; fleet < kFleets; ++fleet) {
    Share share;
    for (int i = 0; i < 400; ++i) {
      const bool has = std::uniform_real_distribution<double>()(draw) < kTruth;
      const double p = probability(normal(draw) + (has ? kSeen : 0), kSeen, kPrior);
      sum_of_probabilities += p;
      share.add(p, kPrior);
      share.end_vehicle();
    }
    const Interval found = share.interval();
    held += found.low <= kTruth && kTruth <= found.high ? 1 : 0;
  }
  // 95 % of 200 fleets with four standard deviations (1.54 %) of chance.
  EXPECT_GT(held, 0.88 * kFleets);
  EXPECT_LT(held, kFleets);
  // The plain mean of the records' probabilities keeps to the prior instead.
  EXPECT_LT(sum_of_probabilities / (400 * kFleets), 0.2);
}

TEST(Share, IntervalKnowsThatRecordsOfAVehicleAreAlike) {
  std::mt19937_64 draw(test::seed(2));  // NOLINT(cert-msc51-cpp)
  constexpr int kFleets = 200;
  constexpr double kTruth = 0.3;  // of the vehicles; each has the change in 95 % or in 5 % of its records
  constexpr double kShare = 0.3 * 0.95 + 0.7 * 0.05;
  std::uniform_real_distribution<double> uniform;
  int held = 0;
  int held_apart = 0;
  for (int fleet = 0; fleet < kFleets; ++fleet) {
    Share share;
    Share apart;
    for (int vehicle = 0; vehicle < 40; ++vehicle) {
      const double often = uniform(draw) < kTruth ? 0.95 : 0.05;
      for (int i = 0; i < 25; ++i) {
        const double p = uniform(draw) < often ? 0.99 : 0.01;
        share.add(p, 0.5);
        apart.add(p, 0.5);
        apart.end_vehicle();
      }
      share.end_vehicle();
    }
    const Interval found = share.interval();
    const Interval found_apart = apart.interval();
    held += found.low <= kShare && kShare <= found.high ? 1 : 0;
    held_apart += found_apart.low <= kShare && kShare <= found_apart.high ? 1 : 0;
  }
  // 95 % of 200 with four standard deviations (1.54 %); two kinds of vehicles are not the model's normal logit.
  EXPECT_GT(held, 0.88 * kFleets);
  EXPECT_LT(held_apart, 0.6 * kFleets);
}

}  // namespace
}  // namespace steerid::fleet
