// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What may be wrong with a simulation, in the form that a quick fit takes: on the measured motion.
//
// A hypothesis is a wheel plus one effect of the vocabulary (or none). The free run of a wheel with an effect is
// slow to repeat a thousand times. Two shortcuts make it linear algebra on a few hundred Fourier lines, good enough to
// find the effect's parameters and to sort out what is far from fitting; what survives is fitted by free runs
// (gap/model/simulated_model.hpp):
//   - effects that are linear (delay, lag, reflex, compliance) change the response H from torque to recorded angle;
//   - all others are a torque, the plant's own, worked out on the measured motion rather than on the simulated one.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include "gap/hypotheses/measured_motion.hpp"
#include "log/record.hpp"
#include "plant/effects/effect.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

using Complex = std::complex<double>;

/// The linear wheel's response, angle over torque.
[[nodiscard]] inline Complex wheel_response(const WheelArm& wheel, double w) {
  return 1.0 / Complex(wheel.stiffness_nm_per_rad - wheel.inertia_kgm2 * w * w, wheel.damping_nms_per_rad * w);
}

/// A wheel without a spring has no response at zero frequency: with one far below what a record can show it has.
[[nodiscard]] inline WheelArm with_a_spring(WheelArm wheel) {
  constexpr double kLeast_per_s2 = 1e-3;  // C/J: a swing of 200 s
  wheel.stiffness_nm_per_rad = std::max(wheel.stiffness_nm_per_rad, kLeast_per_s2 * wheel.inertia_kgm2);
  return wheel;
}

class Hypothesis {
 public:
  explicit Hypothesis(const EffectType& type) : type_(type) {}
  virtual ~Hypothesis() = default;

  [[nodiscard]] const EffectType& type() const { return type_; }

