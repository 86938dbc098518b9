// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What one hypothesis believes of J, B and C: their mean and covariance, and what a measurement makes of it.
//
//   T = phi' p + noise of variance s2;   z: what of phi the noise is not in, the instrument (phi itself, where it is in
//   none)
//
//   e = T - phi' p,  S = s2 + z' P z,  p := p + P z e / S,  P := P - P z z' P / S
//
// recursive instrumental variables in symmetric-gain form (Young 2011, Recursive Estimation and Time-Series Analysis,
// chapter 8). A residual of more than three deviations moves p by no more than one of three (Huber 1964).
//
// Units: p and P in those of J, B, C; T, e in Nm; s2, S in Nm^2. Cost of correct(): some 40 multiplications, 2
// divisions.
#pragma once

#include "base/square_root.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

/// A symmetric matrix of three rows, by its lower triangle: element (r, c) with c <= r. Its place needs no
/// multiplication, for one number that is never used.
template <class Scalar>
struct Symmetric3 {
  Scalar of[7] = {};

  constexpr const Scalar& operator()(int r, int c) const { return of[r + 2 * c]; }
  constexpr Scalar& operator()(int r, int c) { return of[r + 2 * c]; }
};

template <class Scalar>
struct ArmBelief {
  Vector3<Scalar> value = Vector3<Scalar>::Constant(Scalar(0));
  Symmetric3<Scalar> covariance;

  [[nodiscard]] static ArmBelief independent(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation) {
    ArmBelief belief;
    belief.value = value;
    for (int i = 0; i < 3; ++i) belief.covariance(i, i) = deviation(i) * deviation(i);
    return belief;
  }

  /// Element (r, c) of the covariance, either triangle.
  [[nodiscard]] Scalar of(int r, int c) const { return c <= r ? covariance(r, c) : covariance(c, r); }

  /// What is known if with probability `share` it is `other`'s: mean and covariance of the two together.
  void blend(const ArmBelief& other, Scalar share) {
    const Vector3<Scalar> off = other.value - value;
    const Scalar both = share * (Scalar(1) - share);
    value += off * share;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c <= r; ++c) {
        covariance(r, c) += share * (other.covariance(r, c) - covariance(r, c)) + both * off(r) * off(c);
      }
    }
  }

  /// Takes in one measurement with the residual e; returns 1/S. A parameter that is dark, which the motion does not
  /// show, is left alone, and its variance goes on counting in that of the others (the "consider" parameters of Schmidt
  /// 1966).
  Scalar correct(Scalar residual, const Vector3<Scalar>& z, Scalar noise, const bool (&dark)[3] = kAllShown) {
    Vector3<Scalar> pz;
    for (int r = 0; r < 3; ++r) {
      pz(r) = Scalar(0);
      for (int c = 0; c < 3; ++c) pz(r) += of(r, c) * z(c);
    }
    const Scalar unknown = z.dot(pz);
    const Scalar gain = Scalar(1) / (unknown > Scalar(0) ? noise + unknown : noise);  // rounding may leave less
    const Scalar square = residual * residual * gain;
    if (square > Scalar(kWild)) residual = residual * square_root(Scalar(kWild) / square);
    for (int r = 0; r < 3; ++r) {
      if (!dark[r]) value(r) += pz(r) * (gain * residual);
      for (int c = 0; c <= r; ++c) {
        if (!(dark[r] && dark[c])) covariance(r, c) -= pz(r) * pz(c) * gain;
      }
    }
    return gain;
  }

  /// Counts what was learned so far by another variance of the noise: `by` times that of before, near 1. Of the
  /// information P^-1 all but the prior's P0^-1 was learned; to first order in 1 - by that is
  ///
  ///   P := P - (1 - by) (P - P P0^-1 P)
  ///
  /// and leaves alone what the data have not shown.
  void recount(Scalar by, const Prior<Scalar>& prior) {
    Vector3<Scalar> of_prior;
    for (int i = 0; i < 3; ++i) of_prior(i) = Scalar(1) / (prior.spread(i) * prior.spread(i));
    const ArmBelief before = *this;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c <= r; ++c) {
        Scalar unlearned(0);
        for (int k = 0; k < 3; ++k) unlearned += before.of(r, k) * of_prior(k) * before.of(k, c);
        covariance(r, c) += (by - Scalar(1)) * (before.covariance(r, c) - unlearned);
      }
    }
  }

  /// Inside the limits of values and of what may be unknown; a variance that rounding lost is the prior's again.
  void hold(const Prior<Scalar>& prior) {
    for (int i = 0; i < 3; ++i) {
      if (value(i) < prior.lowest(i)) value(i) = prior.lowest(i);
      if (value(i) > prior.highest(i)) value(i) = prior.highest(i);
      const Scalar widest = prior.spread(i) * prior.spread(i) * Scalar(kWidest);
      Scalar& variance = covariance(i, i);
      if (variance > Scalar(0) && variance <= widest) continue;
      const Scalar shrink = variance > widest ? square_root(widest / variance) : Scalar(0);
      for (int k = 0; k < 3; ++k) {
        if (k != i) covariance(k > i ? k : i, k > i ? i : k) *= shrink;
      }
      variance = widest;
    }
  }

 private:
  static constexpr bool kAllShown[3] = {};
  static constexpr double kWild = 9;    ///< square of a residual over S: three deviations
  static constexpr double kWidest = 4;  ///< times the prior's variance: no arm is known less than that
};

}  // namespace steerid
