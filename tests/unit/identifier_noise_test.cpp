// Sensor noise, its colour, and the change detector against signals whose statistics are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "identifier/change_detector.hpp"
#include "identifier/noise_colour.hpp"
#include "identifier/noise_information.hpp"
#include "identifier/sensor_noise.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// One estimate is a mean of squares of sixth differences over N = 1000 samples; their correlation at lag k is
// C(12, 6 + k) / C(12, 6), so that the relative variance is 2/N C(24,12)/C(12,6)^2 = 2/N 3.167. Averaged over 100
// estimates: sd 0.80 %. The limit is four of them, on both sides.
TEST(SensorNoise, FindsTheVarianceOfWhiteNoise) {
  std::mt19937_64 random(test::seed(5));
  std::normal_distribution<double> normal;
  double mean = 0;
  double square = 0;
  for (int run = 0; run < 100; ++run) {
    SensorNoise<double> noise;
    for (int k = 0; k < 1006; ++k) noise.push(3.0 + 0.0007 * normal(random));
    const double relative = noise.variance() / (0.0007 * 0.0007);
    mean += relative / 100;
    square += relative * relative / 100;
  }
  EXPECT_NEAR(mean, 1.0, 4 * 0.0080);
  // And it scatters as it should; the sd of a sd from 100 runs is 7 %.
  EXPECT_NEAR(std::sqrt(square - mean * mean) / std::sqrt(2 * 3.167 / 1000), 1.0, 0.28);
}

// A converter's step q is noise of variance q^2/12 (Widrow) once the noise before it spans the step. Averages over 20
// runs: sd 1.8 %, four of them.
TEST(SensorNoise, TakesResolutionForTheNoiseThatItAmountsTo) {
  std::mt19937_64 random(test::seed(6));
  std::normal_distribution<double> normal;
  double mean = 0;
  for (int run = 0; run < 20; ++run) {
    SensorNoise<double> noise;
    for (int k = 0; k < 1006; ++k) {
      noise.push(std::nearbyint(0.3 * std::sin(kTurn * 0.5 * 0.01 * k) / 0.0005 + 1.4 * normal(random)) * 0.0005);
    }
    mean += noise.variance() / 20;
  }
  EXPECT_NEAR(mean / (0.0005 * 0.0005 * (1.4 * 1.4 + 1.0 / 12)), 1.0, 4 * 0.018);
}

// (2 sin(pi f T))^12 / 924 of a sine's power comes through: at 5 Hz 9.5e-10, five tenths of a milliradian for a whole
// one. The estimate sees whole periods, and only rounding differs.
TEST(SensorNoise, LetsThroughOfASineWhatItsHeaderStates) {
  SensorNoise<double> noise;
  for (int k = 0; k < 1006; ++k) noise.push(std::sin(kTurn * 5 * 0.01 * k));
  const double share = std::pow(2 * std::sin(std::numbers::pi * 0.05), 12) / 924;
  EXPECT_NEAR(noise.variance() / (0.5 * share), 1.0, 0.01);
  EXPECT_NEAR(std::pow(2 * std::sin(std::numbers::pi * 0.05), 6), 0.001, 0.0001);
}

TEST(SensorNoise, DoesNotDifferenceAcrossAGap) {
  std::mt19937_64 random(test::seed(7));
  std::normal_distribution<double> normal;
  SensorNoise<double> noise;
  for (int k = 0; k < 2000; ++k) {
    if (k == 1000) noise.break_here();
    noise.push((k < 1000 ? 0.0 : 50.0) + 0.001 * normal(random));
  }
  EXPECT_NEAR(noise.variance() / 1e-6, 1.0, 4 * 0.08);  // one estimate: sd 8 %
}

TEST(SensorNoise, IsMovedLittleByOneWildSample) {
  std::mt19937_64 random(test::seed(8));
  std::normal_distribution<double> normal;
  SensorNoise<double> noise;
  for (int k = 0; k < 2000; ++k) noise.push((k == 1500 ? 1.0 : 0.0) + 0.001 * normal(random));
  // Seven differences hold it, each counts 25 variances at most: + 17.5 %, beside the 8 % of chance.
  EXPECT_LT(noise.variance() / 1e-6, 1.175 + 4 * 0.08);
}

