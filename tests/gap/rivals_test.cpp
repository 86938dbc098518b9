// What speaks for `unknown` where the right effect is not in the library: drives made by a route of their own
// (gap/drawn_drive.hpp), diagnosed with and without it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "gap/diagnosis.hpp"
#include "gap/drawn_drive.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// What no sensor sees: below 0.3 Hz, 2 % of the applied torque.
double unseen_nm(double t) {
  double sum = 0;
  for (int k = 1; k <= 6; ++k) sum += std::cos(0.3 * k * t + k * k);
  return 0.02 * 1.8 * std::sqrt(2.0 / 6) * sum;
}

std::string verdict(const std::function<double(double, double, double)>& torque, std::uint64_t seed,
                    std::vector<std::string> without) {
  test::DrawnDrive what;
  what.duration_s = 80;
  what.torque = torque;
  DiagnoseOptions options;
  options.without = std::move(without);
  options.figures = false;
  return diagnose(test::drive(what, test::seed(seed)), test::off_by_five_percent(what.wheel), options).verdict;
}

/// A torque that creeps by 0.25 Nm beside one that nobody sees. A larger slow torque would hold all of it but the mean,
/// so that only a trend to which the slow torque gives it back can tell.
TEST(Rivals, ATrendIsToldFromASlowTorqueThatHasGrownToHoldIt) {
  const auto creeps = [](double t, double, double) { return 0.1 + 0.003 * t + unseen_nm(t); };
  EXPECT_EQ(verdict(creeps, 66, {}), "torque_drift");
  EXPECT_EQ(verdict(creeps, 66, {"torque_drift"}), "unknown");
}

TEST(Rivals, ATorqueThatStaysIsABiasWithoutTheLibrarysDrift) {
  const auto stays = [](double t, double, double) { return 0.25 + unseen_nm(t); };
  EXPECT_EQ(verdict(stays, 67, {"torque_drift"}), "torque_bias");
}

/// A lag of 30 ms is a delay but for its second order.
TEST(Rivals, WhatACubedFrequencyLeavesBesideADelayIsTold) {
  test::DrawnDrive what;
  what.duration_s = 80;
  what.delay_s = 0.03;
  const auto called = [&](std::vector<std::string> without) {
    DiagnoseOptions options;
    options.without = std::move(without);
    options.figures = false;
    return diagnose(test::drive(what, test::seed(68)), test::off_by_five_percent(what.wheel), options).verdict;
  };
  EXPECT_EQ(called({}), "delay");
  EXPECT_NE(called({"delay"}), "lag");
}

}  // namespace
}  // namespace steerid
