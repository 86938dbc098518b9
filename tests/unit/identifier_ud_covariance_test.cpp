// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The factors U D U' against the matrix they stand for, kept in long double by textbook algebra.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "identifier/fixed_in_eigen.hpp"
#include "identifier/ud_covariance.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using Vector = std::array<long double, 3>;

/// A dense 3 x 3 covariance: the oracle. It takes in measurements by Joseph's form, (I - k z') P (I - k z')' + k k',
/// multiplied out: the short form is unstable even in long double.
struct Dense {
  std::array<Vector, 3> p{};

  explicit Dense(const Vector& sd) {
    for (std::size_t i = 0; i < 3; ++i) p[i][i] = sd[i] * sd[i];
  }
  [[nodiscard]] Vector times(const Vector& z) const {
    Vector out{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) out[i] += p[i][j] * z[j];
    }
    return out;
  }
  [[nodiscard]] long double along(const Vector& z) const {
    const Vector pz = times(z);
    return z[0] * pz[0] + z[1] * pz[1] + z[2] * pz[2];
  }
  void observe(const Vector& z, const Vector& k) {
    const Vector pz = times(z);
    const long double zpz = along(z);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) p[i][j] += k[i] * k[j] * (zpz + 1) - k[i] * pz[j] - pz[i] * k[j];
    }
  }
  void add(const Vector& a, long double weight) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) p[i][j] += weight * a[i] * a[j];
    }
  }
  void scale(long double factor) {
    for (Vector& row : p) {
      for (long double& x : row) x *= factor;
    }
  }
};

template <class Scalar>
Scalar rounded(long double x) {
  return static_cast<Scalar>(x);
}
template <>
Fixed rounded<Fixed>(long double x) {
  int exponent = 0;
  const long double mantissa = std::frexp(x, &exponent);
  return Fixed::scaled(std::llround(std::ldexp(mantissa, 29)), exponent - 29);
}
long double exact(double x) { return static_cast<long double>(x); }
long double exact(float x) { return static_cast<long double>(x); }
long double exact(Fixed x) { return std::ldexp(static_cast<long double>(x.mantissa()), x.exponent()); }
template <int N>
long double exact(LooseFixed<N> x) {
  return std::ldexp(static_cast<long double>(x.mantissa()), x.exponent() - 29);
}

template <class Scalar>
Vector3<Scalar> narrow(const Vector& v) {
  return {rounded<Scalar>(v[0]), rounded<Scalar>(v[1]), rounded<Scalar>(v[2])};
}
template <class Scalar>
Vector wide(const Vector3<Scalar>& x) {
  return {exact(x(0)), exact(x(1)), exact(x(2))};
}

/// What is left of `dense` once the held parameters are known: their Schur complement, J first, zero for themselves.
Dense free_part(Dense dense, Held held) {
  const auto know = [&dense](std::size_t j) {
    const Vector column = dense.p[j];
    dense.add(column, -1 / column[j]);
  };
  if (held >= Held::kInertiaOnly) know(0);
  if (held >= Held::kInertiaAndDamping) know(1);
  if (held == Held::kAll) know(2);
  return dense;
}

/// The largest difference, each element relative to the standard deviations of its row and column.
template <class Scalar>
long double difference(const UdCovariance<Scalar>& ud, const Dense& dense) {
  long double worst = 0;
  for (int j = 0; j < 3; ++j) {
    const Vector3<Scalar> column = ud.column(j);
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const auto col = static_cast<std::size_t>(j);
      const long double unit = std::sqrt(dense.p[row][row] * dense.p[col][col]);
      worst = std::max(worst, std::abs(exact(column(i)) - dense.p[row][col]) / unit);
    }
  }
  return worst;
}

Vector random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  // Magnitudes as the regressor has them: acceleration, rate and angle differ by orders.
  return {20 * static_cast<long double>(normal(random)), 2 * static_cast<long double>(normal(random)),
          0.1L * static_cast<long double>(normal(random))};
}

