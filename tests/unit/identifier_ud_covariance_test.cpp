// The factors U D U' against the matrix they stand for, kept in long double by textbook algebra.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

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
Vector3<Scalar> narrow(const Vector& v) {
  return {static_cast<Scalar>(v[0]), static_cast<Scalar>(v[1]), static_cast<Scalar>(v[2])};
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
      worst = std::max(worst, std::abs(static_cast<long double>(column(i)) - dense.p[row][col]) / unit);
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

// Over ten seeds and 1000 steps the difference just passes 1e-15 in double and 5e-7 in float, a few units in the last
// place: forgetting keeps it from growing. The limits are ten times that.
template <class Scalar>
Vector wide(const Vector3<Scalar>& x) {
  return {static_cast<long double>(x(0)), static_cast<long double>(x(1)), static_cast<long double>(x(2))};
}

template <class Scalar>
void walk_beside_the_dense_matrix(long double tolerance) {
  std::mt19937_64 random(test::seed(3));
  const Vector sd{0.1L, 2.0L, 30.0L};
  UdCovariance<Scalar> ud(narrow<Scalar>(sd));
  Dense dense(sd);
  for (int step = 0; step < 1000; ++step) {
    // Round the inputs first, so that both sides get the same numbers.
    const Vector3<Scalar> z = narrow<Scalar>(random_vector(random));
    const Vector exact_z = wide(z);
    const long double innovation = 1 + dense.along(exact_z);
    const Vector pz = dense.times(exact_z);
    ASSERT_NEAR(static_cast<double>(static_cast<long double>(ud.along(z)) / (innovation - 1)), 1.0,
                static_cast<double>(tolerance));
    const Vector3<Scalar> gain = ud.observe(z);
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const long double unit = std::sqrt(dense.p[row][row] / innovation);
      ASSERT_LE(std::abs(static_cast<long double>(gain(i)) - pz[row] / innovation), tolerance * unit);
    }
    dense.observe(exact_z, {pz[0] / innovation, pz[1] / innovation, pz[2] / innovation});

    const Vector3<Scalar> a = narrow<Scalar>({0.01L * exact_z[2], 0.02L * exact_z[0], 0.5L * exact_z[1]});
    const auto weight = static_cast<Scalar>(0.25);
    ud.spread(a, weight);
    dense.add(wide(a), 0.25L);
    if (step % 10 == 0) {
      ud.scale(static_cast<Scalar>(1.5));
      dense.scale(1.5L);
    }
    ASSERT_TRUE(ud.positive());
    ASSERT_LE(difference(ud, dense), tolerance) << "after " << step << " steps";
  }
  const Vector3<Scalar> variance = ud.variance();
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(variance(i) / ud.column(i)(i), Scalar(1), 8 * std::numeric_limits<Scalar>::epsilon());
}

TEST(UdCovariance, FollowsTheDenseMatrixInDouble) { walk_beside_the_dense_matrix<double>(1e-14L); }
TEST(UdCovariance, FollowsTheDenseMatrixInFloat) { walk_beside_the_dense_matrix<float>(5e-6L); }

// One direction measured a million times, the others never: a matrix in float is indefinite after some hundred of
// these. Here every D stays positive, and what was not measured stays as it was.
TEST(UdCovariance, StaysPositiveWhereAMatrixWouldNot) {
  UdCovariance<float> ud({0.1F, 2.0F, 30.0F});
  const Vector3<float> z(3.0F, 0.3F, 1.0F);
  for (int i = 0; i < 10'000; ++i) static_cast<void>(ud.observe(z));
  // z' P z goes to 1/n: the information adds up. Each step rounds 1 + 1/n by 6e-8, n^2/2 of them make 0.3 %.
  EXPECT_NEAR(ud.along(z) * 1e4F, 1.0F, 0.003F);
  // The direction with C z_C = -J z_J is invisible; its variance is that of the prior, P - P z z' P / z' P z.
  Dense dense({0.1L, 2.0L, 30.0L});
  const Vector pz = dense.times({3.0L, 0.3L, 1.0L});
  dense.add(pz, -1 / dense.along({3.0L, 0.3L, 1.0L}));
  EXPECT_NEAR(ud.variance()(1) / static_cast<float>(dense.p[1][1]), 1.0F, 1e-3F);
  for (int i = 0; i < 1'000'000; ++i) {
    static_cast<void>(ud.observe(z));
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
