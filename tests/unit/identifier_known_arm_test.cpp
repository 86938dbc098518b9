// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The arm that is kept aside, alone and in the identifier on a wheel whose motion is known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identifier/identifier.hpp"
#include "identifier/known_arm.hpp"
#include "support/seed.hpp"
#include "support/steady_wheel.hpp"

namespace steerid {
namespace {

using test::SteadyWheel;

template <class Scalar>
class KnownArmOf : public ::testing::Test {
 protected:
  static KnownArm<Scalar> kept(double deviation_nm, double stiffness = 22.7) {
    KnownArm<Scalar> known;
    offer(known, deviation_nm, stiffness);
    return known;
  }
  static void offer(KnownArm<Scalar>& known, double deviation_nm, double stiffness) {
    const Vector3<Scalar> p(Scalar(0.11), Scalar(1.5), Scalar(stiffness));
    known.offer(ParameterSum<Scalar>(p), Scalar(deviation_nm * deviation_nm), Prior<Scalar>());
  }
  /// Samples of white noise, at a torque that tells, until the arm explains them; `most` when it does not.
  static int samples_until_explained(KnownArm<Scalar> known, double deviation_nm, int most, std::mt19937_64& random) {
    std::normal_distribution<double> normal(0, deviation_nm);
    known.ask();
    for (int k = 1; k <= most; ++k) {
      known.compare(Scalar(1), Scalar(normal(random)));
      if (known.explains()) return k;
    }
    return most;
  }
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(KnownArmOf, Scalars);

TYPED_TEST(KnownArmOf, IsKeptToHalfAStep) {
  const Prior<TypeParam> prior;
  const double limits[] = {0.6, 15, 300};
  const double p[] = {0.11, 1.5, 22.7};
  const Vector3<TypeParam> value = this->kept(0.03).value(prior);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(value(i)), p[i], 0.51 * limits[i] / 65535) << i;
}

TYPED_TEST(KnownArmOf, ItsDeviationIsNeverLessAndAStepMoreAtMost) {
  for (const double deviation_nm : {0.001, 0.0305, 0.4, 6.0}) {
    const double kept_nm = std::sqrt(static_cast<double>(this->kept(deviation_nm).variance()));
    EXPECT_GT(kept_nm, deviation_nm * (1 - 1e-6));
    EXPECT_LT(kept_nm, deviation_nm + 1.01e-4);
  }
  KnownArm<TypeParam> held = this->kept(100);
  EXPECT_NEAR(std::sqrt(static_cast<double>(held.variance())), 6.5, 1e-3);
  held.age();
  EXPECT_NEAR(std::sqrt(static_cast<double>(held.variance())), 6.5, 1e-3);
}

TYPED_TEST(KnownArmOf, IsNotAskedForBeforeThereIsOne) {
  KnownArm<TypeParam> known;
  known.ask();
  EXPECT_FALSE(known.asked());
  known = this->kept(0.03);
  EXPECT_FALSE(known.asked());
  known.ask();
  EXPECT_TRUE(known.asked());
  known.taken_back();
  EXPECT_FALSE(known.asked());
}

// 98.76 % of its own noise lies within 2.5 deviations: 0.938 a sample, 75 in 80, with a scatter of 5.3.
TYPED_TEST(KnownArmOf, ExplainsItsOwnNoiseWithinASecond) {
  std::mt19937_64 random(test::seed(90));
  double sum = 0;
  for (int drive = 0; drive < 400; ++drive) sum += this->samples_until_explained(this->kept(0.1), 0.1, 1000, random);
  EXPECT_GT(sum / 400, 79);
  EXPECT_LT(sum / 400, 81);
}

// Of noise of six times the variance 69 % lies within: it loses half a sample a sample. Of twice, 92 %: it gains 0.6.
TYPED_TEST(KnownArmOf, DoesNotExplainWhatIsMuchNoisier) {
  std::mt19937_64 random(test::seed(91));
  EXPECT_EQ(this->samples_until_explained(this->kept(0.1), 0.1 * std::sqrt(6), 20'000, random), 20'000);
  EXPECT_LT(this->samples_until_explained(this->kept(0.1), 0.1 * std::sqrt(2), 20'000, random), 400);
}

TYPED_TEST(KnownArmOf, HearsNothingAtRest) {
  KnownArm<TypeParam> known = this->kept(0.1);
  known.ask();
  for (int k = 0; k < 1000; ++k) known.compare(TypeParam(0.49), TypeParam(0));
  EXPECT_FALSE(known.explains());
  for (int k = 0; k < 75; ++k) known.compare(TypeParam(-0.51), TypeParam(0));
  EXPECT_TRUE(known.explains());
}

TYPED_TEST(KnownArmOf, OneThatIsMuchNoisierTakesItsPlaceOnlyOnceItIsOld) {
  const Prior<TypeParam> prior;
  KnownArm<TypeParam> known = this->kept(1.0, 20);
  this->offer(known, std::sqrt(1.45), 21);
  EXPECT_NEAR(known.value(prior)(kStiffness), 21, 0.01);
  this->offer(known, std::sqrt(2 * 1.45), 22);
  EXPECT_NEAR(known.value(prior)(kStiffness), 21, 0.01);
  // The deviation has to grow by sqrt(2 / 1.5): 36 looks of 0.4 %.
  int looks = 0;
  for (; known.value(prior)(kStiffness) < TypeParam(21.5) && looks < 1000; ++looks) {
    known.age();
    this->offer(known, std::sqrt(2 * 1.45), 22);
  }
  EXPECT_GT(looks, 30);
  EXPECT_LT(looks, 42);
}

/// What a fault makes of a sample: the torque times `turn`, and a slow swing of 0.3 Hz on it.
struct Spoiled {
  double turn = 1;
  double swing_nm = 0;
};

/// 30 s of a wheel, 6 s of a fault, a tenth of a second of which are not to be learned from, and 10 s of the wheel
/// `after`.
template <class Scalar>
class FaultyDrive {
 public:
  FaultyDrive(const SteadyWheel& before, const SteadyWheel& after, const Spoiled& fault, std::uint64_t seed)
      : random_(seed) {
    for (int k = 0; k < 4600; ++k) {
      const SteadyWheel& wheel = k < 3600 ? before : after;
      const Spoiled now = k >= 3000 && k < 3600 ? fault : Spoiled{};
      const double torque =
          wheel.torque_nm(0.01 * k) * now.turn + now.swing_nm * std::sin(0.0188 * k) + 0.03 * normal_(random_);
      const double angle = wheel.angle_rad(0.01 * k) + 0.0007 * normal_(random_);
      const bool learn = k < 3500 || k >= 3510;
      identifier.update(static_cast<Scalar>(torque), static_cast<Scalar>(angle), learn);
      if (k == 2999) valid_before = valid();
      if (k >= 3200 && k < 3600 && valid()) ++valid_in_fault;
      if (k == 3599) depth_in_fault = static_cast<double>(identifier.colour_depth());
      if (k >= 3600 && !valid()) recovery_s = 0.01 * (k - 3600 + 1);
    }
  }

  Identifier<Scalar> identifier;
  bool valid_before = false;
  int valid_in_fault = 0;
  double depth_in_fault = 0;
  double recovery_s = 0;

 private:
  [[nodiscard]] bool valid() const {
    return identifier.belief(0) == Belief::kValid && identifier.belief(1) == Belief::kValid &&
           identifier.belief(2) == Belief::kValid;
  }
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

template <class Scalar>
class TakenBackIn : public ::testing::Test {};
TYPED_TEST_SUITE(TakenBackIn, Scalars);

// 0.5 s for what the filters remember, 0.8 s to hear it, 0.5 s to the next refresh at the longest. A search, its
// filters and the two seconds after it would take 3.5 s at the least.
TYPED_TEST(TakenBackIn, OnceTheFaultIsOver) {
  const SteadyWheel wheel{0.11, 1.5, 22.7, SteadyWheel::probe()};
  const FaultyDrive<TypeParam> drive(wheel, wheel, {.turn = -1}, test::seed(92));
  EXPECT_TRUE(drive.valid_before);
  EXPECT_EQ(drive.valid_in_fault, 0);
  EXPECT_GT(drive.recovery_s, 0.5);
  EXPECT_LT(drive.recovery_s, 5);
  const double truth[] = {0.11, 1.5, 22.7};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(drive.identifier.value(i)) / truth[i], 1, 0.01) << i;
}

// A swing makes a slow residual, and that a whitening filter, while the arm is asked for: without a fault there is
// none. 5 s are what is asked of a recovery.
TYPED_TEST(TakenBackIn, FromBehindAWhiteningFilterThatTheFaultHasMade) {
  const SteadyWheel wheel{0.11, 1.5, 22.7, SteadyWheel::probe()};
  const FaultyDrive<TypeParam> drive(wheel, wheel, {.swing_nm = 0.5}, test::seed(94));
  EXPECT_TRUE(drive.valid_before);
  EXPECT_GT(drive.depth_in_fault, 0.2);  // the least that a whitening filter is made for is 1 - 1/1.3
  EXPECT_EQ(drive.valid_in_fault, 0);
  EXPECT_GT(drive.recovery_s, 0.5);
  EXPECT_LT(drive.recovery_s, 5);
  const double truth[] = {0.11, 1.5, 22.7};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(drive.identifier.value(i)) / truth[i], 1, 0.02) << i;
}

TYPED_TEST(TakenBackIn, NotWhenTheArmIsAnotherOneThen) {
  const SteadyWheel before{0.11, 1.5, 22.7, SteadyWheel::probe()};
  const SteadyWheel after{0.11, 2.1, 45.9, SteadyWheel::probe()};
  const FaultyDrive<TypeParam> drive(before, after, {.turn = -1}, test::seed(93));
  EXPECT_GT(drive.recovery_s, 2.5);
  EXPECT_LT(drive.recovery_s, 12);
  const double truth[] = {0.11, 2.1, 45.9};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(drive.identifier.value(i)) / truth[i], 1, 0.03) << i;
}

}  // namespace
}  // namespace steerid
