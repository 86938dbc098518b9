// What is called valid on drives that show some of the parameters, all or none; how the estimate keeps through minutes
// that show nothing; how it follows another arm. The nominal arm, the sensors of a production wheel.
//
// Nothing is presented as valid that lies outside its interval: of all ticks on which a parameter is valid, at most 5 %
// may have it outside its 95 % interval. Ticks of one drive hang together, so that 20 drives are 20 independent looks:
// a limit of 5 % holds for the sum over the drives, and each drive counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "study/manoeuvres.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using Drive = VirtualDrive<double>;

constexpr WheelArm kNominal{0.11, 1.5, 22.7};
constexpr std::uint64_t kDrives = 20;

/// Shares over all drives of a kind.
struct Shares {
  std::array<double, 3> valid{};  ///< of all ticks
  std::array<double, 3> wrong{};  ///< of the valid ones, outside the 95 % interval
};

template <class Make>
Shares shares_of(const char* name, double seconds, const Make& make) {
  std::array<double, 3> valid{}, wrong{};
  double ticks = 0;
  const std::uint64_t seed = test::seed(80);
  for (std::uint64_t drive = seed; drive < seed + kDrives; ++drive) {
    Drive wheel(kNominal, drive);
    wheel.run(make(drive), seconds, [&](const Sample&) {
      ticks += 1;
      for (int i = 0; i < 3; ++i) {
        if (wheel.identifier().belief(i) != Belief::kValid) continue;
        const auto at = static_cast<std::size_t>(i);
        valid[at] += 1;
        wrong[at] += std::abs(wheel.value(i) - wheel.truth()(i)) > 1.96 * wheel.deviation(i) ? 1 : 0;
      }
    });
  }
  Shares shares;
  for (std::size_t i = 0; i < 3; ++i) {
    shares.valid[i] = valid[i] / ticks;
    shares.wrong[i] = valid[i] > 0 ? wrong[i] / valid[i] : 0;
    std::printf("%s %c: valid %.1f %%, of that wrong %.1f %%\n", name, "JBC"[i], 100 * shares.valid[i],
                100 * shares.wrong[i]);
    EXPECT_LE(shares.wrong[i], 0.05) << name << " " << i;
  }
  return shares;
}

// 0.025 Hz: C - J w^2 and B w, of which C is all that is not lost in the noise.
TEST(Excitation, TheTriangleShowsStiffnessAlone) {
  const Shares shares = shares_of("triangle", 100, [](std::uint64_t) { return triangle(); });
  EXPECT_EQ(shares.valid[0], 0);
  EXPECT_EQ(shares.valid[1], 0);
  EXPECT_GT(shares.valid[2], 0.7);
}

// One frequency tells C - J w^2 and B w: J never.
TEST(Excitation, ASineNeverShowsInertia) {
  const Shares shares = shares_of("sine", 60, [](std::uint64_t) { return sine(3, 0.25); });
  EXPECT_EQ(shares.valid[0], 0);
}

TEST(Excitation, ACurveShowsStiffnessAlone) {
  const Shares shares = shares_of("curve", 120, [](std::uint64_t seed) { return curve(5, 0.3, seed); });
  EXPECT_EQ(shares.valid[0], 0);
  EXPECT_LT(shares.valid[1], 0.05);
  EXPECT_GT(shares.valid[2], 0.8);
}

TEST(Excitation, AStraightRoadShowsNothing) {
  const Shares shares = shares_of("straight road", 120, [](std::uint64_t) { return straight_road(); });
  for (const double valid : shares.valid) EXPECT_EQ(valid, 0);
}

TEST(Excitation, RestingHandsShowNoInertia) {
  const Shares shares = shares_of("resting hands", 120, [](std::uint64_t seed) { return holding(seed); });
  EXPECT_EQ(shares.valid[0], 0);
  EXPECT_LT(shares.valid[1], 0.05);
}

