// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Least squares of one signal on N others, over as many samples as its caller says, solved now and then.
//
//   minimise the mean of (y - c' x)^2:   mean(x x') c = mean(x y)
//
// The means run at every sample; the coefficients are those of the last solve(), by factors L D L' of mean(x x'). A
// ridge of 3e-7 of its trace is added: that is what rounding in float leaves of a mean of products, and without it the
// directions in which x hardly moves would be decided by rounding. Where x does not move at all c is zero.
//
// Cost: push() N (N + 3) / 2 products; solve() some N^3 / 3 + N^2 products and N divisions.
#pragma once

#include <Eigen/Core>

namespace steerid {

template <class Scalar, int N>
class RunningLeastSquares {
 public:
  using Vector = Eigen::Matrix<Scalar, N, 1>;

  /// Takes in y and x; the means are those of about so many samples, 1 and more.
  void push(Scalar y, const Vector& x, Scalar samples) {
    const Scalar share = Scalar(1) / samples;
    for (int i = 0; i < N; ++i) {
      const Scalar weighted = x(i) * share;
      product_(i) += y * weighted - product_(i) * share;
      for (int j = 0; j <= i; ++j) power_(i, j) += x(j) * weighted - power_(i, j) * share;
    }
  }

  /// Works the coefficients out anew.
  [[gnu::noinline]] void solve() {
    coefficient_.setConstant(Scalar(0));
    Scalar trace(0);
    for (int i = 0; i < N; ++i) trace += power_(i, i);
    if (!(trace > Scalar(kSilent))) return;
    const Scalar ridge = trace * Scalar(kRidge);
    Eigen::Matrix<Scalar, N, N> lower;
    Vector diagonal, inverse;
    for (int j = 0; j < N; ++j) {
      Scalar d = power_(j, j) + ridge;
      for (int k = 0; k < j; ++k) d -= lower(j, k) * lower(j, k) * diagonal(k);
      diagonal(j) = d > ridge ? d : ridge;  // rounding may leave less, which there cannot be
      inverse(j) = Scalar(1) / diagonal(j);
      for (int i = j + 1; i < N; ++i) {
        Scalar x = power_(i, j);
        for (int k = 0; k < j; ++k) x -= lower(i, k) * lower(j, k) * diagonal(k);
        lower(i, j) = x * inverse(j);
      }
    }
    Vector x = product_;
    for (int i = 1; i < N; ++i) {
      for (int k = 0; k < i; ++k) x(i) -= lower(i, k) * x(k);
    }
    for (int i = 0; i < N; ++i) x(i) = x(i) * inverse(i);
    for (int i = N - 2; i >= 0; --i) {
      for (int k = i + 1; k < N; ++k) x(i) -= lower(k, i) * x(k);
    }
    coefficient_ = x;
  }

  [[nodiscard]] const Vector& coefficient() const { return coefficient_; }

 private:
  static constexpr double kRidge = 3e-7;
  static constexpr double kSilent = 1e-14;  ///< below the square of the port's resolution nothing moves

  Vector coefficient_ = Vector::Constant(Scalar(0));
  Vector product_ = Vector::Constant(Scalar(0));
  Eigen::Matrix<Scalar, N, N> power_ = Eigen::Matrix<Scalar, N, N>::Constant(Scalar(0));  ///< its lower triangle
};

}  // namespace steerid
