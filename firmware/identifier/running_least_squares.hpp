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
// Of mean(x x') the lower triangle is kept, row by row. All N are solved by one function, which is told N when it runs:
// its loops would take half a kilobyte of flash for each.
//
// Cost: push() N (N + 3) / 2 products; solve() some N^3 / 3 + N^2 products and N divisions.
#pragma once

#include <Eigen/Core>

namespace steerid {

inline constexpr int kMostRegressors = 6;

/// Where element (i, j) of a symmetric matrix stands in its lower triangle, j <= i.
constexpr int in_triangle(int i, int j) { return i * (i + 1) / 2 + j; }

/// Works the n coefficients out, n at most kMostRegressors; `power` is the lower triangle of mean(x x').
template <class Scalar>
[[gnu::noinline]] void solve_least_squares(int n, const Scalar* power, const Scalar* product, Scalar* coefficient) {
  constexpr double kRidge = 3e-7;
  constexpr double kSilent = 1e-14;  // below the square of the port's resolution nothing moves
  Scalar trace(0);
  for (int i = 0; i < n; ++i) {
    coefficient[i] = Scalar(0);
    trace += power[in_triangle(i, i)];
  }
  if (!(trace > Scalar(kSilent))) return;
  const Scalar ridge = trace * Scalar(kRidge);
  Scalar lower[in_triangle(kMostRegressors, 0)];
  Scalar diagonal[kMostRegressors];
  Scalar inverse[kMostRegressors];
  for (int j = 0; j < n; ++j) {
    Scalar d = power[in_triangle(j, j)] + ridge;
    for (int k = 0; k < j; ++k) d -= lower[in_triangle(j, k)] * lower[in_triangle(j, k)] * diagonal[k];
    diagonal[j] = d > ridge ? d : ridge;  // rounding may leave less, which there cannot be
    inverse[j] = Scalar(1) / diagonal[j];
    for (int i = j + 1; i < n; ++i) {
      Scalar x = power[in_triangle(i, j)];
      for (int k = 0; k < j; ++k) x -= lower[in_triangle(i, k)] * lower[in_triangle(j, k)] * diagonal[k];
      lower[in_triangle(i, j)] = x * inverse[j];
    }
  }
  for (int i = 0; i < n; ++i) {
    Scalar x = product[i];
    for (int k = 0; k < i; ++k) x -= lower[in_triangle(i, k)] * coefficient[k];
    coefficient[i] = x;
  }
  for (int i = n - 1; i >= 0; --i) {
    Scalar x = coefficient[i] * inverse[i];
    for (int k = i + 1; k < n; ++k) x -= lower[in_triangle(k, i)] * coefficient[k];
    coefficient[i] = x;
  }
}

template <class Scalar, int N>
class RunningLeastSquares {
 public:
  static_assert(N <= kMostRegressors);
  using Vector = Eigen::Matrix<Scalar, N, 1>;

  /// Takes in y and x; the means are those of about so many samples, 1 and more.
  void push(Scalar y, const Vector& x, Scalar samples) {
    const Scalar share = Scalar(1) / samples;
    Scalar* power = power_;
    for (int i = 0; i < N; ++i) {
      const Scalar weighted = x(i) * share;
      product_(i) += y * weighted - product_(i) * share;
      for (int j = 0; j <= i; ++j, ++power) *power += x(j) * weighted - *power * share;
    }
  }

  /// Works the coefficients out anew.
  void solve() { solve_least_squares(N, power_, product_.data(), coefficient_.data()); }

  [[nodiscard]] const Vector& coefficient() const { return coefficient_; }

 private:
  Vector coefficient_ = Vector::Constant(Scalar(0));
  Vector product_ = Vector::Constant(Scalar(0));
  Scalar power_[in_triangle(N, 0)] = {};  ///< lower triangle
};

}  // namespace steerid
