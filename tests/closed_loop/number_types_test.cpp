// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One hour of mixed driving (excited, quiet, held, switched off, faulty, reset and restored), the same samples through
// the task in double, float and fixed point: how far the estimates part.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>

#include "app/task.hpp"
#include "closed_loop/mixed_drive.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using test::MixedDrive;

double real(float x) { return static_cast<double>(x); }
double real(Fixed x) { return std::ldexp(x.mantissa(), x.exponent()); }

/// How far one parameter parts from the reference while both call it valid.
struct Parting {
  double worst = 0;           ///< relative to the value
  double worst_in_sd = 0;     ///< in standard deviations of the reference
  std::int64_t compared = 0;  ///< ticks
  std::int64_t beyond = 0;    ///< ticks with more than the limit
  std::int64_t other_state = 0;
};

template <class Scalar>
class Other {
 public:
  explicit Other(double limit) : limit_(limit) {}

  template <class Step>
  void step(const Step& step) {
    step(task_);
  }
  /// A reset with what a save a moment before leaves.
  void reset() {
    SavedEstimate saved;
    const bool kept = task_.save(saved) == Status::kOk;
    task_ = IdentificationTask<Scalar>();
    if (kept) {
      EXPECT_EQ(task_.restore(saved), Status::kOk);
    }
  }
  void look(const Other<double>& reference) {
    const Estimate right = reference.task_.estimate();
    const Estimate mine = task_.estimate();
    const auto deviation = reference.task_.identifier().standard_deviation();
    const ParameterState right_states[] = {right.inertia.state, right.damping.state, right.stiffness.state};
    const ParameterState my_states[] = {mine.inertia.state, mine.damping.state, mine.stiffness.state};
    for (int i = 0; i < 3; ++i) {
      Parting& parting = partings[static_cast<std::size_t>(i)];
      const bool valid = right_states[i] == ParameterState::kValid;
      if (valid != (my_states[i] == ParameterState::kValid)) ++parting.other_state;
      if (!valid || my_states[i] != ParameterState::kValid) continue;
      const double value = reference.task_.identifier().value()(i);
      const double off = std::abs(real(task_.identifier().value()(i)) - value);
      ++parting.compared;
      if (off > limit_ * value) ++parting.beyond;
      parting.worst = std::max(parting.worst, off / value);
      parting.worst_in_sd = std::max(parting.worst_in_sd, off / deviation(i));
    }
  }
  void print(const char* title) const {
    for (const Parting& p : partings) {
      std::printf("%s: worst %.1e of the value, %.4f sd; %lld of %lld ticks beyond %.0e; %lld ticks of another state\n",
                  title, p.worst, p.worst_in_sd, static_cast<long long>(p.beyond), static_cast<long long>(p.compared),
                  limit_, static_cast<long long>(p.other_state));
    }
  }

  std::array<Parting, 3> partings;

 private:
  template <class>
  friend class Other;
  double limit_;
  IdentificationTask<Scalar> task_;
};

class NumberTypes : public testing::Test {
 protected:
  template <class Act>
  void all(const Act& act) {
    act(reference_);
    act(floating_);
    act(fixed_);
  }
  /// One hour, 20 s of each stretch in turn; with a reset every ten minutes or without.
  void drive_for_an_hour(std::uint64_t seed, std::span<const Stretch> order, bool resets) {
    MixedDrive drive(seed);
    Fixed::clear_overflow_count();
    for (int k = 0; k < 360'000; ++k) {
      const Stretch stretch = order[static_cast<std::size_t>(k / 2'000) % order.size()];
      if (resets && k % 60'000 == 59'000) all([](auto& other) { other.reset(); });
      if (stretch == Stretch::kFaulty && drive.chance(4)) {
        all([](auto& other) { other.step([](auto& task) { task.idle(); }); });
      } else {
        const Sample sample = drive.next(stretch);
        all([&sample](auto& other) { other.step([&sample](auto& task) { task.take(sample); }); });
      }
      floating_.look(reference_);
      fixed_.look(reference_);
    }
    floating_.print("float");
    fixed_.print("fixed");
    EXPECT_EQ(Fixed::overflow_count(), 0U);
  }

  Other<double> reference_{0};
  Other<float> floating_{1e-5};
  Other<Fixed> fixed_{1e-4};
};

TEST_F(NumberTypes, AgreeInAnHourOfGoodData) {
  constexpr Stretch kOrder[] = {Stretch::kExcited, Stretch::kQuiet, Stretch::kExcited, Stretch::kHeld};
  drive_for_an_hour(test::seed(61), kOrder, false);
  // The steady identifier parts by 1.8e-7 at most over seeds 61 to 80, in fixed point by 2.8e-7, and no state differs.
  // Where the follower answers for a moment its covariances in float are those of 24 bits: of seeds 61 to 64 one tick
  // in 9,000 at most is then beyond the 1e-5 asked of float, by 0.002 deviations at most. The limits are twice and ten
  // times that; a tenth of a deviation is what two runs are held to differ by (study/labelled_drive.hpp).
  for (const auto& partings : {floating_.partings, fixed_.partings}) {
    for (const Parting& p : partings) {
      EXPECT_GT(p.compared, 200'000);
      EXPECT_LE(p.beyond, p.compared / 4'500);
      EXPECT_LE(p.worst_in_sd, 0.02);
      EXPECT_LE(p.other_state, 5);
      EXPECT_GT(p.worst, 1e-9);  // neither is double: a smaller figure means that nothing was compared
    }
  }
}

// In the first second after a restart the estimates go by a few samples and move by percents of the value. Over seeds
// 61 to 80 that parts the steady identifier in float from double by 9.8e-7 at most, fixed point by 8.5e-7. No state
// differs. After a fault the follower may answer for a while, and its covariances in float are those of 24 bits: of
// seeds 62 to 66 one tick in 1,200 is beyond 1e-5 then, by at most 0.018 deviations. Two runs are held to differ from a
// tenth of a deviation on (study/labelled_drive.hpp), and from one tick in 500 on. J and B are shown in two stretches
// of seven, 102,857 of the 360,000 ticks, and are no longer valid where nothing shows them: the least is those
// stretches without 5 s of each.
TEST_F(NumberTypes, AgreeButRightAfterARestartInAnHourWithFaultsAndResets) {
  constexpr Stretch kOrder[] = {Stretch::kExcited, Stretch::kQuiet, Stretch::kExcited, Stretch::kHeld,
                                Stretch::kFaulty,  Stretch::kZero,  Stretch::kFaulty};
  drive_for_an_hour(test::seed(62), kOrder, true);
  for (const Parting& p : fixed_.partings) {
    EXPECT_GT(p.compared, 77'000);
    EXPECT_EQ(p.beyond, 0);
    EXPECT_LE(p.other_state, p.compared / 1'000);
  }
  for (const Parting& p : floating_.partings) {
    EXPECT_LE(p.beyond, p.compared / 500);
    EXPECT_LE(p.worst_in_sd, 0.1);
    EXPECT_GT(p.worst, 1e-9);
    EXPECT_LE(p.other_state, p.compared / 1'000);
  }
}

}  // namespace
}  // namespace steerid
