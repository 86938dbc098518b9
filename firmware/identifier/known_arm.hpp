// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The arm that was known last, kept aside for when what comes in does not fit it any more.
//
// A sensor at fault leads the identifier to another arm or to none, but the driver's arm is seldom another one when the
// fault is over. Then the arm of before explains what comes in as well as it did, to the noise, and need not be
// searched for, watched and learned again: that takes five seconds and more, this takes one.
//
// Kept are J, B and C, in 1/65535 of their upper limits, and the standard deviation of the residual, in 0.1 mNm: 9
// bytes for any scalar. An arm is kept at every refresh that finds all three learned and the residual as its variance
// says. One that leaves far more noise than the one kept does not take its place: a fault may have found it. So that a
// sensor that stays worse is got used to, the deviation kept grows by 0.4 % and 0.1 mNm a refresh.
//
// It is asked for from when the residual is no noise (a doubt, a misfit, another arm) until it is taken back or another
// one kept. Every sample then counts 1 for it whose residual by it lies within 2.5 of its deviations, and 4 against it
// otherwise; at 75 it explains what comes in. Noise of the deviation kept gets there in 80 samples, noise of 3.8 times
// its variance (80 % within 2.5 deviations) never. Samples of less torque than 5 deviations do not count: at rest any
// arm explains everything. Its deviation is that behind its own common filter: one that rings, or that an arm found in
// a fault has tuned, leaves more (Identifier::retune).
#pragma once

#include <cstdint>

#include "base/square_root.hpp"
#include "identifier/parameter_sum.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
class KnownArm {
 public:
  /// p with its residual's variance in Nm^2, found sound at a refresh; ends the asking if it is kept.
  void offer(const ParameterSum<Scalar>& p, Scalar variance, const Prior<Scalar>& prior) {
    if (deviation_ > 0 && variance > Scalar(kNoisier) * this->variance()) return;
#pragma GCC unroll 1
    for (int i = 0; i < 3; ++i) share_[i] = nearest(p(i) / prior.highest(i) * Scalar(kSteps));
    // Never less than it is, and held where it would not fit.
    const Scalar deviation = square_root(variance) * Scalar(1 / kDeviationStep) + Scalar(0.5);
    deviation_ = deviation < Scalar(kOldest) ? nearest(deviation) : kOldest;
    tally_ = 0;
  }
  /// At every refresh.
  void age() {
    if (deviation_ > 0 && deviation_ < kOldest)
      deviation_ = static_cast<std::uint16_t>(deviation_ + deviation_ / 256 + 1);
  }

  [[gnu::cold, gnu::noinline]] void ask() {
    if (deviation_ > 0 && tally_ == 0) tally_ = kStart;
  }
  [[nodiscard]] bool asked() const { return tally_ > 0; }
  /// One sample, while it is asked for: the torque and what the arm leaves of it.
  void compare(Scalar torque, Scalar residual) {
    const Scalar least = variance();
    if (torque * torque < Scalar(kTelling * kTelling) * least) return;
    if (residual * residual < Scalar(kWithin * kWithin) * least) {
      ++tally_;
    } else {
      tally_ = tally_ > kStart + kAgainst ? static_cast<std::uint8_t>(tally_ - kAgainst) : kStart;
    }
  }
  [[nodiscard]] bool explains() const { return tally_ >= kStart + kEnough; }
  void taken_back() { tally_ = 0; }

  [[nodiscard, gnu::cold, gnu::noinline]] Vector3<Scalar> value(const Prior<Scalar>& prior) const {
    const auto of = [&](int i) { return Scalar(int{share_[i]}) * prior.highest(i) * Scalar(1 / kSteps); };
    return Vector3<Scalar>(of(0), of(1), of(2));
  }
  /// Of the residual, Nm^2.
  [[nodiscard, gnu::noinline]] Scalar variance() const {
    const Scalar deviation_nm = Scalar(int{deviation_}) * Scalar(kDeviationStep);
    return deviation_nm * deviation_nm;
  }

 private:
  static std::uint16_t nearest(Scalar x) { return static_cast<std::uint16_t>(static_cast<int>(x + Scalar(0.5))); }

  static constexpr double kSteps = 65535;
  static constexpr std::uint16_t kOldest = 65000;
  static constexpr double kDeviationStep = 1e-4;  ///< Nm; up to 6.5 Nm
  static constexpr double kNoisier = 1.5;         ///< times the variance
  static constexpr double kTelling = 5;           ///< deviations
  static constexpr double kWithin = 2.5;          ///< deviations
  static constexpr std::uint8_t kStart = 1;       ///< of the tally; 0 is not asked for
  static constexpr std::uint8_t kAgainst = 4;
  static constexpr std::uint8_t kEnough = 75;

  std::uint16_t share_[3] = {};
  std::uint16_t deviation_ = 0;  ///< 0: none is kept
  std::uint8_t tally_ = 0;
};

}  // namespace steerid
