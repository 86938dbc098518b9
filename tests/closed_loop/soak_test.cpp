// Millions of updates over excited, quiet, held and faulty stretches, in float, through the task as the port feeds it.
// STEERID_SOAK_UPDATES says how many; 300 thousand without it, 20 million for the full soak.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "app/task.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kTurn = 6.283185307179586;

/// A wheel of the test's own: J th'' + B th' + C th = T in steps of 0.25 ms, T on a straight line over the tick.
struct Wheel {
  double angle = 0;
  double rate = 0;
  void step(double from_nm, double to_nm) {
    for (int i = 0; i < 40; ++i) {
      const double torque = from_nm + (to_nm - from_nm) * (i + 0.5) / 40;
      rate += 0.00025 * (torque - 1.5 * rate - 22.7 * angle) / 0.11;
      angle += 0.00025 * rate;
    }
  }
};

enum class Stretch { kExcited, kQuiet, kHeld, kZero, kFaulty };

class Soak {
 public:
  explicit Soak(std::uint64_t seed) : random_(seed) {}

  Sample next(Stretch stretch) {
    const double t_s = 0.01 * static_cast<double>(tick_);
    const double before = torque_;
    Sample sample;
    sample.stamp_us = tick_++ * kTickPeriodUs;
    switch (stretch) {
      case Stretch::kExcited:
        torque_ = 1.5 * std::sin(kTurn * 0.4 * t_s) + std::sin(kTurn * 1.3 * t_s) + std::sin(kTurn * 3.1 * t_s);
        break;
      case Stretch::kQuiet:
        torque_ = 0;
        break;
      case Stretch::kHeld:
        torque_ = 3;
        break;
      case Stretch::kZero:
        return sample;  // to the bit, as from sensors that are switched off
      case Stretch::kFaulty:
        break;
    }
    wheel_.step(before, torque_);
    sample.angle_urad = integer(wheel_.angle * 1e6 + 700 * normal_(random_));
    sample.torque_driver_mnm = integer(torque_ * 1e3 + 30 * normal_(random_));
    if (stretch == Stretch::kFaulty) spoil(sample);
    return sample;
  }

  bool chance(int one_in) { return random_() % static_cast<unsigned>(one_in) == 0; }

 private:
  static std::int32_t integer(double x) { return static_cast<std::int32_t>(std::lround(x)); }

  void spoil(Sample& sample) {
    const auto anything = static_cast<std::int32_t>(random_());
    switch (random_() % 8) {
      case 0:
        sample.angle_urad = anything;
        break;
      case 1:
        sample.torque_driver_mnm = anything % 50'000;
        break;
      case 2:
        sample.stamp_us = static_cast<std::int64_t>(random_());
        break;
      case 3:
        sample.valid_bits = static_cast<std::uint8_t>(anything);
        break;
      case 4:
        std::swap(sample.angle_urad, sample.torque_driver_mnm);
        break;
      default:
        break;
    }
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Wheel wheel_;
  double torque_ = 0;
  std::int64_t tick_ = 0;
};

std::int64_t updates() {
  const char* given = std::getenv("STEERID_SOAK_UPDATES");
  return given != nullptr ? std::strtoll(given, nullptr, 10) : 300'000;
}

TEST(Soak, StaysSoundAndComesBack) {
  Soak soak(test::seed(60));
  IdentificationTask<float> task;
  constexpr Stretch kOrder[] = {Stretch::kExcited, Stretch::kQuiet, Stretch::kExcited, Stretch::kHeld,
                                Stretch::kFaulty,  Stretch::kZero,  Stretch::kFaulty};
  const std::int64_t total = updates();
  std::int64_t done = 0;
  std::int64_t excited = 0;
  std::int64_t back = 0;
  for (std::size_t turn = 0; done < total; ++turn) {
    const Stretch stretch = kOrder[turn % std::size(kOrder)];
    // 20 s of each; and once in a while half an hour of nothing.
    const int length = stretch == Stretch::kZero && soak.chance(20) ? 180'000 : 2'000;
    for (int k = 0; k < length; ++k, ++done) {
      if (stretch == Stretch::kFaulty && soak.chance(4)) {
        task.idle();
      } else {
        task.take(soak.next(stretch));
      }
      ASSERT_TRUE(task.identifier().sound()) << "after " << done << " updates";
      ASSERT_TRUE(std::isfinite(task.identifier().noise_nm()));
    }
    if (stretch != Stretch::kExcited) continue;
    ++excited;
    const Estimate e = task.estimate();
    if (task.valid() && std::abs(e.stiffness.value_micro / 22.7e6 - 1) < 0.05 &&
        std::abs(e.damping.value_micro / 1.5e6 - 1) < 0.05 && std::abs(e.inertia.value_micro / 0.11e6 - 1) < 0.05) {
      ++back;
    }
  }
  std::printf("%lld updates, right and valid after %lld of %lld excited stretches\n", static_cast<long long>(done),
              static_cast<long long>(back), static_cast<long long>(excited));
  EXPECT_GE(back, excited * 95 / 100);
}

TEST(Soak, HoursOfExactlyNothing) {
  IdentificationTask<float> task;
  Sample sample;
  const std::int64_t ticks = std::getenv("STEERID_SOAK_UPDATES") != nullptr ? 5 * 360'000 : 360'000;
  for (std::int64_t k = 0; k < ticks; ++k) {
    sample.stamp_us = k * kTickPeriodUs;
    task.take(sample);
    ASSERT_TRUE(task.identifier().sound()) << "after " << k << " updates";
    ASSERT_FALSE(task.valid());
  }
  const ParameterEstimate inertia = task.estimate().inertia;
  EXPECT_EQ(inertia.value_micro, 80'000);
  EXPECT_NE(inertia.state, ParameterState::kFault);
}

}  // namespace
}  // namespace steerid
