// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The 100 Hz task: one sample in, one estimate out.
//
// Units: the sample's integers are turned into rad and Nm here, the identifier's answers into the port's micro-units.
// A bridged gap is filled on a straight line and not learned from; a fault (no usable sample for a tenth of a
// second) shows in every parameter's state, while the last good values stay. Values are published at every tick,
// deviations and the driver's state renewed ten times a second.
//
// Time is counted in samples; how far apart they are is measured by their stamps (sample_period.hpp), and J, B and
// their deviations are published in the units that follow from it.
//
// The equation follows from the channels of the samples (port/equation.hpp, input_supervision.hpp): the paper's own
// where the driver's torque is known, that above the torsion bar or of the arm behind a rim transducer where it is not.
#pragma once

#include <cstdint>

#include "app/driver_state.hpp"
#include "app/input_supervision.hpp"
#include "app/probe.hpp"
#include "app/sample_period.hpp"
#include "app/saved_state.hpp"
#include "identifier/wheel_identifier.hpp"
#include "port/estimate.hpp"
#include "port/sample.hpp"

namespace steerid {

template <class Scalar>
class IdentificationTask {
 public:
  /// Neither settings nor limits are copied, so that they can lie in flash: they have to live as long as the task does.
  explicit IdentificationTask(const IdentifierSettings<Scalar>& settings = kSteeringWheel<Scalar>,
                              const InputLimits& limits = InputSupervision::kSteeringWheel,
                              const ProbeLimits& probe = Probe::kGentle,
                              const ClosedLoopSettings<Scalar>& column = kSteeringColumn<Scalar>)
      : supervision_(limits), identifier_(settings, column), probe_(probe) {
    refresh();
  }
  explicit IdentificationTask(const IdentifierSettings<Scalar>&& passing,
                              const InputLimits& limits = InputSupervision::kSteeringWheel) = delete;
  IdentificationTask(const IdentifierSettings<Scalar>& settings, const InputLimits&& passing) = delete;
  IdentificationTask(const IdentifierSettings<Scalar>& settings, const InputLimits& limits, const ProbeLimits& probe,
                     const ClosedLoopSettings<Scalar>&& passing) = delete;

  /// A tick with a new sample. One that is refused is as good as none.
  void take(const Sample& sample);
  /// A tick without one.
  void idle() {
    supervision_.tick_without_sample();
    observe_driver();
  }
  void late_tick() { supervision_.late_tick(); }

  /// What to publish now.
  [[nodiscard]] Estimate estimate() const;
  /// All three parameters valid.
  [[nodiscard]] bool valid() const;
  [[nodiscard]] bool fault() const { return supervision_.faulty(); }

  /// What is worth keeping over power-off. kOk; kNoData unless every parameter has been `valid` since the start and is
  /// at least `holding`: a restored estimate that no data have shown again is in the memory already.
  [[gnu::cold]] Status save(SavedEstimate& saved) const;
  /// Goes on from a saved estimate, every parameter `holding` until fresh data have shown it, with ten times the saved
  /// deviations (Identifier::restore). Call before the first tick. kOk; kOutOfRange when a number is outside the
  /// identifier's limits, and nothing is changed then.
  [[gnu::cold]] Status restore(const SavedEstimate& saved);

  /// Whether a probe may be asked for while a parameter is known less than is asked (probe.hpp); off until said
  /// otherwise.
  void permit_probe(bool permitted) { probe_permitted_ = permitted; }
  /// The torque to ask the EPS for on this tick, once after take() or idle().
  [[nodiscard]] std::int32_t probe_torque_mnm();
  /// It was not taken: it does not stand for the probe where the sample has none.
  void probe_was_refused() { asked_mnm_ = 0; }
  [[nodiscard]] const Probe& probe() const { return probe_; }

  [[nodiscard]] const WheelIdentifier<Scalar>& identifier() const { return identifier_; }
  /// What J, B and C belong to; kNone before the first sample that allows anything.
  [[nodiscard]] Equation equation() const { return supervision_.equation(); }