/// Share of the power below 0.5 Hz, by a transform of the test's own over the lowest frequencies.
double slow_share(const std::vector<double>& x) {
  const double n = static_cast<double>(x.size());
  double slow = 0;
  double all = 0;
  for (const double v : x) all += v * v / n;
  for (int bin = 1; bin * 100.0 / n <= 0.5; ++bin) {
    double re = 0;
    double im = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      re += x[k] * std::cos(kTurn * bin * static_cast<double>(k) / n);
      im += x[k] * std::sin(kTurn * bin * static_cast<double>(k) / n);
    }
    slow += 2 * (re * re + im * im) / (n * n);
  }
  return slow / all;
}

struct Whitened {
  double depth = 0;
  double mean_depth = 0;
  std::vector<double> residual;
};

/// 120 s of white noise of variance 1 with slow torque of `slow_sd` beside it: two first-order lags in a row at 0.3 Hz,
/// the process that the header speaks of. What is kept is the last 60 s.
Whitened whiten(double slow_sd, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  NoiseColour<double> colour;
  Shelf<double> shelf;
  Whitened out;
  double once = 0;
  double slow = 0;
  const double keep = std::exp(-kTurn * 0.3 * 0.01);
  // Variance of two lags in a row fed with variance 1: (1 - a)^4 (1 + a^2) / (1 - a^2)^3.
  const double gain = slow_sd / std::sqrt(std::pow(1 - keep, 4) * (1 + keep * keep) / std::pow(1 - keep * keep, 3));
  for (int k = 0; k < 12000; ++k) {
    once = keep * once + (1 - keep) * gain * normal(random);
    slow = keep * slow + (1 - keep) * once;
    const double coloured = slow + normal(random);
    const double residual = shelf.step(coloured, ShelfShape<double>::of_depth(colour.depth()));
    colour.learn(coloured);
    if (k < 6000) continue;
    out.residual.push_back(residual);
    out.mean_depth += colour.depth() / 6000;
  }
  out.depth = colour.depth();
  return out;
}

// The memory of 15 s holds some 15 independent values behind the low-pass at 0.5 Hz: their mean square scatters by
// sqrt(2/15) = 0.37, and passes 1.75, where the depth begins with 0.2, one time in forty.
TEST(NoiseColour, LeavesWhiteNoiseAlone) {
  double mean = 0;
  for (std::uint64_t run = 0; run < 20; ++run) mean += whiten(0.0, test::seed(100 + run)).mean_depth / 20;
  EXPECT_LT(mean, 0.05);
}

TEST(NoiseColour, TakesSlowTorqueDownToWhatWhiteNoiseWouldHave) {
  double share_after = 0;
  double depth = 0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    const Whitened w = whiten(1.0, test::seed(200 + run));
    depth += w.mean_depth / 20;
    share_after += slow_share(w.residual) / 20;
  }
  // In closed form: the density at rest is R = gain^2 / 1 = 212 times white noise's, of which 30 s take 1.4 times to be
  // safe, and 1 - (1 + 1.4 212)^-1/4 = 0.759. One R from 30 s scatters by some 26 %, the depth by 0.065 (1 - 0.759) =
  // 0.016 and by less over 20 runs of 60 s.
  EXPECT_NEAR(depth, 0.759, 0.05);
  // Half of the power was slow; what is left is within a factor of two of white noise's 1 %.
  EXPECT_GT(share_after, 0.005);
  EXPECT_LT(share_after, 0.02);
}

TEST(NoiseColour, ConcludesNothingFromSilence) {
  NoiseColour<float> colour;
  for (int k = 0; k < 100000; ++k) {
    colour.learn(0.0F);
    ASSERT_EQ(colour.depth(), 0.0F);
  }
}

