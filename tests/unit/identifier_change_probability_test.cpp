// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probability of a change against the sum over every course that the two states can have taken.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include "identifier/change_probability.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kChange = 0.03, kReturn = 0.1;
constexpr std::size_t kLooks = 10;

/// By Bayes' rule over all 2^10 courses: no recursion.
double by_enumeration(const std::array<double, kLooks>& evidence) {
  double changed = 0, all = 0;
  for (unsigned course = 0; course < (1U << kLooks); ++course) {
    double probability = 1;
    bool was = false;
    for (std::size_t k = 0; k < kLooks; ++k) {
      const bool is = (course >> k & 1U) != 0;
      const double to_changed = was ? 1 - kReturn : kChange;
      probability *= is ? to_changed * std::exp(evidence[k]) : 1 - to_changed;
      was = is;
    }
    all += probability;
    if (was) changed += probability;
  }
  return changed / all;
}

TEST(ChangeProbability, IsThatOfAllCoursesTogether) {
  std::mt19937_64 random(test::seed(7));
  std::normal_distribution<double> normal(0, 2);
  for (int run = 0; run < 50; ++run) {
    std::array<double, kLooks> evidence{};
    ChangeProbability<double> change;
    for (double& e : evidence) {
      e = std::clamp(normal(random), -6.0, 6.0);
      change.take(e, kChange, kReturn);
    }
    // The exponential is a series, within 0.2 % (base/exponential.hpp) in each of ten looks.
    const double odds = change.changed() / (1 - change.changed());
    const double right = by_enumeration(evidence);
    EXPECT_NEAR(odds / (right / (1 - right)), 1, 0.02);
  }
}

TEST(ChangeProbability, GoesToWhatIsBelievedWithoutDataAndIsDecidedByNoOneLook) {
  ChangeProbability<double> change;
  for (int k = 0; k < 500; ++k) change.take(0.0, kChange, kReturn);
  EXPECT_NEAR(change.changed(), kChange / (kChange + kReturn), 1e-6);
  for (const double evidence : {1e9, -1e9}) {
    ChangeProbability<double> before = change;
    before.take(0.0, kChange, kReturn);
    ChangeProbability<double> after = change;
    after.take(evidence, kChange, kReturn);
    const double factor = after.changed() / (1 - after.changed()) * (1 - before.changed()) / before.changed();
    EXPECT_NEAR(std::log(factor), evidence > 0 ? 6 : -6, 0.02);
  }
  change.reset();
  EXPECT_EQ(change.changed(), 0);
}

}  // namespace
}  // namespace steerid
