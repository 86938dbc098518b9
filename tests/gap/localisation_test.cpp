// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a gap is said to be, of drives that have it at a known place.
#include <gtest/gtest.h>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/drawn_drive.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

Diagnosis diagnosed(const test::DrawnDrive& what, std::uint64_t seed) {
  DiagnoseOptions options;
  options.threads = 1;
  Simulation simulation;
  simulation.wheel = what.wheel;
  return diagnose(test::drive(what, seed), simulation, options);
}

/// The noise's share of the place: what would be there if there were no gap.
double expected_share(const Diagnosis& found) {
  double sum = 0;
  for (const GapAxis& axis : found.axes) {
    if (axis.axis != found.where.axis) continue;
    for (const GapBin& bin : axis.bins) {
      if (bin.low >= found.where.low && bin.high <= found.where.high) sum += bin.expected_share;
    }
  }
  return sum;
}

/// A torque of 0.3 Hz that no sensor sees, all the time.
TEST(Localisation, SaysHowMuchOfTheGapIsSurelyThere) {
  test::DrawnDrive what;
  what.torque = [](double t, double, double) { return 0.6 * std::sin(2 * std::numbers::pi * 0.3 * t); };
  const Diagnosis found = diagnosed(what, test::seed(120));
  EXPECT_EQ(found.where.axis, "frequency");
  EXPECT_LE(found.where.low, 0.3);
  EXPECT_GE(found.where.high, 0.3);
  EXPECT_GT(found.where.share_of_gap.low, expected_share(found));
  EXPECT_NE(found.where.says.find(" to 100 %) of the gap lies between"), std::string::npos) << found.where.says;
}

/// Dry friction beside an offset: a stick here and there holds most of it.
TEST(Localisation, SaysThatItIsNotToldWhereTheGapMayBeAnywhere) {
  test::DrawnDrive what;
  what.duration_s = 30;
  what.dry_friction_nm = 0.4;
  what.torque = [](double, double, double) { return 0.2; };
  const Diagnosis found = diagnosed(what, test::seed(121));
  EXPECT_LE(found.where.share_of_gap.low, expected_share(found));
  EXPECT_TRUE(found.where.says.starts_with("The record does not tell where the gap is; most of it, "))
      << found.where.says;
}

}  // namespace
}  // namespace steerid::gap