// 5.5 /s^2 (12 s / t)^2 over the sum of the squares of the motion's angular frequency and of 2 pi 0.3 Hz; 3 s for 12 s
// where another arm of the same driver is looked for. Within the four figures that the corner is given with.
TEST(NoiseColour, IsTheMoreCautiousTheSlowerTheMotion) {
  NoiseColour<double> colour;
  for (const double doubt_s : {12.0, 3.0}) {
    for (int k = 1; k <= 4000; ++k) {
      colour.learn(0.1);
      const double seconds = 0.01 * std::min(k, 3000);
      for (const double w : {0.0, 1.5, 12.0}) {
        const double more = 5.5 * std::pow(doubt_s / seconds, 2) / (w * w + std::pow(kTurn * 0.3, 2));
        ASSERT_NEAR(colour.caution(w * w), k < 100 ? 1 : 1 + more, 1e-4 * (1 + more)) << k;
      }
    }
    colour.start_anew();
  }
}

// In discrete time it is (1 - depth)^2 times the square root of the shelf's gain at high frequencies, whatever the
// depth: white noise and slow noise come out alike.
TEST(Shelf, LeavesTheSquareOfOneMinusDepthAtRest) {
  for (const double depth : {0.0, 0.5, 0.75, 0.9}) {
    const auto shape = ShelfShape<double>::of_depth(depth);
    Shelf<double> shelf;
    Shelf<double> settled;
    settled.settle_at(3.0);
    double y = 0;
    for (int k = 0; k < 5000; ++k) y = shelf.step(3.0, shape);
    EXPECT_NEAR(y, 3.0 * (1 - depth) * (1 - depth) * std::sqrt(shape.direct()), 1e-9);
    EXPECT_NEAR(y, 3.0 * shape.at_rest(), 1e-12);
    EXPECT_NEAR(settled.step(3.0, shape), y, 1e-12);
  }
}

/// |D|^2 of the discrete filter itself at f_hz, from its answer to an impulse.
double power_through(const ShelfShape<double>& shape, double f_hz) {
  Shelf<double> shelf;
  std::complex<double> sum;
  for (int k = 0; k < 8000; ++k)
    sum += shelf.step(k == 0 ? 1.0 : 0.0, shape) * std::polar(1.0, -kTurn * f_hz * 0.01 * k);
  return std::norm(sum);
}

// White noise of variance 1 and two lags at 0.3 Hz on white noise, R times as dense at rest: behind the shelf of depth
// 1 - (1 + R)^-1/4 the spectrum is flat. The lags' spectrum is R ((1 - q)^2 / |1 - q/z|^2)^2.
TEST(Shelf, MakesSlowNoiseAndWhiteNoiseWhite) {
  const double q = std::exp(-kTurn * 0.3 * 0.01);
  for (const double depth : {0.2, 0.5, 0.75, 0.9, 0.95}) {
    const auto shape = ShelfShape<double>::of_depth(depth);
    const double density = std::pow(1 - depth, -4) - 1;
    for (const double f_hz : {0.02, 0.1, 0.3, 0.7, 1.5, 3.0, 6.0, 12.0, 25.0, 50.0}) {
      const double lag = (1 - q) * (1 - q) / std::norm(1.0 - q * std::polar(1.0, kTurn * f_hz * 0.01));
      const double white = power_through(shape, f_hz) * (1 + density * lag * lag);
      // The constants are rounded to six digits.
      EXPECT_NEAR(white / shape.direct(), 1.0, 1e-3) << depth << " at " << f_hz;
    }
  }
}

TEST(Shelf, IsUndone) {
  std::mt19937_64 random(test::seed(12));
  std::normal_distribution<double> normal;
  for (const double depth : {0.0, 0.5, 0.75, 0.9}) {
    const auto shape = ShelfShape<double>::of_depth(depth);
    Shelf<double> shelf;
    Unshelf<double> unshelf;
    for (int k = 0; k < 5000; ++k) {
      const double x = normal(random);
      ASSERT_NEAR(unshelf.step(shelf.step(x, shape), shape), x, 1e-9);
    }
  }
}

// The formula in s against the discrete filter: what the bilinear difference of w makes below 6 Hz.
TEST(Shelf, LeavesThePowerItSays) {
  for (const double depth : {0.0, 0.5, 0.75, 0.94}) {
    const auto shape = ShelfShape<double>::of_depth(depth);
    for (const double f_hz : {0.1, 0.5, 1.0, 3.0, 5.0}) {
      const double w = kTurn * f_hz;
      EXPECT_NEAR(shape.power_left(w * w, 0.01) / power_through(shape, f_hz), 1.0, 0.04) << depth << " " << f_hz;
    }
  }
}

