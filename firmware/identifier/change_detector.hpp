// Notices that the driver's arm is suddenly another one (a second hand, a braced arm, a hand taken off).
//
// While the parameters hold, the innovation's square over its predicted variance averages 1. Its running mean over 16
// samples has a standard deviation of 0.25 then; the alarm at 8 is 28 of them away, so that noise alone never rings it,
// while a doubled stiffness under a 1.5 Nm probe passes it within a few samples. A torque that no sensor sees passes it
// as well. It is a tenth of the torque applied, or little more; an arm that is another one leaves several tenths
// unexplained. So what is not explained must also be a good part of the torque, both as the colour filter leaves them.
#pragma once

namespace steerid {

template <class Scalar>
class ChangeDetector {
 public:
  /// Takes in e^2 / var(e), e^2 and the mean square of the torque lately, filtered as e is; true when the parameters
  /// cannot be the old ones any more.
  bool surprised(Scalar normalised_square, Scalar square, Scalar torque_square) {
    if (normalised_square > Scalar(kClip)) normalised_square = Scalar(kClip);
    mean_ += (normalised_square - mean_) * Scalar(1.0 / 16.0);
    unexplained_ += (square - unexplained_) * Scalar(1.0 / 16.0);
    return mean_ > Scalar(kAlarm) && unexplained_ > Scalar(kShare) * torque_square;
  }
  void reset() { *this = ChangeDetector(); }

 private:
  static constexpr double kClip = 50.0;  ///< so that one wild sample cannot ring alone: 50 / 16 is below the alarm
  static constexpr double kAlarm = 8.0;
  static constexpr double kShare = 0.4;  ///< of the torque's power: six tenths of its rms
  Scalar mean_{1};
  Scalar unexplained_{0};
};

}  // namespace steerid
