// A 3 x 3 covariance kept as P = U D U', U unit upper triangular, D diagonal and positive.
//
// Rounding can make a covariance indefinite when it is kept as a matrix; kept as U and D it stays positive as long as
// every D stays positive, which is three numbers to look at. Measurement update: Bierman (1977), Factorization Methods
// for Discrete Sequential Estimation, section V.3. Adding a rank-one term: Agee and Turner (1972).
//
// Units: the covariance is relative to a measurement noise of variance 1; multiply by the noise variance to get the
// covariance of the parameters. Cost, for Scalar = float: `observe` 23 multiplications, 6 divisions; `spread`
// 20 multiplications, 3 divisions.
#pragma once

#include <Eigen/Core>

#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
class UdCovariance {
 public:
  explicit UdCovariance(const Vector3<Scalar>& standard_deviation)
      : d_(standard_deviation.cwiseProduct(standard_deviation)) {}

  /// P z, without changing anything.
  [[nodiscard]] Vector3<Scalar> times(const Vector3<Scalar>& z) const {
    const Vector3<Scalar> f = transposed_times(z);
    return unit_times(d_.cwiseProduct(f));
  }

  /// z' P z, the variance of the prediction along z.
  [[nodiscard]] Scalar along(const Vector3<Scalar>& z) const {
    const Vector3<Scalar> f = transposed_times(z);
    return f.cwiseProduct(f).dot(d_);
  }

  /// Takes in one measurement with regressor z and noise variance 1: P := P - P z z' P / (1 + z' P z).
  /// Returns the gain P z / (1 + z' P z), with the P of before.
  Vector3<Scalar> observe(const Vector3<Scalar>& z) {
    const Vector3<Scalar> f = transposed_times(z);
    const Vector3<Scalar> v = d_.cwiseProduct(f);
    // alpha_j = 1 + sum over i <= j of f_i v_i, the innovation's variance as the columns come in.
    const Scalar alpha0 = Scalar(1) + f(0) * v(0);
    const Scalar alpha1 = alpha0 + f(1) * v(1);
    const Scalar alpha2 = alpha1 + f(2) * v(2);
    d_(0) = d_(0) / alpha0;
    d_(1) = d_(1) * (alpha0 / alpha1);
    d_(2) = d_(2) * (alpha1 / alpha2);

    const Scalar lambda1 = -f(1) / alpha0;
    const Scalar lambda2 = -f(2) / alpha1;
    const Scalar u01 = u01_;
    const Scalar u02 = u02_;
    const Scalar u12 = u12_;
    // Unnormalised gain so far, k = U v over the columns already taken in.
    const Scalar k0 = v(0);
    u01_ = u01 + lambda1 * k0;
    const Scalar k0_1 = k0 + u01 * v(1);
    const Scalar k1_1 = v(1);
    u02_ = u02 + lambda2 * k0_1;
    u12_ = u12 + lambda2 * k1_1;
    const Scalar scale = Scalar(1) / alpha2;
    return Vector3<Scalar>((k0_1 + u02 * v(2)) * scale, (k1_1 + u12 * v(2)) * scale, v(2) * scale);
  }

  /// P := P + weight a a', weight >= 0: uncertainty comes back along a.
  void spread(Vector3<Scalar> a, Scalar weight) {
    const Scalar d2 = d_(2) + weight * a(2) * a(2);
    const Scalar beta2 = weight * a(2) / d2;
    const Scalar weight1 = weight * (d_(2) / d2);
    a(0) -= a(2) * u02_;
    a(1) -= a(2) * u12_;
    u02_ += beta2 * a(0);
    u12_ += beta2 * a(1);
    d_(2) = d2;

    const Scalar d1 = d_(1) + weight1 * a(1) * a(1);
    const Scalar beta1 = weight1 * a(1) / d1;
    const Scalar weight0 = weight1 * (d_(1) / d1);
    a(0) -= a(1) * u01_;
    u01_ += beta1 * a(0);
    d_(1) = d1;
    d_(0) += weight0 * a(0) * a(0);
  }

  /// P := factor P, factor > 0.
  void scale(Scalar factor) { d_ *= factor; }

  /// Diagonal of P.
  [[nodiscard]] Vector3<Scalar> variance() const {
    return Vector3<Scalar>(d_(0) + u01_ * u01_ * d_(1) + u02_ * u02_ * d_(2), d_(1) + u12_ * u12_ * d_(2), d_(2));
  }

  /// Column i of P.
  [[nodiscard]] Vector3<Scalar> column(int i) const { return times(Vector3<Scalar>::Unit(i)); }

  /// The invariant: every D positive (and therefore a number).
  [[nodiscard]] bool positive() const { return d_(0) > Scalar(0) && d_(1) > Scalar(0) && d_(2) > Scalar(0); }

 private:
  [[nodiscard]] Vector3<Scalar> transposed_times(const Vector3<Scalar>& z) const {
    return Vector3<Scalar>(z(0), z(1) + u01_ * z(0), z(2) + u02_ * z(0) + u12_ * z(1));
  }
  [[nodiscard]] Vector3<Scalar> unit_times(const Vector3<Scalar>& v) const {
    return Vector3<Scalar>(v(0) + u01_ * v(1) + u02_ * v(2), v(1) + u12_ * v(2), v(2));
  }

  Vector3<Scalar> d_;
  Scalar u01_{0};
  Scalar u02_{0};
  Scalar u12_{0};
};

}  // namespace steerid