// Measurements, some with parameters held, and forgetting. Over ten seeds and 1000 steps the difference reaches
// 2.3e-14 in double, 4.2e-6 in float and 6.9e-7 in fixed point: forgetting keeps it from growing but in what is held.
// The limits are ten times that.
template <class Scalar>
void walk_beside_the_dense_matrix(long double tolerance) {
  std::mt19937_64 random(test::seed(3));
  const Vector sd{0.1L, 2.0L, 30.0L};
  UdCovariance<Scalar> ud(narrow<Scalar>(sd));
  Dense dense(sd);
  long double worst = 0;
  for (int step = 0; step < 1000; ++step) {
    // Round the inputs first, so that both sides get the same numbers.
    const Vector3<Scalar> z = narrow<Scalar>(random_vector(random));
    const Vector exact_z = wide(z);
    const auto held = random() % 2 == 0 ? Held::kNone : static_cast<Held>(random() % 4);
    const Dense left = free_part(dense, held);
    for (int i = 0; i < 3; ++i) {
      const Vector column = wide(ud.column(i, held));
      for (std::size_t row = 0; row < 3; ++row) {
        const auto col = static_cast<std::size_t>(i);
        const long double unit = std::sqrt(dense.p[row][row] * dense.p[col][col]);
        ASSERT_LE(std::abs(column[row] - left.p[row][col]), tolerance * unit);
      }
    }
    const long double innovation = 1 + left.along(exact_z);
    const Vector pz = left.times(exact_z);
    const Vector gain{pz[0] / innovation, pz[1] / innovation, pz[2] / innovation};

    Vector3<Scalar> moved(Scalar(0), Scalar(0), Scalar(0));
    const auto correction = ud.observe(z, Scalar(1), held);
    correction.apply(moved);
    ASSERT_LE(std::abs(exact(correction.spread) / innovation - 1), tolerance);
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const long double unit = std::sqrt(dense.p[row][row] / innovation);
      ASSERT_LE(std::abs(exact(moved(i)) - gain[row]), tolerance * unit);
    }
    dense.observe(exact_z, gain);

    const Vector3<Scalar> a = narrow<Scalar>({0.01L * exact_z[2], 0.02L * exact_z[0], 0.5L * exact_z[1]});
    ud.spread(a, rounded<Scalar>(0.25L));
    dense.add(wide(a), 0.25L);
    if (step % 10 == 0) {
      ud.scale(rounded<Scalar>(1.5L));
      dense.scale(1.5L);
    }
    ASSERT_TRUE(ud.positive());
    worst = std::max(worst, difference(ud, dense));
    ASSERT_LE(worst, tolerance) << "after " << step << " steps";
  }
  const Vector variance = wide(ud.variance());
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_NEAR(static_cast<double>(variance[at] / wide(ud.column(i))[at]), 1.0, static_cast<double>(tolerance));
  }
}

TEST(UdCovariance, FollowsTheDenseMatrixInDouble) { walk_beside_the_dense_matrix<double>(2e-13L); }
TEST(UdCovariance, FollowsTheDenseMatrixInFloat) { walk_beside_the_dense_matrix<float>(4e-5L); }
TEST(UdCovariance, FollowsTheDenseMatrixInFixedPoint) { walk_beside_the_dense_matrix<Fixed>(7e-6L); }

// One direction measured a million times, the others never: a matrix in float is indefinite after some hundred of
// these. Here every D stays positive, and what was not measured stays as it was.
TEST(UdCovariance, StaysPositiveWhereAMatrixWouldNot) {
  UdCovariance<float> ud({0.1F, 2.0F, 30.0F});
  const Vector3<float> z(3.0F, 0.3F, 1.0F);
  for (int i = 0; i < 10'000; ++i) static_cast<void>(ud.observe(z, 0.0F));
  // z' P z goes to 1/n: the information adds up. Each step rounds 1 + 1/n by 6e-8, n^2/2 of them make 0.3 %.
  UdCovariance<float> looked_at = ud;
  EXPECT_NEAR((looked_at.observe(z, 0.0F).spread - 1.0F) * 1e4F, 1.0F, 0.003F);
  // The direction with C z_C = -J z_J is invisible; its variance is that of the prior, P - P z z' P / z' P z.
  Dense dense({0.1L, 2.0L, 30.0L});
  const Vector pz = dense.times({3.0L, 0.3L, 1.0L});
  dense.add(pz, -1 / dense.along({3.0L, 0.3L, 1.0L}));
  EXPECT_NEAR(ud.variance()(1) / static_cast<float>(dense.p[1][1]), 1.0F, 1e-3F);
  for (int i = 0; i < 1'000'000; ++i) {
    static_cast<void>(ud.observe(z, 0.0F));
    ASSERT_TRUE(ud.positive());
  }
}

TEST(UdCovariance, ANumberThatIsNoneIsNotPositive) {
  UdCovariance<float> ud({0.1F, 2.0F, 30.0F});
  EXPECT_TRUE(ud.positive());
  ud.scale(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(ud.positive());
}

}  // namespace
}  // namespace steerid
