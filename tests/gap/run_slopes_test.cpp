// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How a run moves with its numbers, against drives of a route of their own (gap/drawn_drive.hpp): the wheel's equation
// is integrated again with one number moved a little to either side.
#include "gap/model/run_slopes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "gap/drawn_drive.hpp"
#include "gap/model/point.hpp"
#include "gap/model/spectral_model.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// A stiff arm that moves little, so that a drag that takes half of all damping is a large one; and a weak hard spring
/// beside it.
test::DrawnDrive with_numbers(const Eigen::VectorXd& x) {
  test::DrawnDrive drive;
  drive.wheel = {x[0], x[1], x[2]};
  drive.duration_s = 20;
  drive.torque_noise_nm = 0;
  drive.angle_noise_rad = 0;
  drive.torque = [drag = x[3], cubic = x[4]](double, double angle, double rate) {
    return -drag * std::abs(rate) * rate - cubic * angle * angle * angle;
  };
  return drive;
}

class RunSlopesOfADrag : public ::testing::Test {
 protected:
  static Eigen::VectorXd numbers() {
    Eigen::VectorXd x(5);
    x << 0.06, 1.0, 25.0, 8.0, 200.0;
    return x;
  }
  const std::uint64_t seed_ = test::seed(91);
  const Eigen::VectorXd x_ = numbers();
  const WheelArm wheel_{x_[0], x_[1], x_[2]};
  const Record record_ = test::drive(with_numbers(x_), seed_);
  Parts parts_ = hypotheses_of({Effect(effect::quadratic_damping), Effect(effect::cubic_stiffness)});
  const std::vector<Fitted> fitted_ = fitted_parameters(wheel_, parts_);
  const SpectralRecord plain_{record_, wheel_, held_out_split(record_), false};

  /// The record on its own motion: that of a run which is right.
  [[nodiscard]] SpectralRecord on_true_motion() const {
    SpectralRecord record = plain_;
    record.motion = motion_carried_by(record_, record_.angle_rad, plain_.motion);
    return record;
  }
  /// By integrating it all again, a hundredth to either side: half a percent of what it is, by the next one's size.
  [[nodiscard]] Spectrum truth(Eigen::Index number) const {
    const double step = 0.01 * x_[number];
    const auto moved = [&](double by) {
      Eigen::VectorXd x = x_;
      x[number] += by;
      return plain_.spectra.of(test::drive(with_numbers(x), seed_).angle_rad);
    };
    return -(moved(step) - moved(-step)) / (2 * step);  // of what is left, not of what is predicted
  }
};

/// Over all blocks but the first one, in which the drives still differ by what was before they were recorded.
double apart(const SpectralRecord& record, const Spectrum& a, const Spectrum& truth) {
  const Eigen::Index rest = record.spectra.bins() - record.spectra.blocks()[1].first;
  return (a - truth).tail(rest).norm() / truth.tail(rest).norm();
}

TEST_F(RunSlopesOfADrag, AreThoseOfTheIntegratedWheel) {
  const SpectralRecord record = on_true_motion();
  RunSlopes slopes(record, parts_);
  SpectralModel on_motion(record, parts_);
  const std::vector<Spectrum> along = slopes.at(x_, fitted_);
  const std::vector<Spectrum> without_feedback = differences(on_motion, x_, fitted_);
  ASSERT_EQ(along.size(), 5U);
  const std::array<std::string, 5> names = {"J", "B", "C", "drag", "spring"};
  for (Eigen::Index i = 0; i < 5; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Spectrum expected = truth(i);
    // Measured 0.004 to 0.022, J most: Newmark's rule has swings a little too slow.
    EXPECT_LT(apart(record, along[at], expected), 0.03) << names[at];
    EXPECT_GT(apart(record, without_feedback[at], expected), 0.4) << names[at];
  }
}

/// A response that is another one has no torque to feed back: its slopes are those on the measured motion.
TEST_F(RunSlopesOfADrag, OfWhatChangesTheResponseAreThoseOnTheMotion) {
  const Parts parts = hypotheses_of({Effect(effect::lag)});
  Eigen::VectorXd x(4);
  x << x_.head(3), 0.01;
  const std::vector<Fitted> fitted = fitted_parameters(wheel_, parts);
  RunSlopes slopes(plain_, parts);
  SpectralModel model(plain_, parts);
  const std::vector<Spectrum> along = slopes.at(x, fitted);
  const std::vector<Spectrum> expected = differences(model, x, fitted);
  for (std::size_t i = 0; i < along.size(); ++i) EXPECT_EQ(along[i], expected[i]) << i;
}

/// A number that is a choice has no slope.
TEST_F(RunSlopesOfADrag, OfAChoiceAreNone) {
  const Point swings{wheel_, {Effect(effect::time_varying_stiffness)}};
  const Parts parts = hypotheses_of(swings.effects);
  const std::vector<Fitted> fitted = fitted_parameters(wheel_, parts);
  const std::vector<Spectrum> along = RunSlopes(plain_, parts).at(swings.numbers(), fitted);
  int choices = 0;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (fitted[i].scale > 0) continue;
    EXPECT_EQ(along[i].norm(), 0);
    ++choices;
  }
  EXPECT_EQ(choices, 1);
}

}  // namespace
}  // namespace steerid::gap
