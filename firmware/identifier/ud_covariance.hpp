// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

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
// covariance of the parameters. Cost: `observe` with its three corrections 26 multiplications, 15 additions, 3
// divisions; `spread` 21 multiplications, 9 additions, 2 divisions. Inside it computes with a KernelNumber.
#pragma once

#include "base/kernel_number.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

/// The parameters that a measurement must leave alone, because what it seems to say of them is noise. Their variance
/// stays, and goes on counting in that of the others (the "consider" parameters of Schmidt 1966).
enum class Held : unsigned char { kNone, kInertiaOnly, kInertiaAndDamping, kAll };

/// Whether the parameter is one of them.
[[nodiscard]] constexpr bool holds(Held held, int parameter) { return held >= static_cast<Held>(parameter + 1); }

template <class Scalar>
class UdCovariance {
 public:
  /// What a kernel over Scalar computes with.
  using Number = KernelNumber<Scalar>;

  /// What one measurement has to say: residual P z / (1 + z' P z), and 1 + z' P z.
  struct Correction {
    Number inertia{};
    decltype(Number{} + Number{}) damping{};
    Number stiffness{};
    Number spread{};

    void apply(Vector3<Scalar>& p) const {
      p(kInertia) = Scalar(rounded_sum(Number(p(kInertia)), inertia));
      p(kDamping) = Scalar(rounded_sum(Number(p(kDamping)), damping));
      p(kStiffness) = Scalar(rounded_sum(Number(p(kStiffness)), stiffness));
    }
  };

  explicit UdCovariance(const Vector3<Scalar>& standard_deviation)
      : d0_(squared(standard_deviation(kStiffness))),
        d1_(squared(standard_deviation(kDamping))),
        d2_(squared(standard_deviation(kInertia))) {}

  /// Takes in one measurement with regressor z and noise variance 1: P := P - P z z' P / (1 + z' P z), and says what it
  /// makes of its residual, by the P of before. The held parameters are neither moved nor better known by it; what of z
  /// is theirs is noise to the others, which go with them as far as they were moved instead.
  [[gnu::always_inline]] Correction observe(const Vector3<Scalar>& z, Scalar residual, Held held = Held::kNone) {
    const Number one(Scalar(1));
    if (held == Held::kAll) return {.spread = one};
    const Number z0(z(kStiffness));
    const Number z1(z(kDamping));
    const Number z2(z(kInertia));
    const Number e(residual);
    // f = U' z, v = D f. alpha_j = 1 + sum over i <= j of f_i v_i, the innovation's variance as the columns come in.
    const Number v0 = d0_ * z0;
    const Number alpha0 = tight_positive(one + z0 * v0);
    const Number share0 = reciprocal_of(alpha0);
    d0_ = tight_positive(d0_ * share0);

    const Number f1 = tight(z1 + u01_ * z0);
    const Number f2 = tight(z2 + (u02_ * z0 + u12_ * z1));
    const Number u01 = u01_;
    u01_ = tight(u01 - f1 * share0 * v0);
    if (held == Held::kInertiaAndDamping) {
      u02_ = tight(u02_ - f2 * share0 * v0);
      return {.stiffness = v0 * (share0 * e), .spread = alpha0};
    }
    const Number v1 = d1_ * f1;
    const Number alpha1 = tight_positive(alpha0 + f1 * v1);
    const Number share1 = reciprocal_of(alpha1);
    d1_ = tight_positive(d1_ * (alpha0 * share1));

    // U v over the columns so far: the gain times alpha.
    const auto k0 = v0 + u01 * v1;
    const Number lambda2 = f2 * share1;
    const Number u02 = u02_;
    const Number u12 = u12_;
    u02_ = tight(u02 - lambda2 * k0);
    u12_ = tight(u12 - lambda2 * v1);
    if (held == Held::kInertiaOnly) {
      const Number step = share1 * e;
      return {.damping = v1 * step, .stiffness = tight(k0 * step), .spread = alpha1};
    }
    const Number v2 = d2_ * f2;
    const Number alpha2 = tight_positive(alpha1 + f2 * v2);
    const Number share2 = reciprocal_of(alpha2);
    d2_ = tight_positive(d2_ * (alpha1 * share2));

    const Number step = share2 * e;
    return {v2 * step, (v1 + u12 * v2) * step, tight((k0 + u02 * v2) * step), alpha2};
  }