// 0.3 s of settling, 1.5 s of search, ring-out and 2 s of watching are gone before anything is valid: 4 to 5 s of 30.
TEST(Excitation, AProbeShowsEverything) {
  const Shares shares = shares_of("probe", 30, [](std::uint64_t seed) { return probe(seed); });
  for (const double valid : shares.valid) {
    EXPECT_GT(valid, 0.80);
    EXPECT_LT(valid, 0.90);
  }
}

// 20 s of probe, then 120 s of curve and 120 s of nothing.
TEST(Keeping, NothingWindsUpOnACurveOrAtRest) {
  std::array<double, 3> most{};
  const std::uint64_t seed = test::seed(81);
  for (std::uint64_t drive = seed; drive < seed + 10; ++drive) {
    Drive wheel(kNominal, drive);
    wheel.run(probe(drive), 20);
    for (const Manoeuvre& rest : {curve(5, 0.3, drive), straight_road()}) {
      const std::array<double, 3> start{wheel.value(0), wheel.value(1), wheel.value(2)};
      wheel.run(rest, 120, [&](const Sample&) {
        for (int i = 0; i < 3; ++i) {
          const auto at = static_cast<std::size_t>(i);
          most[at] = std::max(most[at], std::abs(wheel.value(i) / start[at] - 1));
        }
      });
    }
  }
  std::printf("drift of J %.3f %%, B %.3f %%, C %.3f %%\n", 100 * most[0], 100 * most[1], 100 * most[2]);
  EXPECT_LE(most[0], 0.01);
  EXPECT_LE(most[1], 0.01);
  EXPECT_LE(most[2], 0.05);
  EXPECT_GT(most[2], 1e-4);  // the curve's slow changes do show C
}

// B doubled, C tripled under a probe: the median is asked to be 1.5 s; the slowest of 100 took 2.1 s.
TEST(Following, AnotherArmIsFoundWithinSeconds) {
  const WheelArm other{kNominal.inertia_kgm2, 2 * kNominal.damping_nms_per_rad, 3 * kNominal.stiffness_nm_per_rad};
  std::vector<double> taken;
  const std::uint64_t seed = test::seed(82);
  for (std::uint64_t drive = seed; drive < seed + 30; ++drive) {
    Drive wheel(kNominal, drive);
    const Manoeuvre torques = probe(drive);
    wheel.run(torques, 20 + 0.37 * static_cast<double>(drive % 27));
    wheel.wheel().become(other);
    const double from = wheel.seconds();
    double last = from;
    wheel.run(torques, 8, [&](const Sample&) {
      for (int i = 0; i < 3; ++i) {
        if (std::abs(wheel.relative_error(i)) > 0.15) last = wheel.seconds();
      }
    });
    taken.push_back(last - from);
  }
  std::sort(taken.begin(), taken.end());
  std::printf("back within 15 %%: median %.2f s, slowest %.2f s\n", taken[15], taken.back());
  EXPECT_LE(taken[15], 1.5);
  EXPECT_GT(taken[15], 0.1);
  EXPECT_LE(taken.back(), 3.0);
}

// An hour of driving, a fiftieth of the torque unmeasured: 1.5 resets an hour without cause are measured over 20 hours.
TEST(Following, RingsSeldomWithoutCause) {
  unsigned changes = 0;
  const std::uint64_t seed = test::seed(83);
  for (std::uint64_t drive = seed; drive < seed + 10; ++drive) {
    Drive wheel(kNominal, drive);
    wheel.run(together(probe(drive), unmeasured(0.03, drive)), 120);
    wheel.run(together(curve(4, 0.5, drive), unmeasured(0.1, drive)), 120);
    wheel.run(together(steering(kNominal, drive), unmeasured(0.14, drive)), 120);
    changes += wheel.identifier().changes();
  }
  std::printf("%u resets in an hour\n", changes);
  EXPECT_LE(changes, 6U);  // four standard deviations of a Poisson count of 1.5
}

}  // namespace
}  // namespace steerid
