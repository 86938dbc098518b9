// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What holds after every update, whatever comes in: D positive, parameters inside their limits, nothing non-finite,
// states legal, published integers in range.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "app/task.hpp"
#include "identifier/identifier.hpp"
#include "support/property.hpp"

namespace steerid {
namespace {

template <class Scalar>
class IdentificationProperty : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(IdentificationProperty, Scalars);

/// Of the steady identifier, or of that of a wheel.
template <template <class> class AnyIdentifier, class Scalar>
void require_sound(const AnyIdentifier<Scalar>& identifier) {
  RC_ASSERT(identifier.sound());
  const Vector3<Scalar> sd = identifier.standard_deviation();
  const Prior<Scalar> prior;
  for (int i = 0; i < 3; ++i) {
    RC_ASSERT(std::isfinite(identifier.value()(i)));
    RC_ASSERT(sd(i) >= Scalar(0) && sd(i) <= prior.spread(i));
    RC_ASSERT(identifier.belief(i) <= Belief::kNotExcited);
  }
  RC_ASSERT(std::isfinite(identifier.noise_nm()));
}

void require_in_range(const Estimate& estimate) {
  const auto check = [](const ParameterEstimate& p, std::int32_t lowest, std::int32_t highest, std::int32_t spread) {
    RC_ASSERT(p.value_micro >= lowest && p.value_micro <= highest);
    RC_ASSERT(p.sd_micro >= 0 && p.sd_micro <= spread);
    RC_ASSERT(static_cast<int>(p.state) <= static_cast<int>(ParameterState::kNotExcited));
  };
  // The prior's limits and spread, in micro-units.
  check(estimate.inertia, 5'000, 600'000, 100'000);
  check(estimate.damping, 10'000, 15'000'000, 2'000'000);
  check(estimate.stiffness, 10'000, 300'000'000, 30'000'000);
}

/// A stretch of input of one kind; the kinds are what a real bus and a hostile one deliver.
struct Stretch {
  int kind = 0;
  int length = 1;
  std::uint32_t chance = 0;
};

rc::Gen<std::vector<Stretch>> any_stretches(int kinds) {
  return rc::gen::container<std::vector<Stretch>>(rc::gen::construct<Stretch>(
      rc::gen::inRange(0, kinds), rc::gen::inRange(1, 400), rc::gen::arbitrary<std::uint32_t>()));
}

/// Cheap chance inside a stretch, from the number that rapidcheck chose.
class Chance {
 public:
  explicit Chance(std::uint32_t seed) : state_(seed) {}
  std::uint32_t bits() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::uint32_t>(state_ >> 32U);
  }
  /// In -1 .. 1.
  double unit() { return static_cast<double>(bits()) / 2147483647.5 - 1; }

 private:
  std::uint64_t state_;
};

template <class Scalar>
struct Input {
  Scalar torque;
  Scalar angle;
};

template <class Scalar>
Input<Scalar> input(const Stretch& stretch, int k, Chance& chance) {
  using Limits = std::numeric_limits<Scalar>;
  const Scalar wild[] = {Limits::quiet_NaN(),  Limits::infinity(), -Limits::infinity(), Limits::max(), Limits::lowest(),
                         Limits::denorm_min(), Scalar(-0.0),       Scalar(1000),        Scalar(-1000)};
  const auto any_wild = [&] { return wild[chance.bits() % 9]; };
  const auto any = [&](double amplitude) { return Scalar(amplitude * chance.unit()); };
  switch (stretch.kind) {
    case 0:
      return {Scalar(0), Scalar(0)};
    case 1:
      return {any(3), any(0.3)};
    case 2: {  // a wheel, more or less
      const double torque = 3 * std::sin(0.05 * k) + 2 * std::sin(0.21 * k);
      return {Scalar(torque), Scalar(torque / 25) + any(0.001)};
    }
    case 3:
      return {any_wild(), any_wild()};
    case 4:
      return {any(1000), any(1000)};
    case 5:
      return {k % 2 == 0 ? Scalar(1000) : Scalar(-1000), k % 2 == 0 ? Scalar(-1000) : Scalar(1000)};
    case 6:
      return {any(1e-30), any(1e-30)};
    default:
      return {Scalar(100), Scalar(stretch.chance % 20)};
  }
}

TYPED_TEST(IdentificationProperty, TheIdentifierStaysSound) {
  test::check_property(50, 200, [] {
    Identifier<TypeParam> identifier;
    int k = 0;
    for (const Stretch& stretch : *any_stretches(8)) {
      Chance chance(stretch.chance);
      for (int i = 0; i < stretch.length; ++i, ++k) {
        const Input<TypeParam> in = input<TypeParam>(stretch, k, chance);
        identifier.update(in.torque, in.angle, chance.bits() % 16 != 0);
        if (stretch.chance % 64 == 0 && i == 0) identifier.resettle();
        require_sound(identifier);
        RC_ASSERT(identifier.colour_depth() >= TypeParam(0) && identifier.colour_depth() < TypeParam(1));
      }
    }
  });
}

/// The next sample: a wheel's, with fields spoiled as `kind` says.
Sample sample(const Stretch& stretch, std::int64_t tick, Chance& chance) {
  const auto any_int = [&chance] { return static_cast<std::int32_t>(chance.bits()); };
  const auto any_long = [&chance] {
    return static_cast<std::int64_t>((static_cast<std::uint64_t>(chance.bits()) << 32U) | chance.bits());
  };
  Sample s;
  s.stamp_us = tick * kTickPeriodUs;
  s.torque_driver_mnm = static_cast<std::int32_t>(3000 * std::sin(0.05 * static_cast<double>(tick)));
  s.torque_motor_mnm = any_int() % 100;
  s.angle_urad = s.torque_driver_mnm * 40 + any_int() % 700;
  switch (stretch.kind) {
    case 0:
      break;
    case 1:  // every field anything
      s = {any_long(),
           any_int(),
           any_int(),
           any_int(),
           static_cast<std::uint16_t>(any_int()),
           static_cast<std::uint8_t>(any_int())};
      break;
    case 2:
      s.stamp_us = any_long();
      break;
    case 3:
      s.angle_urad = any_int();
      break;
    case 4:  // as wild as the supervision lets pass
      s.angle_urad = any_int() % 200'000;
      s.torque_driver_mnm = any_int() % 10'000;
      s.torque_motor_mnm = any_int() % 10'000;
      break;
    case 5:
      s.valid_bits = static_cast<std::uint8_t>(any_int());
      break;
    case 6:
      s.angle_urad = 0;
      s.torque_driver_mnm = 0;
      s.torque_motor_mnm = 0;
      break;
    case 7:
      s.stamp_us += (any_int() % 3) * 86'400'000'000;
      break;
    default:
      s.angle_urad = chance.bits() % 2 == 0 ? INT32_MAX : INT32_MIN;
      s.torque_motor_mnm = chance.bits() % 2 == 0 ? INT32_MAX : INT32_MIN;
      break;
  }
  return s;
}

TYPED_TEST(IdentificationProperty, WhatIsPublishedIsLegal) {
  test::check_property(51, 200, [] {
    IdentificationTask<TypeParam> task;
    std::int64_t tick = 0;
    for (const Stretch& stretch : *any_stretches(9)) {
      Chance chance(stretch.chance);
      for (int i = 0; i < stretch.length; ++i, ++tick) {
        if (stretch.chance % 16 == 0 && i % 3 == 0) {
          task.idle();
        } else {
          task.take(sample(stretch, tick, chance));
        }
        require_sound(task.identifier());
        const Estimate estimate = task.estimate();
        require_in_range(estimate);
        const bool all = estimate.inertia.state == ParameterState::kValid &&
                         estimate.damping.state == ParameterState::kValid &&
                         estimate.stiffness.state == ParameterState::kValid;
        RC_ASSERT(task.valid() == all);
        RC_ASSERT(task.fault() == (estimate.inertia.state == ParameterState::kFault));
      }
    }
  });
}

TYPED_TEST(IdentificationProperty, ARestoredEstimateIsRefusedOrSound) {
  test::check_property(52, 300, [] {
    IdentificationTask<TypeParam> task;
    SavedEstimate saved;
    for (std::size_t i = 0; i < 3; ++i) {
      saved.value_micro[i] = *rc::gen::oneOf(rc::gen::arbitrary<std::int32_t>(), rc::gen::inRange(1'000, 20'000'000));
      saved.sd_micro[i] = *rc::gen::oneOf(rc::gen::arbitrary<std::int32_t>(), rc::gen::inRange(1, 1'000'000));
    }
    saved.noise_unm = *rc::gen::oneOf(rc::gen::arbitrary<std::int32_t>(), rc::gen::inRange(1, 100'000));
    const Status status = task.restore(saved);
    RC_CLASSIFY(status == Status::kOk);
    require_in_range(task.estimate());
    RC_ASSERT(!task.valid());
    Chance chance(*rc::gen::arbitrary<std::uint32_t>());
    for (std::int64_t tick = 0; tick < 300; ++tick) {
      task.take(sample({.kind = 0, .length = 300, .chance = 0}, tick, chance));
      require_sound(task.identifier());
      require_in_range(task.estimate());
    }
  });
}

}  // namespace
}  // namespace steerid
