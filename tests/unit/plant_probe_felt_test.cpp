// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the hand feels of a probe: the closed form against a column that is integrated here (steered_column.hpp), whose
// torque on the rim is taken line by line from torsion bar and angle.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "plant/probe_felt.hpp"
#include "support/seed.hpp"
#include "support/steered_column.hpp"

namespace steerid {
namespace {

/// The task's lines for an unknown arm, 1 Nm rms.
struct ThreeLines {
  static constexpr double kHz[3] = {2.0, 2.6, 5.5};
  static constexpr double kAmplitude_nm[3] = {0.8944, 0.8944, 0.6325};
  [[nodiscard]] double asked(double t) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += kAmplitude_nm[i] * std::cos(2 * M_PI * kHz[i] * t);
    return sum;
  }
  [[nodiscard]] double delivered(double t) const { return asked(t); }
  void see(const test::ColumnRow& /*row*/) {}
};

/// That column: bar of 150 Nm/rad and 0.05 Nms/rad, 0.1 kg m2, 0.8 Nms/rad and 15 Nm/rad below it, no assist.
Column its_column() {
  Column column;
  column.wheel_inertia_kgm2 = 0.035;
  column.wheel_damping_nms_per_rad = 0.06;
  column.bar_stiffness_nm_per_rad = 150;
  column.bar_damping_nms_per_rad = 0.05;
  column.column_inertia_kgm2 = 0.1;
  column.column_damping_nms_per_rad = 0.8;
  column.aligning_stiffness_nm_per_rad = 15;
  column.assist_gain = 0;
  return column;
}

/// Complex amplitude of a column's row member at `hz`, over the last 20 s.
std::complex<double> at_line(const std::vector<test::ColumnRow>& rows, double test::ColumnRow::*of, double hz) {
  constexpr std::size_t kRows = 2000;
  std::complex<double> sum = 0;
  for (std::size_t k = rows.size() - kRows; k < rows.size(); ++k)
    sum += rows[k].*of * std::polar(2.0 / kRows, -2 * M_PI * hz * 0.01 * static_cast<double>(k));
  return sum;
}

// Steps of 0.25 ms and the sensors' noise over 2,000 rows leave some 0.5 % of a line.
TEST(ProbeFelt, IsWhatAnIndependentIntegratorMakesOfIt) {
  for (const double stiffness : {8.0, 22.0, 60.0}) {
    const test::SteeredColumn driver{.stiffness_nm_per_rad = stiffness, .friction_nm = 0};
    std::mt19937_64 random(test::seed(15));
    const auto rows = test::drive_with(driver, 40, random, [] { return ThreeLines(); });
    const Column column = its_column();
    const WheelArm arm{driver.inertia_kgm2, driver.damping_nms_per_rad, stiffness};
    for (int i = 0; i < 3; ++i) {
      const double hz = ThreeLines::kHz[i];
      const std::complex<double> s(0, 2 * M_PI * hz);
      // The rim carries what the bar does not take of the wheel: Trim = Tbar + Jw th'' + Bw th'.
      const std::complex<double> rim = at_line(rows, &test::ColumnRow::bar_nm, hz) +
                                       (column.wheel_inertia_kgm2 * s + column.wheel_damping_nms_per_rad) * s *
                                           at_line(rows, &test::ColumnRow::angle_rad, hz);
      const double expected = ThreeLines::kAmplitude_nm[i] * felt_at_rim(column, arm, hz);
      EXPECT_NEAR(std::abs(rim), expected, 0.015 * expected + 0.001) << stiffness << " Nm/rad, " << hz << " Hz";
    }
  }
}

// A stiffer arm takes more of a slow probe; and what a flat one makes is the root mean square of its lines.
TEST(ProbeFelt, AddsLinesUpByTheirSquares) {
  const Column column;
  const WheelArm arm{};
  EXPECT_NEAR(felt_of_flat_probe(column, arm, 2, 1, 1), 2 * felt_at_rim(column, arm, 1), 1e-12);
  const double one = felt_at_rim(column, arm, 1);
  const double other = felt_at_rim(column, arm, 1.1);
  EXPECT_NEAR(felt_of_flat_probe(column, arm, 1, 1, 1.1), std::sqrt((one * one + other * other) / 2), 1e-12);
}

}  // namespace
}  // namespace steerid
