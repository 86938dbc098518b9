// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "sensors/normal_table.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace steerid {
namespace {

using Coefficients = std::array<double, 8>;

/// c[0] + c[1] x + ... + c[7] x^7 in Estrin's order: a third of the latency of Horner's rule.
double polynomial(const Coefficients& c, double x) {
  const double x2 = x * x;
  const double low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
  const double high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
  return low + high * (x2 * x2);
}

/// 1/1, 1/3, 1/5, ...
constexpr std::array<double, 11> kOddInverses{1.0,      1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9, 1.0 / 11,
                                              1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21};

/// Natural logarithm of a normal double in (0, 1] from IEEE operations only: x = m 2^e with m in [sqrt(1/2), sqrt(2)),
/// log m = 2 atanh((m - 1)/(m + 1)), whose series in ((m - 1)/(m + 1))^2 <= 0.0295 falls below 2^-53 after 10 terms.
double portable_log(double x) {
  const auto raw = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<int>(raw >> 52U) - 1023;
  double mantissa = std::bit_cast<double>((raw & 0x000FFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL);
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  const double s2 = s * s;
  double series = 0.0;
  for (std::size_t i = kOddInverses.size(); i-- > 0;) series = series * s2 + kOddInverses[i];
  return 2.0 * s * series + exponent * 0.69314718055994530942;
}

// Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Applied Statistics 37 (1988).
constexpr Coefficients kCentreTop{3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                                  1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                                  3.3430575583588128105e+4, 2.5090809287301226727e+3};
constexpr Coefficients kCentreBottom{1.0,
                                     4.2313330701600911252e+1,
                                     6.8718700749205790830e+2,
                                     5.3941960214247511077e+3,
                                     2.1213794301586595867e+4,
                                     3.9307895800092710610e+4,
                                     2.8729085735721942674e+4,
                                     5.2264952788528545610e+3};
constexpr Coefficients kShoulderTop{1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                                    3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                                    2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr Coefficients kShoulderBottom{1.0,
                                       2.05319162663775882187e0,
                                       1.67638483018380384940e0,
                                       6.89767334985100004550e-1,
                                       1.48103976427480074590e-1,
                                       1.51986665636164571966e-2,
                                       5.47593808499534494600e-4,
                                       1.05075007164441684324e-9};
constexpr Coefficients kTailTop{6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                                2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr Coefficients kTailBottom{1.0,
                                   5.99832206555887937690e-1,
                                   1.36929880922735805310e-1,
                                   1.48753612908506148525e-2,
                                   7.86869131145613259100e-4,
                                   1.84631831751005468180e-5,
                                   1.42151175831644588870e-7,
                                   2.04426310338993978564e-15};

/// The cubic through values at 0, 1/3, 2/3 and 1 of an interval, in the distance from its start (Newton's divided
/// differences).
Cubic through(const std::array<double, 4>& value, double interval) {
  const double third = interval / 3;
  const double first = value[1] - value[0];
  const double second = value[2] - 2 * value[1] + value[0];
  const double last = value[3] - 3 * value[2] + 3 * value[1] - value[0];
  return {value[0], (first - second / 2 + last / 3) / third, (second - last) / (2 * third * third),
          last / (6 * third * third * third)};
}

}  // namespace

double normal_quantile(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(kCentreTop, r) / polynomial(kCentreBottom, r);
  }
  const double r = std::sqrt(-portable_log(q < 0.0 ? p : 1.0 - p));
  const double z = r <= 5.0 ? polynomial(kShoulderTop, r - 1.6) / polynomial(kShoulderBottom, r - 1.6)
                            : polynomial(kTailTop, r - 5.0) / polynomial(kTailBottom, r - 5.0);
  return q < 0.0 ? -z : z;
}

NormalTable::NormalTable() {
  constexpr std::uint64_t kSegments = static_cast<std::uint64_t>(kOctaves) << (52U - kPlaceBits);
  segments_.reserve(kSegments);
  const auto edge = [](std::uint64_t segment) { return std::bit_cast<double>((kFirst + segment) << kPlaceBits); };
  for (std::uint64_t i = 0; i < kSegments; ++i) {
    const double start = edge(i);
    const double width = edge(i + 1) - start;
    std::array<double, 4> value{};
    for (std::size_t k = 0; k < value.size(); ++k) {
      value[k] = normal_quantile((start + width * static_cast<double>(k) / 3) * 0x1p-54);
    }
    segments_.push_back(through(value, width));
  }
}

}  // namespace steerid
