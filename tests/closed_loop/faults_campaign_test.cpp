// The faults campaign: every sensor defect and every fault of the bus, at random onsets and for random lengths, under a
// probe. Three classes, by what three channels can show:
//
//   refused      the supervision sees it in the samples themselves: never `valid` while wrong later than 2 s after the
//                onset, valid and right again within 5 s of its end.
//   misfit       the samples are plausible, but no wheel explains them: the residual gives it away, not at once and not
//                without lapses. Wrong and valid for at most half of its time, right again within 15 s.
//   not visible  the samples are those of another wheel, or nearly: a gain error scales J, B and C, a lag or a small
//                delay looks like damping, a clipped or frozen torque like a driver's. Only a second sensor could tell.
//                Range and soundness hold all the same.
//
// Wrong means: farther from the truth than three standard deviations and three percent (1 % at one sd, which is the
// most that a chance deviation and the probe's bias make).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "closed_loop/faulty_drive.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using test::Fault;
using test::FaultTime;
using test::Outcome;
using D = SensorDefects;
using T = FaultTime;

constexpr WheelArm kWheel{0.11, 1.5, 22.7};
constexpr std::int64_t kDayUs = 86'400'000'000;
constexpr int kDrives = 3;

/// A scramble of k in -range .. range.
std::int32_t scrambled(int k, std::int32_t range) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(k) * 2654435761U) % range;
}

const Fault kRefused[] = {
    {"Loss30",
     [](D& d, const T& t) {
       d.message_loss = {0.3, 3, false, t.during()};
     }},
    {"Loss90",
     [](D& d, const T& t) {
       d.message_loss = {0.9, 30, false, t.during()};
     }},
    {"FlaggedDropout",
     [](D& d, const T& t) {
       d.angle.dropout = {0.5, 5, true, t.during()};
     }},
    {"AngleStuck", [](D& d, const T& t) { d.angle.stuck.during = t.during(); }},
    {"ExtremeAngle", {}, [](Sample& s, int k) { s.angle_urad = k % 2 == 0 ? INT32_MIN : INT32_MAX; }},
    {"ExtremeTorqueAtTimes",
     {},
     [](Sample& s, int k) { s.torque_motor_mnm = k % 3 == 0 ? INT32_MAX : s.torque_motor_mnm; }},
    {"StampStandsStill", {}, [](Sample& s, int k) { s.stamp_us -= k * kTickPeriodUs; }},
    {"EverySecondStampRepeats", {}, [](Sample& s, int k) { s.stamp_us -= k % 2 * kTickPeriodUs; }},
    {"ADayBack", {}, [](Sample& s, int) { s.stamp_us -= kDayUs; }},
    {"ADayAhead", {}, [](Sample& s, int) { s.stamp_us += kDayUs; }},
    {"ADayAheadAtTimes", {}, [](Sample& s, int k) { s.stamp_us += k % 100 == 0 ? kDayUs : 0; }},
    {"Spikes", {}, [](Sample& s, int k) { s.angle_urad += k % 5 == 0 ? 1'000'000 : 0; }},
};

