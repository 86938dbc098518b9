// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A driver's own torque above 1 Hz: read off what a set of changes leaves, and noise of an exact simulation.
#include "gap/likelihood/fast_torque.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "gap/compared_drive.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/likelihood/fast_torque_left.hpp"
#include "gap/model/spectral_model.hpp"
#include "sensors/random.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr double kStep_s = 1e-3;

/// Two equal poles at f0 driven by white noise (exact in discrete time for noise that holds over a step), of that rms.
class BehindTwoPoles {
 public:
  BehindTwoPoles(double corner_hz, double rms_nm, std::uint64_t seed, double duration_s) : random_(seed, 5) {
    const double keep = std::exp(-2 * std::numbers::pi * corner_hz * kStep_s);
    double first = 0;
    double second = 0;
    double squares = 0;
    const auto settle = static_cast<int>(5 / (corner_hz * kStep_s));
    const auto count = static_cast<int>(duration_s / kStep_s);
    for (int i = -settle; i < count; ++i) {
      first = keep * first + (1 - keep) * random_.normal();
      second = keep * second + (1 - keep) * first;
      if (i >= 0) torque_.push_back(second);
    }
    // What this draw has, not what it has on average: a share of the applied torque is told by the record's own.
    for (const double one : torque_) squares += one * one;
    const double scale = rms_nm / std::sqrt(squares / static_cast<double>(torque_.size()));
    for (double& one : torque_) one *= scale;
  }
  [[nodiscard]] double at(double t) const {
    const double place = std::clamp(t / kStep_s, 0.0, static_cast<double>(torque_.size() - 2));
    const auto i = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(i);
    return (1 - part) * torque_[i] + part * torque_[i + 1];
  }

 private:
  Random random_;
  std::vector<double> torque_;
};

/// A sinusoid whose phase and size wander: a tremor by another model than the one it is read by.
class Tremor {
 public:
  Tremor(double hz, double rms_nm, std::uint64_t seed, double duration_s)
      : hz_(hz), rms_nm_(rms_nm), real_(0.5, 1, seed, duration_s), imaginary_(0.5, 1, seed + 1, duration_s) {}
  [[nodiscard]] double at(double t) const {
    const double phase = 2 * std::numbers::pi * hz_ * t;
    return rms_nm_ * (real_.at(t) * std::cos(phase) + imaginary_.at(t) * std::sin(phase));
  }

 private:
  double hz_;
  double rms_nm_;
  BehindTwoPoles real_;
  BehindTwoPoles imaginary_;
};

constexpr double kTail_nm = 0.036;  // 2 % of the applied torque
constexpr double kCorner_hz = 0.45;
constexpr double kTremor_nm = 0.03;
constexpr double kTremor_hz = 8.5;

test::DrawnDrive restless(std::uint64_t seed, double duration_s = 60) {
  test::DrawnDrive what;
  what.duration_s = duration_s;
  what.torque_noise_nm = 0.005;
  what.angle_noise_rad = 1e-4;
  const double whole_s = what.duration_s + 3;
  const auto tail = std::make_shared<BehindTwoPoles>(kCorner_hz, kTail_nm, seed, whole_s);
  const auto tremor = std::make_shared<Tremor>(kTremor_hz, kTremor_nm, seed + 10, whole_s);
  what.torque = [tail, tremor](double t, double, double) { return tail->at(t) + tremor->at(t); };
  return what;
}

/// What the record of a drive leaves at a wheel, where `with` is taken for what drove it.
FastTorque left_by(const test::DrawnDrive& what, std::uint64_t seed, const WheelArm& at, std::uint64_t with) {
  const test::ComparedDrive compared(what, seed);
  const Spectrum drive = with == seed ? compared.spectral.torque : test::ComparedDrive(what, with).spectral.torque;
  SpectralModel model(compared.spectral, {});
  const Eigen::Vector3d x(at.inertia_kgm2, at.damping_nms_per_rad, at.stiffness_nm_per_rad);
  const Whittle::Fit fit = compared.judged(model, x, {}, kSeen);
  return fast_torque_left(compared.whittle, drive, fit, SlowTorque::kFloor, kSeen);
}

/// The integral of a density, 1/Hz.
template <class Density>
double power_of(const Density& density, double top_hz) {
  constexpr double kWidth_hz = 0.01;
  const auto lines = static_cast<Eigen::Index>(top_hz / kWidth_hz);
  const Eigen::ArrayXd f_hz = Eigen::ArrayXd::LinSpaced(lines, kWidth_hz / 2, top_hz - kWidth_hz / 2);
  return Eigen::ArrayXd(density(f_hz)).sum() * kWidth_hz;
}

double rms_nm(const FastTorque& torque) {
  return std::sqrt(power_of([&](const Eigen::ArrayXd& f_hz) { return torque.density(f_hz); }, 12));
}

