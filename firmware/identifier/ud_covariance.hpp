// A 3 x 3 covariance kept as P = U D U', U unit upper triangular, D diagonal and positive.
//
// Rounding can make a covariance indefinite when it is kept as a matrix; kept as U and D it stays positive as long as
// every D stays positive, which is three numbers to look at. Measurement update: Bierman (1977), Factorization Methods
// for Discrete Sequential Estimation, section V.3. Adding a rank-one term: Agee and Turner (1972).
//
// Inside, the parameters stand in the order C, B, J: each D is then the variance of a parameter once those after it are
// known, so that what J and B have left to tell can be kept apart from what the motion shows of C (`Held`).
//
// Units: the covariance is relative to a measurement noise of variance 1; multiply by the noise variance to get the
// covariance of the parameters. Cost, for Scalar = float: `observe` 23 multiplications, 6 divisions; `spread`
// 20 multiplications, 3 divisions.
#pragma once

#include <Eigen/Core>

#include "identifier/parameters.hpp"

namespace steerid {

/// The parameters that a measurement must leave alone, because what it seems to say of them is noise. Their variance
/// stays, and goes on counting in that of the others (the "consider" parameters of Schmidt 1966).
enum class Held : unsigned char { kNone, kInertiaOnly, kInertiaAndDamping, kAll };

template <class Scalar>
class UdCovariance {
 public:
  explicit UdCovariance(const Vector3<Scalar>& standard_deviation)
      : d_(standard_deviation.cwiseProduct(standard_deviation).reverse()) {}

  /// P z, without changing anything; what is left of it once the held parameters are known.
  [[nodiscard]] Vector3<Scalar> times(const Vector3<Scalar>& z, Held held = Held::kNone) const {
    return unit_times(d_.cwiseProduct(free_part(transposed_times(z), held))).reverse();
  }

  /// z' P z, the variance of the prediction along z.
  [[nodiscard]] Scalar along(const Vector3<Scalar>& z, Held held = Held::kNone) const {
    const Vector3<Scalar> f = free_part(transposed_times(z), held);
    return f.cwiseProduct(f).dot(d_);
  }

  /// Takes in one measurement with regressor z and noise variance 1: P := P - P z z' P / (1 + z' P z).
  /// Returns the gain P z / (1 + z' P z), with the P of before; both for the parameters that are not held alone.
  Vector3<Scalar> observe(const Vector3<Scalar>& z, Held held = Held::kNone) {
    if (held == Held::kAll) return Vector3<Scalar>::Zero();
    const Vector3<Scalar> before = d_;
    Vector3<Scalar> gain = observe_all(z);
    if (held >= Held::kInertiaOnly) {
      gain -= Vector3<Scalar>(u02_, u12_, Scalar(1)) * gain(2);
      d_(2) = before(2);
    }
    if (held >= Held::kInertiaAndDamping) {
      gain -= Vector3<Scalar>(u01_, Scalar(1), Scalar(0)) * gain(1);
      d_(1) = before(1);
    }
    return gain.reverse();
  }

  /// P := P + weight a a', weight >= 0: uncertainty comes back along a.
  void spread(const Vector3<Scalar>& a, Scalar weight) { spread_inside(a.reverse(), weight); }

  /// P := factor P, factor > 0, but for the held parameters' own variance.
  void scale(Scalar factor, Held held = Held::kNone) {
    d_(0) *= factor;
    if (held <= Held::kInertiaOnly) d_(1) *= factor;
    if (held == Held::kNone) d_(2) *= factor;
  }

  /// Diagonal of P.
  [[nodiscard]] Vector3<Scalar> variance() const {
    return Vector3<Scalar>(d_(2), d_(1) + u12_ * u12_ * d_(2), d_(0) + u01_ * u01_ * d_(1) + u02_ * u02_ * d_(2));
  }

  /// Column i of P, of what is left of it once the held parameters are known.
  [[nodiscard]] Vector3<Scalar> column(int i, Held held = Held::kNone) const {
    return times(Vector3<Scalar>::Unit(i), held);
  }

  /// The smallest D.
  [[nodiscard]] Scalar least() const { return d_.minCoeff(); }

  /// The invariant: every D positive (and therefore a number).
  [[nodiscard]] bool positive() const { return d_(0) > Scalar(0) && d_(1) > Scalar(0) && d_(2) > Scalar(0); }

 private:
  static Vector3<Scalar> free_part(Vector3<Scalar> f, Held held) {
    if (held >= Held::kInertiaOnly) f(2) = Scalar(0);
    if (held >= Held::kInertiaAndDamping) f(1) = Scalar(0);
    if (held == Held::kAll) f(0) = Scalar(0);
    return f;
  }

  Vector3<Scalar> observe_all(const Vector3<Scalar>& z) {
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

  void spread_inside(Vector3<Scalar> a, Scalar weight) {
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

  /// U' z, in the order C, B, J.
  [[nodiscard]] Vector3<Scalar> transposed_times(const Vector3<Scalar>& z) const {
    return Vector3<Scalar>(z(2), z(1) + u01_ * z(2), z(0) + u02_ * z(2) + u12_ * z(1));
  }
  /// U v, v and the result in the order C, B, J.
  [[nodiscard]] Vector3<Scalar> unit_times(const Vector3<Scalar>& v) const {
    return Vector3<Scalar>(v(0) + u01_ * v(1) + u02_ * v(2), v(1) + u12_ * v(2), v(2));
  }

  Vector3<Scalar> d_;  ///< of C, B, J
  Scalar u01_{0};      ///< how C goes with B,
  Scalar u02_{0};      ///< C with J
  Scalar u12_{0};      ///< and B with J
};

}  // namespace steerid