// What the torque sensor's noise makes of the model's motion, against the integral over all frequencies; the arms from
// relaxed to braced. Without the shelf the closed form is the integral; behind it one frequency stands for a band.
TEST(NoiseInformation, IsTheIntegralOfTheSpectrum) {
  constexpr double kArms[][3] = {
      {0.06, 0.4, 2.0}, {0.11, 1.5, 22.7}, {0.11, 2.1, 45.9}, {0.18, 4.4, 4.5}, {0.11, 0.7, 17.0}};
  for (const auto& arm : kArms) {
    for (const double corner_hz : {2.5, 6.0}) {
      for (const double depth : {0.0, 0.4, 0.7, 0.85, 0.93}) {
        const double a0 = kTurn * corner_hz * kTurn * corner_hz;
        const double a1 = 1.4 * kTurn * corner_hz;
        const auto shelf = ShelfShape<double>::of_depth(depth);
        const double corner = kTurn * 0.3;
        const double end = corner / (1 - depth);
        const double damping = std::sqrt(2 * (1 + (1 - depth) * (1 - depth)));
        double integral[3] = {};
        constexpr int kSteps = 4000;
        const double ratio = std::pow(5e4, 1.0 / kSteps);  // 1e-3 to 50 Hz
        double w = kTurn * 1e-3;
        for (int k = 0; k < kSteps; ++k, w *= ratio) {
          const std::complex<double> s(0, w);
          const auto filter = a0 / (s * s + a1 * s + a0);
          const auto wheel = 1.0 / (arm[0] * s * s + arm[1] * s + arm[2]);
          const auto whitening = (s + corner) * (s + corner) / (s * s + damping * end * s + end * end);
          // White noise of variance 1 at 100 Hz has the two-sided density 0.01; dw = w (ratio - 1).
          const double density = 0.01 * std::norm(filter * wheel * whitening) * w * (ratio - 1) / (kTurn / 2);
          integral[0] += density;
          integral[1] += density * w * w;
          integral[2] += density * w * w * w * w;
        }
        const auto says = noise_information<double>(Eigen::Vector3d(arm[0], arm[1], arm[2]), a0, a1, 1.0, 0.01, shelf);
        const double got[3] = {says.angle / integral[0], says.rate / integral[1], says.acceleration / integral[2]};
        for (const double& share : got) {
          EXPECT_LT(share, depth > 0 ? 3.5 : 1.01) << arm[2] << " " << corner_hz << " " << depth;
          EXPECT_GT(share, depth > 0 ? 1.0 / 3.5 : 0.99) << arm[2] << " " << corner_hz << " " << depth;
        }
      }
    }
  }
}

// Two signals that hang together by one factor go on doing so once a change of depth has rung out: to a thousandth of
// the signal, as ring_out() says.
TEST(Shelf, HasForgottenAChangeWhenItHasRungOut) {
  const auto before = ShelfShape<double>::of_depth(0.0);
  const auto after = ShelfShape<double>::of_depth(0.75);
  Shelf<double> changed;
  Shelf<double> always;
  int k = 0;
  const auto signal = [&k] { return std::sin(kTurn * 0.7 * 0.01 * k); };
  for (; k < 1000; ++k) {
    changed.step(signal(), before);
    always.step(signal(), after);
  }
  double worst = 0;
  for (; k < 1500; ++k) {
    const double difference = std::abs(changed.step(signal(), after) - always.step(signal(), after));
    if (k == 1002) {
      EXPECT_GT(difference, 0.05);
    }
    if (k >= 1000 + after.ring_out()) worst = std::max(worst, difference);
  }
  // A thousandth of the signal, or eight, were both poles in one place: (1 + 6.9) e^-6.9.
  EXPECT_LT(worst, 0.008);
}

// Twenty hours of noise as it should be.
TEST(ChangeDetector, DoesNotRingOnNoiseAlone) {
  std::mt19937_64 random(test::seed(9));
  std::normal_distribution<double> normal;
  ChangeDetector<double> detector;
  for (int k = 0; k < 7'200'000; ++k) {
    const double e = normal(random);
    ASSERT_FALSE(detector.surprised(e * e, e * e, 1.0, 0.0)) << "after " << k << " samples";
  }
}

