// Millions of updates over excited, quiet, held and faulty stretches, in float, through the task as the port feeds it.
// STEERID_SOAK_UPDATES says how many; 300 thousand without it, 20 million for the full soak.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iterator>

#include "app/task.hpp"
#include "closed_loop/mixed_drive.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using test::MixedDrive;
using test::Stretch;

std::int64_t updates() {
  const char* given = std::getenv("STEERID_SOAK_UPDATES");
  return given != nullptr ? std::strtoll(given, nullptr, 10) : 300'000;
}

TEST(Soak, StaysSoundAndComesBack) {
  MixedDrive soak(test::seed(60));
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
