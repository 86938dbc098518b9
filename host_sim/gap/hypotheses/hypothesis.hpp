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
#include <utility>
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
  /// Effects of one family are told apart by details: a simulation holds one of them at most.
  enum class Family { kNone, kFriction, kLateness, kOffset };
  /// Which of J, B and C the torque depends on.
  struct Knows {
    bool inertia = false;
    bool damping = false;
    bool stiffness = false;
  };
  /// Indices of the parameters in which the torque is linear: one that scales it, and one that is the phase of a
  /// sinusoid, which is a sine and a cosine. -1: none. What is known for a scale of one, at phases of zero and a
  /// quarter, is known for all of them.
  struct Linear {
    int scale = -1;
    int phase = -1;
  };
  /// Of Starts::scaled, beside an index: the values are taken as they are; a ratio, the second value, that is one where
  /// the effect does nothing.
  enum Scaled : int { kScalesNothing = -1, kScalesRatio = -2 };
  /// Shapes worth starting from: values with the torque's size left at a unit, to be scaled by a linear fit. Where the
  /// torque is linear in a phase, sine and cosine are fitted together.
  struct Starts {
    std::vector<std::vector<double>> values{};
    int scaled = kScalesNothing;  ///< the index of the parameter that scales the torque
    bool by_line = false;         ///< values[1] is a frequency: look near the strongest lines of what is left
    std::size_t keep = 2;         ///< how many of the best are fitted further
  };
  /// What holds of an effect whatever its values are.
  struct Traits {
    Family family = Family::kNone;
    bool acts = true;              ///< it is a torque; else it changes the response
    bool on_channel = false;       ///< the response is another one because the angle's channel is, not the wheel
    bool knows_no_motion = false;  ///< its torque depends on time alone
    bool momentary = false;        ///< its torque depends on the moment alone: on time, angle and rate at a sample
    bool sticks = false;           ///< the wheel can stick
    bool lets_go = false;          ///< the hand leaves the wheel
    bool timed = false;            ///< it begins or ends at instants
    bool tried_as_torque = false;  ///< torque() can be tried for a start, as that of what acts, whatever is fitted
    Knows knows{};
    Linear linear{};
    /// How many of its values the torque on the measured motion does not depend on, the last ones.
    std::ptrdiff_t unshown = 0;
    /// How many of its values say how large it is, the first ones: those that a simulation which has the effect is
    /// trusted in. The others are shares and bends that hardly anybody knows. None given: all that are shown.
    std::optional<std::ptrdiff_t> sizes{};
    Starts starts{};  ///< where they are the same for every record
  };

  Hypothesis(const EffectType& type, Traits traits) : type_(type), traits_(std::move(traits)) {}
  virtual ~Hypothesis() = default;

  [[nodiscard]] const EffectType& type() const { return type_; }

  // What its traits say.
  [[nodiscard]] Family family() const { return traits_.family; }
  [[nodiscard]] bool of_family_of(const Hypothesis& other) const {
    return family() != Family::kNone && family() == other.family();
  }
  [[nodiscard]] bool acts() const { return traits_.acts; }
  [[nodiscard]] bool on_channel() const { return traits_.on_channel; }
  [[nodiscard]] bool momentary() const { return traits_.momentary; }
  [[nodiscard]] bool sticks() const { return traits_.sticks; }
  [[nodiscard]] bool lets_go() const { return traits_.lets_go; }
  [[nodiscard]] bool timed() const { return traits_.timed; }
  [[nodiscard]] bool tried_as_torque() const { return traits_.acts || traits_.tried_as_torque; }
  [[nodiscard]] Knows knows() const { return traits_.knows; }
  [[nodiscard]] Linear linear() const { return traits_.linear; }
  /// How many of its values the torque depends on, the first ones.
  [[nodiscard]] std::ptrdiff_t shown() const { return std::ssize(type_.parameters) - traits_.unshown; }
  [[nodiscard]] std::ptrdiff_t sizes() const { return traits_.sizes.value_or(shown()); }
  /// Whether the quick fit is exact for it.
  [[nodiscard]] bool exact_at_once() const { return !traits_.acts || traits_.knows_no_motion; }
  /// Whether it is seen in what is faster than a driver's steering: linear in the motion, of a course in time that is
  /// its own, or nothing but late. What bends, sticks or depends on the place acts otherwise where the driver has
  /// brought the wheel.
  [[nodiscard]] bool stands_beside_steering() const {
    return (exact_at_once() || timed()) && family() != Family::kOffset;
  }

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
  /// What it adds to J, B and C for a small movement beside the motion, in the mean over that: what a run's noise
  /// passes.
  [[nodiscard]] virtual WheelArm felt_by_noise(const double* /*values*/, const MeasuredMotion& /*motion*/) const {
    return {0, 0, 0};
  }
  /// When a record begins and ends, on the effects' clock.
  struct Span {
    double begin_s = 0;
    double end_s = 0;
    [[nodiscard]] double length_s() const { return end_s - begin_s; }
    [[nodiscard]] double middle_s() const { return (begin_s + end_s) / 2; }
  };
  /// What every record has, and by which an effect is measured.
  struct Usual {
    Span record{};
    double applied_rms_nm = 0;  ///< of the recorded torques
    double swing_rad = 0;       ///< of the measured angle, from end to end
    double step_rad = 0;        ///< of a rounded angle; 0: none is seen
    bool loop_holds = false;    ///< a loop answers what moves the wheel, and its answers are taken for noise
  };
  /// Whether these values are more than what every record has, or another effect by this one's name. Of most effects
  /// the first is a size, and nothing is there where it is zero.
  [[nodiscard]] virtual bool beyond_usual(const double* values, const Usual& /*usual*/) const { return values[0] != 0; }
  /// Of the values and wheels that make the same motion in such a record, those that state no more than it shows. As a
  /// rule that is the phase within half a turn. `wheel` is null where J, B and C are given.
  virtual void restate(const Span& record, double* values, WheelArm* wheel) const;
  /// Whether an end of the record cuts off what this number states, so that beside the others nothing tells it.
  [[nodiscard]] virtual bool cut_off_by(const Span& /*record*/, const double* /*values*/,
                                        std::size_t /*number*/) const {
    return false;
  }
  /// The same course on to the end of the record that would cut this number off; false where there is no such course,
  /// and where it is there.
  virtual bool go_on_to_end(const Span& /*record*/, double* /*values*/, WheelArm* /*wheel*/,
                            std::size_t /*number*/) const {
    return false;
  }
  /// The values that act most like another effect of the family; none where there are no such.
  [[nodiscard]] virtual std::optional<std::vector<double>> in_place_of(const Effect& /*relative*/) const {
    return std::nullopt;
  }
  /// Values for free runs to begin from, for those that fit the measured motion.
  [[nodiscard]] virtual std::vector<double> to_run(std::vector<double> values, const WheelArm& /*wheel*/) const {
    return values;
  }
  /// The torque that it adds to the applied one, one value a sample. As a rule it is the plant's own law on the
  /// measured motion, or what undoes an offset of the record.
  virtual void torque(const WheelArm& wheel, const double* values, const Record& record, const MeasuredMotion& motion,
                      std::vector<double>& torque_nm) const;

  [[nodiscard]] virtual Starts starts(const WheelArm& /*wheel*/, const Record& /*record*/,
                                      const MeasuredMotion& /*motion*/) const {
    return traits_.starts;
  }

  /// Values that a fit may miss because its steps do not lead there from where it ended, at `values`: few enough to try
  /// each by a free run. As a rule the other choices, where the effect has one.
  [[nodiscard]] virtual std::vector<std::vector<double>> missed(const std::vector<double>& values) const;
  /// Many more, to try on the measured motion. None as a rule.
  [[nodiscard]] virtual std::vector<std::vector<double>> missed_instants(const std::vector<double>& /*values*/) const {
    return {};
  }

 private:
  const EffectType& type_;
  Traits traits_;
};

/// One a vocabulary entry that a fit can have; the record's own defects (sample_loss, coarse_quantization,
/// torque_saturation) are found elsewhere (gap/preparation/record_defects.hpp). Made once, without state, shared by all
/// threads.
[[nodiscard]] const std::vector<std::unique_ptr<Hypothesis>>& hypotheses();

/// The one of an effect; null where there is none.
[[nodiscard]] const Hypothesis* hypothesis_of(const EffectType& type);

}  // namespace steerid::gap
