// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What refining takes over of a search, on both sides of every bound that its header states.
#include <gtest/gtest.h>

#include <cmath>

#include "identifier/parameter_sum.hpp"
#include "identifier/search_hand_over.hpp"

namespace steerid {
namespace {

using Vector = Vector3<double>;
const Prior<double> kPrior{};
const Vector kFound(0.12, 2.5, 33);
const Vector kDeviation(0.01, 0.1, 1);
constexpr double kVariance = 0.04;

/// The state of an identifier, as far as it is handed over.
struct Search {
  ParameterSum<double> p{kFound};
  UdCovariance<double> covariance{kDeviation};
  Held held = Held::kNone;

  void hand_over(SearchHandOver<double>& rule, const Vector& share, double left = 0.1, double whole = 1) {
    held = rule.take_over(p, covariance, share, left, whole, kVariance, kPrior);
  }
  /// That the value is the search's or the prior's, and the variance the search's or opened to the prior's.
  void expect(int i, bool found, bool opened) const {
    EXPECT_EQ(p(i), found ? kFound(i) : kPrior.value(i)) << i;
    const double opening = opened ? kPrior.spread(i) * kPrior.spread(i) / kVariance : 0;
    const double variance = kDeviation(i) * kDeviation(i) + opening;
    EXPECT_NEAR(covariance.variance()(i) / variance, 1, 1e-12) << i;
    EXPECT_EQ(holds(held, i), opened) << i;
  }
};

Vector shares(double inertia, double damping, double stiffness) { return {inertia, damping, stiffness}; }

TEST(SearchHandOver, TakesOverWhatWasShown) {
  SearchHandOver<double> rule;
  Search search;
  search.hand_over(rule, Vector::Constant(1 / 81.0));
  for (int i = 0; i < 3; ++i) search.expect(i, true, false);
}

TEST(SearchHandOver, HoldsWhatWasShownLessThanEightyTimesAndKeepsItsValue) {
  SearchHandOver<double> rule;
  Search search;
  search.hand_over(rule, shares(1 / 3.1, 1 / 79.0, 1 / 81.0));
  search.expect(kInertia, true, true);
  search.expect(kDamping, true, true);
  search.expect(kStiffness, true, false);
}

TEST(SearchHandOver, ForgetsWhatWasShownLessThanThreeTimes) {
  SearchHandOver<double> rule;
  Search search;
  search.hand_over(rule, shares(1 / 2.9, 1 / 3.1, 1 / 81.0));
  search.expect(kInertia, false, true);
  search.expect(kDamping, true, true);
  search.expect(kStiffness, true, false);
}

// J is shown by what B and C leave, B by what C leaves.
TEST(SearchHandOver, HoldsAllWhereTheSlowestMotionDidNotShowC) {
  SearchHandOver<double> rule;
  Search search;
  search.hand_over(rule, shares(1 / 81.0, 1 / 81.0, 1 / 2.9));
  for (int i = 0; i < 3; ++i) search.expect(i, false, true);
}

TEST(SearchHandOver, DismissesASearchThatLeavesHalfOfTheTorqueButNeverTwiceRunning) {
  SearchHandOver<double> rule;
  for (const bool dismissed : {true, false, true}) {
    Search search;
    search.hand_over(rule, Vector::Constant(0), 0.51);
    for (int i = 0; i < 3; ++i) search.expect(i, !dismissed, dismissed);
  }
  Search next;
  next.hand_over(rule, Vector::Constant(0), 0.49);
  for (int i = 0; i < 3; ++i) next.expect(i, true, false);
  Search again;
  again.hand_over(rule, Vector::Constant(0), 0.51);
  EXPECT_EQ(again.held, Held::kAll);
  rule.reset();
  Search fresh;
  fresh.hand_over(rule, Vector::Constant(0), 0.51);
  EXPECT_EQ(fresh.held, Held::kAll) << "after a restart there was none before";
}

// Behind filters that suit the arm a search is nearly as good as refining; behind those of the prior it is not.
TEST(SearchHandOver, TrustsASearchForAnotherArmMore) {
  EXPECT_GT(SearchHandOver<double>::variance_factor(true), 1);
  EXPECT_GT(SearchHandOver<double>::variance_factor(false), 10 * SearchHandOver<double>::variance_factor(true));
}

}  // namespace
}  // namespace steerid