const Fault kMisfit[] = {
    {"SilentAngleDropout",
     [](D& d, const T& t) {
       d.angle.dropout = {0.3, 3, false, t.during()};
     }},
    {"SilentTorqueDropout",
     [](D& d, const T& t) {
       d.torque_motor.dropout = {0.3, 3, false, t.during()};
     }},
    {"MotorTorqueStuck", [](D& d, const T& t) { d.torque_motor.stuck.during = t.during(); }},
    {"AngleBias",
     [](D& d, const T& t) {
       d.angle.bias = {0.1, 0, t.during()};
     }},
    {"AngleDrift",
     [](D& d, const T& t) {
       d.angle.bias = {0, 0.02, t.during()};
     }},
    {"MotorTorqueBias",
     [](D& d, const T& t) {
       d.torque_motor.bias = {2, 0, t.during()};
     }},
    {"AngleTurnedRound",
     [](D& d, const T& t) {
       d.angle.gain = {-1, t.during()};
     }},
    {"MotorTorqueTurnedRound",
     [](D& d, const T& t) {
       d.torque_motor.gain = {-1, t.during()};
     }},
    {"TorquesSwapped", {}, [](Sample& s, int) { std::swap(s.torque_driver_mnm, s.torque_motor_mnm); }},
    {"AngleAndDriverTorqueSwapped", {}, [](Sample& s, int) { std::swap(s.angle_urad, s.torque_driver_mnm); }},
    {"AngleAndMotorTorqueSwapped", {}, [](Sample& s, int) { std::swap(s.angle_urad, s.torque_motor_mnm); }},
    {"RandomAngle", {}, [](Sample& s, int k) { s.angle_urad = scrambled(k, 300'000); }},
    {"NoisyAngle", {}, [](Sample& s, int k) { s.angle_urad += scrambled(k, 30'000); }},
    {"NoisyTorque", {}, [](Sample& s, int k) { s.torque_motor_mnm += scrambled(k, 3'000); }},
    {"SmallSpikes", {}, [](Sample& s, int k) { s.angle_urad += k % 5 == 0 ? 50'000 : 0; }},
    {"NoTorque", {}, [](Sample& s, int) { s.torque_driver_mnm = s.torque_motor_mnm = 0; }},
    {"AllZero", {}, [](Sample& s, int) { s.angle_urad = s.torque_driver_mnm = s.torque_motor_mnm = 0; }},
    {"BiasAndLossAndNoise",
     [](D& d, const T& t) {
       d.angle.bias = {0.1, 0, t.during()};
       d.message_loss = {0.2, 3, false, t.during()};
     },
     [](Sample& s, int k) { s.torque_motor_mnm += scrambled(k, 2'000); }},
};

const Fault kNotVisible[] = {
    {"AngleGain",
     [](D& d, const T& t) {
       d.angle.gain = {1.2, t.during()};
     }},
    {"MotorTorqueGain",
     [](D& d, const T& t) {
       d.torque_motor.gain = {1.5, t.during()};
     }},
    {"AngleClipped",
     [](D& d, const T& t) {
       d.angle.saturation = {0.05, t.during()};
     }},
    {"MotorTorqueClipped",
     [](D& d, const T& t) {
       d.torque_motor.saturation = {1, t.during()};
     }},
    {"AngleLag",
     [](D& d, const T& t) {
       d.angle.lag = {0.05, t.during()};
     }},
    {"AngleDelay",
     [](D& d, const T& t) {
       d.angle.delay = {50'000, t.during()};
     }},
    {"DriverTorqueStuck", [](D& d, const T& t) { d.torque_driver.stuck.during = t.during(); }},
    {"Jitter",
     [](D& d, const T& t) {
       d.jitter = {9'999, true, t.during()};
     }},
    {"JitterUnstamped",
     [](D& d, const T& t) {
       d.jitter = {9'999, false, t.during()};
     }},
};

/// What one fault did, over all its drives.
struct Account {
  double fault_s = 0;            ///< beyond 2 s after the onset
  double wrong_and_valid_s = 0;  ///< within that
  double recovery_s = 0;         ///< the longest
};

bool wrong(const Outcome& o) { return test::worst_valid_error(o.estimate, kWheel) > 3; }

void expect_legal(const Outcome& o) {
  const auto legal = [](const ParameterEstimate& p, std::int32_t lowest, std::int32_t highest, std::int32_t spread) {
    return p.value_micro >= lowest && p.value_micro <= highest && p.sd_micro >= 0 && p.sd_micro <= spread &&
           p.state <= ParameterState::kNotExcited;
  };
  ASSERT_TRUE(legal(o.estimate.inertia, 5'000, 600'000, 100'000));
  ASSERT_TRUE(legal(o.estimate.damping, 10'000, 15'000'000, 2'000'000));
  ASSERT_TRUE(legal(o.estimate.stiffness, 10'000, 300'000'000, 30'000'000));
  ASSERT_FALSE(o.valid && o.fault);
}

void add_drive(const Fault& fault, const FaultTime& when, std::uint64_t seed, Account& account) {
  const std::vector<Outcome> outcomes = test::faulty_drive(fault, when, when.end_s() + 16, seed, kWheel);
  const auto onset = static_cast<std::size_t>(std::ceil(when.onset_s * 100));
  const auto end = static_cast<std::size_t>(std::ceil(when.end_s() * 100));
  ASSERT_GT(outcomes.size(), end);
  double recovery_s = 0;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    ASSERT_NO_FATAL_FAILURE(expect_legal(outcomes[k]));
    if (k >= onset + 200 && k < end) {
      account.fault_s += 0.01;
      account.wrong_and_valid_s += wrong(outcomes[k]) ? 0.01 : 0;
    }
    if (k >= end && (!outcomes[k].valid || wrong(outcomes[k]))) recovery_s = 0.01 * static_cast<double>(k - end + 1);
  }
  account.recovery_s = std::max(account.recovery_s, recovery_s);
}

Account campaign(const Fault& fault) {
  const std::uint64_t seed = test::seed(70);
  std::mt19937_64 random(seed);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 10'000) / 10'000;
  };
  Account account;
  for (int drive = 0; drive < kDrives; ++drive) {
    // One short fault in three: a loose contact.
    const FaultTime when{between(15, 25), drive == 2 ? between(0.05, 0.5) : between(3, 15)};
    add_drive(fault, when, seed + static_cast<std::uint64_t>(drive), account);
  }
  std::printf("%-28s wrong and valid %5.2f s of %5.2f s, recovery %5.2f s\n", fault.name.c_str(),
              account.wrong_and_valid_s, account.fault_s, account.recovery_s);
  return account;
}

const auto kNames = [](const auto& tested) { return tested.param.name; };

class RefusedFault : public ::testing::TestWithParam<Fault> {};
TEST_P(RefusedFault, NeitherMisleadsNorLasts) {
  const Account account = campaign(GetParam());
  EXPECT_EQ(account.wrong_and_valid_s, 0);
  EXPECT_LE(account.recovery_s, 5);
}
INSTANTIATE_TEST_SUITE_P(Faults, RefusedFault, ::testing::ValuesIn(kRefused), kNames);

class MisfitFault : public ::testing::TestWithParam<Fault> {};
TEST_P(MisfitFault, MisleadsSeldomAndDoesNotLast) {
  const Account account = campaign(GetParam());
  EXPECT_LE(account.wrong_and_valid_s, account.fault_s / 2);
  EXPECT_LE(account.recovery_s, 15);
}
INSTANTIATE_TEST_SUITE_P(Faults, MisfitFault, ::testing::ValuesIn(kMisfit), kNames);

class InvisibleFault : public ::testing::TestWithParam<Fault> {};
TEST_P(InvisibleFault, KeepsTheOutputLegal) {
  const Account account = campaign(GetParam());
  EXPECT_GT(account.fault_s, 0);
}
INSTANTIATE_TEST_SUITE_P(Faults, InvisibleFault, ::testing::ValuesIn(kNotVisible), kNames);

/// The counters at the end of a drive with 500 spoiled samples, 20 s to 25 s.
InputCounters counters(const std::function<void(Sample&, int)>& bus) {
  return test::faulty_drive({"", {}, bus}, {20, 5}, 30, test::seed(71), kWheel).back().estimate.counters;
}

TEST(FaultCounters, AreExact) {
  EXPECT_EQ(counters([](Sample& s, int) { s.valid_bits = 0; }).invalid_channel, 500);
  EXPECT_EQ(counters([](Sample& s, int) { s.angle_urad = INT32_MIN; }).out_of_range, 500);
  EXPECT_EQ(counters([](Sample& s, int k) { s.stamp_us -= k * kTickPeriodUs; }).repeated, 499);  // the first is fresh
  const InputCounters back = counters([](Sample& s, int) { s.stamp_us -= kDayUs; });
  EXPECT_EQ(back.out_of_order, 19);
  EXPECT_EQ(back.accepted_after_gap, 1);  // the way forth again
  const InputCounters spikes = counters([](Sample& s, int k) { s.angle_urad += k % 5 == 0 ? 1'000'000 : 0; });
  EXPECT_EQ(spikes.spike, 100);
  EXPECT_EQ(spikes.accepted_after_gap, 100);
  EXPECT_EQ(spikes.out_of_range + spikes.repeated + spikes.out_of_order + spikes.stuck, 0);
}

}  // namespace
}  // namespace steerid