  /// The response of the recorded angle to torque at w; `values` as in the effect.
  [[nodiscard]] virtual Complex response(const WheelArm& wheel, const double* /*values*/, double w) const {
    return wheel_response(wheel, w);
  }
  /// The same without its zeros, up to a factor.
  [[nodiscard]] virtual Complex ends(const WheelArm& wheel, const double* values, double w) const {
    return response(wheel, values, w);
  }
  /// By how much the angle's record is late.
  [[nodiscard]] virtual double delay_s(const double* /*values*/) const { return 0; }
  /// True when the response is another one because the angle's channel is, and not the wheel.
  [[nodiscard]] virtual bool on_channel() const { return false; }
  /// True when the effect is a torque.
  [[nodiscard]] virtual bool acts() const { return true; }
  /// What it adds to J, B and C for a small movement beside the motion, in the mean over that: what a run's noise
  /// passes.
  [[nodiscard]] virtual WheelArm felt_by_noise(const double* /*values*/, const MeasuredMotion& /*motion*/) const {
    return {0, 0, 0};
  }
  /// True when the quick fit is exact for it: it changes the response alone, or is a torque that knows no motion.
  [[nodiscard]] virtual bool exact_at_once() const { return !acts(); }
  /// True when the wheel can stick.
  [[nodiscard]] virtual bool sticks() const { return false; }
  /// True when a slow torque moves the wheel with it otherwise than it moves a linear one: what sticks or has
  /// backlash it sets free, and what is let go it moves far.
  [[nodiscard]] virtual bool freed_by_slow_torque() const { return sticks(); }
  /// True when the hand leaves the wheel.
  [[nodiscard]] virtual bool lets_go() const { return false; }
  /// True when it begins or ends at instants.
  [[nodiscard]] virtual bool timed() const { return false; }
  /// Effects of one family are told apart by details: a simulation holds one of them at most.
  enum class Family { kNone, kFriction, kLateness, kOffset };
  [[nodiscard]] virtual Family family() const { return Family::kNone; }
  /// True when it is seen in what is faster than a driver's steering: linear in the motion, of a course in time that is
  /// its own, or nothing but late. What bends, sticks or depends on the place acts otherwise where the driver has
  /// brought the wheel.
  [[nodiscard]] virtual bool stands_beside_steering() const {
    return (exact_at_once() || timed()) && family() != Family::kOffset;
  }
  /// How many of its values say how large it is, the first ones: those that a simulation which has the effect is
  /// trusted in. The others are shares and bends that hardly anybody knows.
  [[nodiscard]] virtual std::ptrdiff_t sizes() const { return shown(); }
  /// What every record has, and by which an effect is measured.
  struct Usual {
    double begin_s = 0;         ///< of the record
    double end_s = 0;           ///< of the record
    double applied_rms_nm = 0;  ///< of the recorded torques
    double swing_rad = 0;       ///< of the measured angle, from end to end
    double step_rad = 0;        ///< of a rounded angle; 0: none is seen
    bool loop_holds = false;    ///< a loop answers what moves the wheel, and its answers are taken for noise
  };
  /// Whether these values are more than what every record has, or another effect by this one's name. Of most effects
  /// the first is a size, and nothing is there where it is zero.
  [[nodiscard]] virtual bool beyond_usual(const double* values, const Usual& /*usual*/) const { return values[0] != 0; }
  /// The values that act most like another effect of the family; none where there are no such.
  [[nodiscard]] virtual std::optional<std::vector<double>> in_place_of(const Effect& /*relative*/) const {
    return std::nullopt;
  }
  /// Values for free runs to begin from, for those that fit the measured motion.
  [[nodiscard]] virtual std::vector<double> to_run(std::vector<double> values, const WheelArm& /*wheel*/) const {
    return values;
  }
  /// True when torque() can be tried on the measured motion for a start, whatever the fit itself takes.
  [[nodiscard]] virtual bool tried_as_torque() const { return acts(); }
  /// Which of J, B and C that torque depends on.
  struct Knows {
    bool inertia = false;
    bool damping = false;
    bool stiffness = false;
  };
  [[nodiscard]] virtual Knows knows() const { return {}; }
  /// How many of its values the torque depends on, the first ones.
  [[nodiscard]] virtual std::ptrdiff_t shown() const { return std::ssize(type_.parameters); }
  /// True when the torque depends on the moment alone: on time, angle and rate at a sample.
  [[nodiscard]] virtual bool momentary() const { return false; }
  /// Indices of the parameters in which the torque is linear: one that scales it, and one that is the phase of a
  /// sinusoid, which is a sine and a cosine. -1: none. What is known for a scale of one, at phases of zero and a
  /// quarter, is known for all of them.
  struct Linear {
    int scale = -1;
    int phase = -1;
  };
  [[nodiscard]] virtual Linear linear() const { return {}; }
  /// The torque that it adds to the applied one, one value a sample. As a rule it is the plant's own law on the
  /// measured motion, or what undoes an offset of the record.
  virtual void torque(const WheelArm& wheel, const double* values, const Record& record, const MeasuredMotion& motion,
                      std::vector<double>& torque_nm) const;

  /// Shapes worth starting from: values with the torque's size left at a unit, to be scaled by a linear fit. `scaled`
  /// is the index of the parameter that scales the torque. Where linear() has a phase, sine and cosine are fitted
  /// together.
  /// Of Starts::scaled, beside an index: the values are taken as they are; a ratio, the second value, that is one where
  /// the effect does nothing.
  enum Scaled : int { kScalesNothing = -1, kScalesRatio = -2 };
  struct Starts {
    std::vector<std::vector<double>> values;
    int scaled = kScalesNothing;
    bool by_line = false;  ///< values[1] is a frequency: look near the strongest lines of what is left
    std::size_t keep = 2;  ///< how many of the best are fitted further
  };
  [[nodiscard]] virtual Starts starts(const WheelArm& wheel, const Record& record,
                                      const MeasuredMotion& motion) const = 0;

  /// Values that a fit may miss because its steps do not lead there from where it ended, at `values`. None as a rule.
  [[nodiscard]] virtual std::vector<std::vector<double>> missed(const std::vector<double>& /*values*/) const {
    return {};
  }

 private:
  const EffectType& type_;
};

/// One a vocabulary entry that a fit can have; the record's own defects (sample_loss, coarse_quantization,
/// torque_saturation) are found elsewhere (gap/preparation/record_defects.hpp). Made once, without state, shared by all
/// threads.
[[nodiscard]] const std::vector<std::unique_ptr<Hypothesis>>& hypotheses();

/// The one of an effect; null where there is none.
[[nodiscard]] const Hypothesis* hypothesis_of(const EffectType& type);

}  // namespace steerid::gap
