// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A sum of many small corrections, beside the same sum in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "identifier/parameter_sum.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

struct Step {
  Vector3<float> by;
  void apply(Vector3<float>& p) const { p += by; }
};

// A hundred thousand corrections of 3e-6 of the value, a refresh after every 50. Each would lose up to half a unit in
// the last place of the value, 6e-8 of it at most, 0.29 units rms: over so many 90 units, 5e-6 to 1e-5 of the value.
// Kept apart, what is told is rounded once, by half a unit.
TEST(ParameterSum, LosesInFloatWhatItIsToldWithAndNoMore) {
  std::mt19937_64 random(test::seed(81));
  std::uniform_real_distribution<double> either_way(-1, 1);
  const Vector3<float> start(0.11F, 1.5F, 22.7F);
  ParameterSum<float> sum(start);
  Vector3<float> plain = start;
  Vector3<double> exact = start.cast<double>();
  double worst = 0;
  double worst_plain = 0;
  for (int k = 1; k <= 100'000; ++k) {
    Step step{};
    for (int i = 0; i < 3; ++i) {
      // Back towards the start, as an estimator's corrections go.
      const double away = exact(i) / static_cast<double>(start(i)) - 1;
      step.by(i) = static_cast<float>((3e-6 * either_way(random) - 1e-5 * away) * exact(i));
    }
    sum.add(step);
    step.apply(plain);
    exact += step.by.cast<double>();
    if (k % 50 == 0) sum.fold();
    for (int i = 0; i < 3; ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(sum(i)) / exact(i) - 1));
      worst_plain = std::max(worst_plain, std::abs(static_cast<double>(plain(i)) / exact(i) - 1));
    }
  }
  EXPECT_LT(worst, 7e-8);
  EXPECT_GT(worst, 1e-9);
  EXPECT_GT(worst_plain, 2e-6);
}

template <class Scalar>
class ParameterSumOf : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(ParameterSumOf, Numbers, );

TYPED_TEST(ParameterSumOf, ForgetsWhatCameBeforeWhenItIsSet) {
  using Scalar = TypeParam;
  struct Once {
    void apply(Vector3<Scalar>& p) const { p += Vector3<Scalar>(Scalar(0.25), Scalar(0.5), Scalar(1)); }
  };
  ParameterSum<Scalar> sum(Vector3<Scalar>(Scalar(1), Scalar(2), Scalar(3)));
  sum.add(Once());
  EXPECT_EQ(sum.value(), Vector3<Scalar>(Scalar(1.25), Scalar(2.5), Scalar(4)));
  sum.set(1, Scalar(7));
  sum.fold();
  EXPECT_EQ(sum.value(), Vector3<Scalar>(Scalar(1.25), Scalar(7), Scalar(4)));
  sum = Vector3<Scalar>(Scalar(4), Scalar(5), Scalar(6));
  EXPECT_EQ(sum.value(), Vector3<Scalar>(Scalar(4), Scalar(5), Scalar(6)));
}

}  // namespace
}  // namespace steerid