/// The tail is what a slow torque has beyond one that ends, so that both together have its power; the resonance's power
/// is 1.
TEST(FastTorque, HasThePowerThatItSays) {
  const auto power = [](const auto& density) { return power_of(density, 2000); };
  const FastTorque tail{.tail_variance = 4, .tail_corner_hz = 0.5, .tail_second_hz = 0.5};
  const SlowColour ended{0.5, 2};
  const double whole =
      power([&](const Eigen::ArrayXd& f) { return Eigen::ArrayXd(tail.density(f) + 4 * ended.density(f)); });
  EXPECT_NEAR(whole, 4, 0.004);
  const double rates = power(
      [&](const Eigen::ArrayXd& f) { return Eigen::ArrayXd((2 * std::numbers::pi * f).square() * tail.density(f)); });
  EXPECT_NEAR(tail.rate_variance(), rates, 0.05 * rates);
  const FastTorque tremor{.tremor_variance = 2, .tremor_hz = 9};
  EXPECT_NEAR(power([&](const Eigen::ArrayXd& f) { return tremor.density(f); }), 2, 0.02);
  EXPECT_FALSE(FastTorque{}.any());
}

TEST(FastTorque, IsReadOffWhatTheTrueWheelLeaves) {
  const std::uint64_t seed = test::seed(301);
  const test::DrawnDrive what = restless(seed, 180);
  const FastTorque left = left_by(what, seed, what.wheel, seed);
  // Some 80 lines from 2 to 2.7 Hz: 11 % of their power, and as much again for the poles and the slow torque beside it.
  // Of 12 seeds it was 0.6 to 1.2.
  const auto at_two_hz = [](double variance, double corner_hz, double second_hz) {
    const FastTorque one{.tail_variance = variance, .tail_corner_hz = corner_hz, .tail_second_hz = second_hz};
    return one.density(Eigen::ArrayXd::Constant(1, 2.0))[0];
  };
  const double ratio = at_two_hz(left.tail_variance, left.tail_corner_hz, left.tail_second_hz) /
                       at_two_hz(kTail_nm * kTail_nm, kCorner_hz, kCorner_hz);
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2);
  EXPECT_NEAR(std::sqrt(left.tremor_variance), kTremor_nm, 0.4 * kTremor_nm);
  EXPECT_NEAR(left.tremor_hz, kTremor_hz, 1);
}

TEST(FastTorque, IsNoneWhereTheDriverHasNone) {
  const test::DrawnDrive what;
  int read = 0;
  constexpr std::uint64_t kRecords = 8;
  const std::uint64_t first = test::seed(311);
  for (std::uint64_t seed = first; seed < first + kRecords; ++seed) {
    if (left_by(what, seed, what.wheel, seed).any()) ++read;
  }
  EXPECT_LE(read, 1) << "of " << kRecords;
}

/// What a wheel of another inertia leaves follows the drive, and would pass for a driver's torque where another drive
/// is taken for the record's.
TEST(FastTorque, IsNotWhatAWrongWheelLeaves) {
  const std::uint64_t seed = test::seed(321);
  const test::DrawnDrive what;
  WheelArm wrong = what.wheel;
  wrong.inertia_kgm2 *= 1.1;
  const double by_another_drive = rms_nm(left_by(what, seed, wrong, seed + 1));
  EXPECT_GT(by_another_drive, 0.02);
  EXPECT_LT(rms_nm(left_by(what, seed, wrong, seed)), by_another_drive / 2);
}

TEST(FastTorque, OfARestlessDriverIsNoGapOfAnExactSimulation) {
  const std::uint64_t first = test::seed(331);
  for (const std::uint64_t seed : {first, first + 20}) {
    const test::DrawnDrive what = restless(seed);
    Simulation simulation;
    simulation.wheel = what.wheel;
    const Diagnosis diagnosis = diagnose(test::drive(what, seed), simulation);
    EXPECT_EQ(diagnosis.verdict, "none") << "seed " << seed;
    EXPECT_TRUE(diagnosis.causes.empty());
    EXPECT_TRUE(std::ranges::any_of(
        diagnosis.notes, [](const std::string& note) { return note.find("a tremor of 0.03") != std::string::npos; }));
  }
}

TEST(FastTorque, HidesNoHardeningSpring) {
  const std::uint64_t seed = test::seed(341);
  test::DrawnDrive what = restless(seed);
  const auto own = what.torque;
  what.torque = [own](double t, double x, double v) { return own(t, x, v) - 25 * x * x * x; };
  const Diagnosis diagnosis = diagnose(test::drive(what, seed), test::off_by_five_percent(what.wheel));
  ASSERT_EQ(diagnosis.causes.size(), 1U);
  EXPECT_EQ(diagnosis.verdict, "cubic_stiffness");
  EXPECT_NEAR(diagnosis.causes.front().effect.values[0], 25, 5);
}

}  // namespace
}  // namespace steerid::gap