 private:
  [[gnu::cold]] void bridge(const InputSupervision::Reading& from, const InputSupervision::Reading& to, int missing);
  [[gnu::cold]] void begin(Equation before);
  void measure_period(std::int64_t elapsed_us, int periods);
  void learn(const InputSupervision::Reading& now);
  void observe_driver();
  [[gnu::cold, gnu::noinline]] void refresh_driver();
  [[gnu::cold]] void refresh();
  [[gnu::cold, gnu::noinline]] void aim_probe(const Vector3<Scalar>& deviation);
  [[nodiscard]] DriverEvidence evidence(const ParameterEstimate& inertia, const ParameterEstimate& damping,
                                        const ParameterEstimate& stiffness) const;
  /// What the hands do, or the sensor nearest to them reads.
  [[nodiscard]] std::int32_t hands_torque_mnm() const {
    const InputSupervision::Reading& last = supervision_.last();
    return voluntary_torque_known(supervision_.equation()) ? last.voluntary_mnm : last.opposing_mnm;
  }
  static std::int32_t mean(std::uint32_t of_64) { return static_cast<std::int32_t>(of_64 / 64); }
  [[nodiscard]] ParameterEstimate published(int parameter) const;
  [[nodiscard]] ParameterState state(int parameter) const;
  [[nodiscard]] Scalar in_seconds(Scalar found, int parameter) const {
    return period_.in_seconds(found, kStiffness - parameter);
  }
  [[nodiscard]] Scalar value(int parameter) const { return in_seconds(identifier_.value(parameter), parameter); }

  static WheelSample<Scalar> in_units(const InputSupervision::Reading& reading) {
    return {newton_metres(reading.torque_mnm()), radians(reading.angle_urad), newton_metres(reading.probe_mnm)};
  }
  static constexpr Scalar radians(std::int32_t angle_urad) { return Scalar(angle_urad) * Scalar(1e-6); }
  static constexpr Scalar newton_metres(std::int32_t torque_mnm) { return Scalar(torque_mnm) * Scalar(1e-3); }
  /// Rounded to the nearest micro-unit, held at the ends of int32.
  static constexpr std::int32_t micro(Scalar value) {
    const Scalar scaled = value * Scalar(1e6);
    if (scaled > Scalar(-0.5) && scaled < Scalar(2147483520.0)) return static_cast<std::int32_t>(scaled + Scalar(0.5));
    if (scaled > Scalar(0)) return INT32_MAX;
    if (scaled <= Scalar(-2147483520.0)) return INT32_MIN;
    return static_cast<std::int32_t>(scaled - Scalar(0.5));
  }

  static_assert(IdentifierSettings<double>::period_s * 1'000'000 == kTickPeriodUs);  // one rate, in two units

  static constexpr double kMostOverAsked = 1000;  ///< no prior is that wide
  static constexpr int kStraight = 1;       ///< samples: across two and more a 5 Hz torque is no straight line, ...
  static constexpr int kFilterMemory = 20;  ///< ... and the filters remember what was put there for so many

  InputSupervision supervision_;
  SamplePeriod period_;
  WheelIdentifier<Scalar> identifier_;
  std::int32_t deviation_micro_[3] = {};  ///< at the last refresh
  std::int32_t settled_micro_ = 0;        ///< likewise, of J as the identifier has it that answers
  Probe probe_;
  DriverStateObserver driver_;
  std::uint32_t acting_64th_mnm_ = 0;  ///< 64 times the mean size of the torque over 0.64 s
  std::uint32_t driver_64th_mnm_ = 0;  ///< of the driver's part
  std::int32_t asked_mnm_ = 0;         ///< the probe, at the last tick
  std::uint8_t doubtful_ = 0;          ///< samples that are not learned from yet
  std::int8_t until_observed_ = 0;     ///< ticks
  std::int8_t until_refresh_ = 0;      ///< samples
  std::uint8_t shown_ = 0;             ///< bit i: parameter i was valid at some refresh since the start
  /// Whether at the last refresh a parameter was known better than without data: what the prior holds is not valid.
  bool learned_[3] = {};
  bool probe_permitted_ = false;
};

template <class Scalar>
std::int32_t IdentificationTask<Scalar>::probe_torque_mnm() {
  return asked_mnm_ = probe_.next({.allowed = probe_permitted_,
                                   .fault = supervision_.faulty(),
                                   .torque_driver_mnm = hands_torque_mnm(),
                                   .angle_step_urad = supervision_.angle_step_urad()});
}

template <class Scalar>
void IdentificationTask<Scalar>::take(const Sample& sample) {
  const InputSupervision::Reading before = supervision_.last();
  const std::int64_t stamp_us = supervision_.last_stamp_us();
  int missing = 0;
  const Equation equation = supervision_.equation();
  const InputSupervision::Verdict verdict = supervision_.judge(sample, missing, asked_mnm_);
  const bool teaches = verdict < InputSupervision::Verdict::kStill;
  if (supervision_.equation() != equation) begin(equation);
  if (verdict == InputSupervision::Verdict::kResettle) {
    identifier_.resettle();
    period_.break_here();
  } else if (teaches) {
    // Unsigned: the difference of two stamps fits wherever the clock stands.
    measure_period(static_cast<std::int64_t>(static_cast<std::uint64_t>(supervision_.last_stamp_us()) -
                                             static_cast<std::uint64_t>(stamp_us)),
                   missing + 1);
  }
  if (verdict == InputSupervision::Verdict::kBridge) bridge(before, supervision_.last(), missing);
  // A refused sample is a missing one: of the driver it says as much as a tick without any.
  if (teaches) learn(supervision_.last());
  observe_driver();
}

/// With an equation that was not there before. What a restore brought belongs to the first one; what was learned by one
/// equation says nothing of the next, which may be the arm without the wheel.
template <class Scalar>
void IdentificationTask<Scalar>::begin(Equation before) {
  identifier_.voluntary_torque_known(voluntary_torque_known(supervision_.equation()));
  if (before == Equation::kNone) return;
  identifier_.restart();
  shown_ = 0;
}

/// What was learned of samples that were otherwise apart is of another unit.
template <class Scalar>
inline void IdentificationTask<Scalar>::measure_period(std::int64_t elapsed_us, int periods) {
  if (!period_.take(elapsed_us, periods)) return;
  identifier_.restart();
  shown_ = 0;
}

template <class Scalar>
inline void IdentificationTask<Scalar>::learn(const InputSupervision::Reading& now) {
  identifier_.update(in_units(now), doubtful_ == 0);
  if (doubtful_ > 0) --doubtful_;
  // Counted in samples, not in ticks: what is published of a record must not hang on when the loop was started.
  if (--until_refresh_ <= 0) {
    refresh();
    until_refresh_ = DriverStateObserver::kTicks;
  }
}

/// What changes slowly and costs square roots: deviations, and whether they were ever small.
template <class Scalar>
void IdentificationTask<Scalar>::refresh() {
  const Vector3<Scalar> deviation = identifier_.standard_deviation();
  for (int i = 0; i < 3; ++i) {
    deviation_micro_[i] = micro(in_seconds(deviation(i), i));
    learned_[i] = deviation(i) < identifier_.prior().spread(i);
    if (identifier_.belief(i) == Belief::kValid) shown_ |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(i));
  }
  settled_micro_ = voluntary_torque_known(supervision_.equation())
                       ? micro(in_seconds(identifier_.deviation_of_answer(kInertia), kInertia))
                       : deviation_micro_[kInertia];  // of one identifier it is the same
  if (probe_permitted_) aim_probe(deviation);
}

