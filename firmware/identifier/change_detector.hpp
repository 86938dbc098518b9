// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Notices that the driver's arm is suddenly another one (a second hand, a braced arm, a hand taken off).
//
// While the parameters hold, the innovation's square over its predicted variance averages 1. Its running mean over 16
// samples has a standard deviation of 0.25 then; the alarm at 8 is 28 of them away, so that noise alone never rings it,
// while a doubled stiffness under a 1.5 Nm probe passes it within a few samples. A torque that no sensor sees passes it
// as well. It is a tenth of the torque applied, or little more; an arm that is another one leaves several tenths
// unexplained. So what is not explained must also be a good part of the torque, both as the colour filter leaves them.
//
// A torque that jumps, measured or not, passes a deep colour filter whole, where hardly anything is left of one that
// goes on. Where much slow torque is known to be unmeasured, what is not explained must stand out against its power.
#pragma once

namespace steerid {

template <class Scalar>
class ChangeDetector {
 public:
  /// Takes in e^2 / var(e), e^2, the mean square of the torque lately, filtered as e is, and the power of the slow
  /// torque that no sensor sees; true when the parameters cannot be the old ones any more.
  bool surprised(Scalar normalised_square, Scalar square, Scalar torque_square, Scalar slow_power) {
    if (normalised_square > Scalar(kClip)) normalised_square = Scalar(kClip);
    mean_ += (normalised_square - mean_) * Scalar(1.0 / 16.0);
    unexplained_ += (square - unexplained_) * Scalar(1.0 / 16.0);
    return suspicious() && unexplained_ > Scalar(kShare) * torque_square + Scalar(kJump) * slow_power;
  }
  /// Whether there is more than noise, be it another arm or not.
  [[nodiscard]] bool suspicious() const { return mean_ > Scalar(kAlarm); }
  void reset() { *this = ChangeDetector(); }

 private:
  static constexpr double kClip = 30.0;  ///< so that it takes five wild samples: 30 (1 - (15/16)^4) is below the alarm
  static constexpr double kAlarm = 8.0;
  static constexpr double kShare = 0.3;  ///< of the torque's power: 0.55 of its rms
  /// Of the slow torque's power: what a jump of 2.5 times its rms leaves over 16 samples behind a whitening filter of
  /// depth 0.92 and the average arm's common filter, 0.011 of its square. Of a deeper whitening filter less is left.
  static constexpr double kJump = 0.07;
  Scalar mean_{1};
  Scalar unexplained_{0};
};

}  // namespace steerid