// An innovation that is sqrt(20) times too large: the mean rises as 20 - 19 (15/16)^n and passes 8 at n = 7.1; chance
// moves that, but 40 samples in a row never average below 8.
TEST(ChangeDetector, RingsWithinFourTenthsOfASecond) {
  std::mt19937_64 random(test::seed(10));
  std::normal_distribution<double> normal;
  double mean_delay = 0;
  for (int run = 0; run < 200; ++run) {
    ChangeDetector<double> detector;
    for (int k = 0; k < 200; ++k) {
      const double e = normal(random);
      ASSERT_FALSE(detector.surprised(e * e, e * e, 1.0, 0.0));
    }
    int delay = 0;
    for (bool rung = false; !rung; ++delay) {
      const double e = std::sqrt(20.0) * normal(random);
      rung = detector.surprised(e * e, e * e, 1.0, 0.0);
      ASSERT_LT(delay, 40);
    }
    mean_delay += delay / 200.0;
  }
  EXPECT_GT(mean_delay, 5);
  EXPECT_LT(mean_delay, 15);
}

// What no sensor sees surprises as well; it is no other arm while it is a small part of the torque.
TEST(ChangeDetector, IsNotRungByWhatIsSmallAgainstTheTorque) {
  for (const double torque_square : {3.30, 3.37}) {
    ChangeDetector<double> detector;
    bool rung = false;
    for (int k = 0; k < 1000; ++k) rung = detector.surprised(50.0, 1.0, torque_square, 0.0) || rung;
    EXPECT_EQ(rung, torque_square < 1 / 0.3);
  }
}

// More than noise makes it suspicious, also where it is too little to be another arm.
TEST(ChangeDetector, IsSuspiciousBeforeItRings) {
  ChangeDetector<double> detector;
  EXPECT_FALSE(detector.suspicious());
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(detector.surprised(50.0, 0.1, 1.0, 0.0));
  EXPECT_TRUE(detector.suspicious());
  detector.reset();
  EXPECT_FALSE(detector.suspicious());
}

TEST(ChangeDetector, IsNotRungByOneSampleHoweverWild) {
  ChangeDetector<float> detector;
  EXPECT_FALSE(detector.surprised(1e30F, 1e30F, 1.0F, 0.0F));
  EXPECT_FALSE(detector.surprised(0.0F, 0.0F, 1.0F, 0.0F));
  detector.reset();
  // 1 + 29 (1 - (15/16)^n) passes 8 at n = 5.
  for (int n = 1; n < 5; ++n) EXPECT_FALSE(detector.surprised(50.0F, 50.0F, 1.0F, 0.0F));
  EXPECT_TRUE(detector.surprised(50.0F, 50.0F, 1.0F, 0.0F));
}

// Slow torque that is known to be unmeasured may jump: 0.07 of its power are expected.
TEST(ChangeDetector, IsNotRungByWhatIsSmallAgainstTheUnmeasuredTorque) {
  for (const double slow_power : {14.0, 14.6}) {
    ChangeDetector<double> detector;
    bool rung = false;
    for (int k = 0; k < 1000; ++k) rung = detector.surprised(50.0, 1.0, 0.0, slow_power) || rung;
    EXPECT_EQ(rung, slow_power < 1 / 0.07);
  }
}

// What it tells of its step is the difference of two outputs while the shelf stays as it is.
TEST(Shelf, TellsTheStepThatItLeaves) {
  Shelf<double> shelf;
  const auto shape = ShelfShape<double>::of_depth(0.8);
  Moved<double> x;
  double before = 0;
  for (int k = 1; k < 300; ++k) {
    const double to = std::sin(0.07 * k) + 0.2 * std::sin(0.9 * k);
    x = {to, to - x.to};
    const Moved<double> left = shelf.step(x, shape);
    ASSERT_NEAR(left.by, left.to - before, 1e-14);
    before = left.to;
  }
}

}  // namespace
}  // namespace steerid