/// What is asked of a parameter is a share of it; of one below that of any arm (a wheel that nobody holds has no C),
/// the share of the least arm's.
template <class Scalar>
void IdentificationTask<Scalar>::aim_probe(const Vector3<Scalar>& deviation) {
  const Vector3<Scalar> arm = identifier_.value();
  Vector3<Scalar> asked;
  Scalar worst(0);
  Scalar best(kMostOverAsked);
  for (int i = 0; i < 3; ++i) {
    const Scalar least = kLeastArm<Scalar>(i);
    asked(i) = (arm(i) > least ? arm(i) : least) * Scalar(probe_.limits().asked_permille[i]) * Scalar(1e-3);
    const Scalar over = deviation(i) / asked(i);
    if (over > worst) worst = over;
    if (over < best) best = over;
  }
  const Scalar resonance_dhz = square_root(arm(kStiffness) / arm(kInertia)) * Scalar(10 / 6.2831853);
  probe_.aim({.worst_256 = static_cast<std::int32_t>(worst * Scalar(256)),
              .best_256 = static_cast<std::int32_t>(best * Scalar(256)),
              .needed_mnm = micro(identifier_.follower().probe_needed_nm(asked) * Scalar(1e-3)),
              .resonance_dhz = static_cast<std::int32_t>(resonance_dhz + Scalar(0.5))});
}

/// The state of a driver changes within tenths of a second: a refresh at every tick would only cost.
template <class Scalar>
void IdentificationTask<Scalar>::observe_driver() {
  const InputSupervision::Reading& last = supervision_.last();
  const auto follow = [](std::uint32_t& mean_64th, std::int32_t torque_mnm) {
    const std::uint32_t size =
        torque_mnm < 0 ? 0U - static_cast<std::uint32_t>(torque_mnm) : static_cast<std::uint32_t>(torque_mnm);
    mean_64th += size - mean_64th / 64;
  };
  follow(acting_64th_mnm_, last.torque_mnm());
  follow(driver_64th_mnm_, last.voluntary_mnm);
  if (--until_observed_ > 0) return;
  refresh_driver();
}

template <class Scalar>
void IdentificationTask<Scalar>::refresh_driver() {
  until_observed_ = DriverStateObserver::kTicks;
  driver_.take(evidence(published(kInertia), published(kDamping), published(kStiffness)));
}

template <class Scalar>
void IdentificationTask<Scalar>::bridge(const InputSupervision::Reading& from, const InputSupervision::Reading& to,
                                        int missing) {
  const WheelSample<Scalar> begin = in_units(from);
  const WheelSample<Scalar> end = in_units(to);
  const Scalar part = Scalar(1) / Scalar(missing + 1);
  for (int i = 1; i <= missing; ++i) identifier_.update(begin.towards(end, part * Scalar(i)), false);
  if (missing > kStraight) doubtful_ = kFilterMemory;
}

