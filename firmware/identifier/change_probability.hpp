// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probability that the arm is not what is known of it any more: a hidden Markov chain of two states, known and
// changed (Rabiner 1989, Proc. IEEE 77; the forward recursion).
//
//   P := L_c q / (L_c q + L_k (1 - q)),   q = P + a (1 - P) - b P
//
// with the likelihoods L_c and L_k of a look under either. The rates a and b, of a change and of what is known being
// right again, are what is believed before any data: an arm that changes every 100 s, and is known again after 5. They
// are set by hand; what other rates do is in docs/adr/0005.
#pragma once

#include "base/exponential.hpp"

namespace steerid {

template <class Scalar>
class ChangeProbability {
 public:
  /// One look; evidence = ln(L_c / L_k), counted within +-kMostEvidence; the rates per look.
  void take(Scalar evidence, Scalar a_change, Scalar a_return) {
    if (evidence > Scalar(kMostEvidence)) evidence = Scalar(kMostEvidence);
    if (evidence < Scalar(-kMostEvidence)) evidence = Scalar(-kMostEvidence);
    const Scalar other = changed_ + a_change * (Scalar(1) - changed_) - a_return * changed_;
    const bool speaks_for_it = evidence > Scalar(0);
    const Scalar less = exponential_of_minus(speaks_for_it ? evidence : Scalar(0) - evidence);
    const Scalar changed = speaks_for_it ? other : other * less;
    const Scalar known = speaks_for_it ? (Scalar(1) - other) * less : Scalar(1) - other;
    changed_ = changed / (changed + known);
  }
  void reset() { changed_ = Scalar(0); }

  [[nodiscard]] Scalar changed() const { return changed_; }

  static constexpr double kMostEvidence = 6;  ///< e^6 = 400: no one look decides

 private:
  Scalar changed_{0};
};

}  // namespace steerid