  /// P := P + weight a a', weight >= 0: uncertainty comes back along a.
  void spread(const Vector3<Scalar>& a, Scalar weight) {
    const Number a2(a(kInertia));
    const Number weight2(weight);
    const Number wa2 = weight2 * a2;
    const Number d2 = tight_positive(d2_ + wa2 * a2);
    const Number share2 = reciprocal_of(d2);
    const Number a1 = tight(Number(a(kDamping)) - a2 * u12_);
    const auto a02 = Number(a(kStiffness)) - a2 * u02_;
    const Number beta2 = wa2 * share2;
    u02_ = tight(u02_ + beta2 * a02);
    u12_ = tight(u12_ + beta2 * a1);
    const Number weight1 = weight2 * (d2_ * share2);
    d2_ = d2;

    const Number wa1 = weight1 * a1;
    const Number d1 = tight_positive(d1_ + wa1 * a1);
    const Number share1 = reciprocal_of(d1);
    const Number a0 = tight(a02 - a1 * u01_);
    u01_ = tight(u01_ + wa1 * share1 * a0);
    const Number weight0 = weight1 * (d1_ * share1);
    d1_ = d1;
    d0_ = tight_positive(d0_ + weight0 * a0 * a0);
  }

  /// P := factor P, factor > 0, but for the held parameters' own variance.
  void scale(Scalar factor, Held held = Held::kNone) {
    const Number by(factor);
    d0_ = tight_positive(d0_ * by);
    if (!holds(held, kDamping)) d1_ = tight_positive(d1_ * by);
    if (!holds(held, kInertia)) d2_ = tight_positive(d2_ * by);
  }

  /// What is not known of each parameter once those before it in the order J, B, C are, times its factor > 0.
  void scale_each(const Vector3<Scalar>& factor) {
    d0_ = tight_positive(d0_ * Number(factor(kStiffness)));
    d1_ = tight_positive(d1_ * Number(factor(kDamping)));
    d2_ = tight_positive(d2_ * Number(factor(kInertia)));
  }

  /// The held parameters' own variance, times factor > 0.
  void scale_held(Scalar factor, Held held) {
    const Number by(factor);
    if (holds(held, kStiffness)) d0_ = tight_positive(d0_ * by);
    if (holds(held, kDamping)) d1_ = tight_positive(d1_ * by);
    if (holds(held, kInertia)) d2_ = tight_positive(d2_ * by);
  }

  /// Diagonal of P.
  [[nodiscard]] Vector3<Scalar> variance() const {
    return Vector3<Scalar>(Scalar(d2_), Scalar(d1_ + u12_ * u12_ * d2_),
                           Scalar(d0_ + u01_ * u01_ * d1_ + u02_ * u02_ * d2_));
  }

  /// Column i of P, of what is left of it once the held parameters are known.
  [[nodiscard, gnu::noinline]] Vector3<Scalar> column(int i, Held held = Held::kNone) const {
    // Row i of U, in the order C, B, J; what is held has no part in it.
    const Number none{};
    const Number one(Scalar(1));
    const Number row0 = i == kStiffness && !holds(held, kStiffness) ? one : none;
    Number row1 = i == kStiffness ? u01_ : i == kDamping ? one : none;
    Number row2 = i == kStiffness ? u02_ : i == kDamping ? u12_ : one;
    if (holds(held, kInertia)) row2 = none;
    if (holds(held, kDamping)) row1 = none;
    const Number v1 = d1_ * row1;
    const Number v2 = d2_ * row2;
    return Vector3<Scalar>(Scalar(v2), Scalar(v1 + u12_ * v2), Scalar(d0_ * row0 + (u01_ * v1 + u02_ * v2)));
  }

  /// The smallest D.
  [[nodiscard]] Scalar least() const { return Vector3<Scalar>(Scalar(d0_), Scalar(d1_), Scalar(d2_)).minCoeff(); }

  /// The invariant: every D positive (and therefore a number).
  [[nodiscard]] bool positive() const {
    const auto above_zero = [](Number d) { return Scalar(d) > Scalar(0); };
    return above_zero(d0_) && above_zero(d1_) && above_zero(d2_);
  }

 private:
  static Number squared(Scalar x) { return tight_positive(Number(x) * Number(x)); }

  Number d0_, d1_, d2_;  ///< of C, B, J
  Number u01_{};         ///< how C goes with B,
  Number u02_{};         ///< C with J
  Number u12_{};         ///< and B with J
};

}  // namespace steerid