template <class Scalar>
ParameterState IdentificationTask<Scalar>::state(int parameter) const {
  constexpr auto kSame = [](Belief belief, ParameterState state) {
    return static_cast<unsigned>(belief) == static_cast<unsigned>(state);
  };
  static_assert(kSame(Belief::kStarting, ParameterState::kStarting) &&
                kSame(Belief::kConverging, ParameterState::kConverging) &&
                kSame(Belief::kValid, ParameterState::kValid) && kSame(Belief::kHolding, ParameterState::kHolding) &&
                kSame(Belief::kNotExcited, ParameterState::kNotExcited));
  if (supervision_.faulty()) return ParameterState::kFault;
  const auto known = static_cast<ParameterState>(identifier_.belief(parameter));
  if (known == ParameterState::kValid && supervision_.still()) return ParameterState::kHolding;
  return known == ParameterState::kValid && !learned_[parameter] ? ParameterState::kConverging : known;
}

template <class Scalar>
ParameterEstimate IdentificationTask<Scalar>::published(int parameter) const {
  return {micro(value(parameter)), deviation_micro_[parameter], state(parameter)};
}

template <class Scalar>
DriverEvidence IdentificationTask<Scalar>::evidence(const ParameterEstimate& inertia, const ParameterEstimate& damping,
                                                    const ParameterEstimate& stiffness) const {
  // Of a rim transducer nothing is left without hands, not even the wheel; and nothing is told by samples that stay.
  const bool above_bar = supervision_.equation() == Equation::kBar && !supervision_.faulty() && !supervision_.still();
  // A second hand is a change that lasts a second and more: that J may change just now is no doubt about it.
  return {{inertia.value_micro, settled_micro_, inertia.state},
          damping,
          stiffness,
          mean(acting_64th_mnm_),
          mean(driver_64th_mnm_),
          above_bar ? micro(identifier_.released()) : 0,
          above_bar};
}

template <class Scalar>
Estimate IdentificationTask<Scalar>::estimate() const {
  const ParameterEstimate inertia = published(kInertia);
  const ParameterEstimate damping = published(kDamping);
  const ParameterEstimate stiffness = published(kStiffness);
  const DriverState driver = driver_.state(evidence(inertia, damping, stiffness));
  return {.stamp_us = supervision_.last_stamp_us(),
          .inertia = inertia,
          .damping = damping,
          .stiffness = stiffness,
          .driver = driver,
          .hands = driver_.hands(driver, inertia.state),
          .counters = supervision_.counters()};
}

template <class Scalar>
Status IdentificationTask<Scalar>::save(SavedEstimate& saved) const {
  SavedEstimate now;
  for (int i = 0; i < 3; ++i) {
    const bool shown = (static_cast<unsigned>(shown_) >> static_cast<unsigned>(i) & 1U) != 0;
    if (!shown || (state(i) != ParameterState::kValid && state(i) != ParameterState::kHolding)) {
      return Status::kNoData;
    }
    const auto at = static_cast<std::size_t>(i);
    now.value_micro[at] = micro(value(i));
    now.sd_micro[at] = deviation_micro_[i] + 1;  // never 0, which no deviation is
  }
  now.noise_unm = micro(identifier_.noise_nm());
  saved = now;
  return Status::kOk;
}

template <class Scalar>
Status IdentificationTask<Scalar>::restore(const SavedEstimate& saved) {
  const Prior<Scalar>& prior = identifier_.prior();
  Vector3<Scalar> value;
  Vector3<Scalar> deviation;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    value(i) = Scalar(saved.value_micro[at]) * Scalar(1e-6);
    deviation(i) = Scalar(saved.sd_micro[at]) * Scalar(1e-6);
    // A limit may be a rounding smaller in this type than what was saved at it.
    const Scalar rounding = value(i) * Scalar(1e-6);
    if (value(i) + rounding < prior.lowest(i) || value(i) - rounding > prior.highest(i)) return Status::kOutOfRange;
    if (!(deviation(i) > Scalar(0))) return Status::kOutOfRange;
    if (deviation(i) > prior.spread(i)) deviation(i) = prior.spread(i);
  }
  if (saved.noise_unm <= 0) return Status::kOutOfRange;
  identifier_.restore(value, deviation, Scalar(saved.noise_unm) * Scalar(1e-6));
  refresh();
  return Status::kOk;
}

template <class Scalar>
bool IdentificationTask<Scalar>::valid() const {
  return state(kInertia) == ParameterState::kValid && state(kDamping) == ParameterState::kValid &&
         state(kStiffness) == ParameterState::kValid;
}

}  // namespace steerid
