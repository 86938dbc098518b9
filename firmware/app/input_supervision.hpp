// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Decides, in integers and before any filter sees it, whether a sample may be used, and how far it lies behind the
// last one.
//
// Checks, in this order; the first that fails counts and decides:
//   invalid channel   the valid bit of a channel that the equation uses is cleared
//   out of range      angle or a torque beyond what a wheel can do (InputLimits)
//   repeated          the stamp of the last accepted sample again, or less than half a period behind it
//   out of order      a stamp before it
//   spike             farther from the last accepted sample than the wheel can move, or a torque can rise, meanwhile
//   stuck             the angle has not moved at all for a while though the torque did
//
// A sample is good and says nothing where for half a second the angle, or a torsion bar's torque, has been the same to
// the port's last digit: a gateway that repeats its last message, a sensor that has frozen or lost its supply, or a
// wheel at rest. No sensor's noise is that small. Nothing is learned from it, and no fault is told; of an angle that
// moves by whole digits of a coarse sensor it costs what such a wheel says, which is little. A torque that is no
// sensor's, as a step that is asked of a motor, may stay the same.
//
// Which equation holds is decided by the channels of the first sample that allow one (port/equation.hpp). Samples that
// lack a channel of it are refused; after kAcceptEquation in a row that allow the same other one, that one holds, and
// everything restarts: a channel that drops out for a while changes nothing, one that is gone for good does not end the
// identification where another equation is left. Channels that the equation does not use are not examined. Where no
// `probe` is delivered, what the task itself asked for on the tick before stands for it.
//
// A sample that is turned down is simply missing: the next good one finds a gap before it. After kAcceptAnyway
// refusals in a row for a spike or a stamp before the last one, the new reading is taken for the truth and the old one
// for the error (a clock that was set, a sensor that was plugged in again): everything restarts from it.
//
// Cost: comparisons and additions of 32 and 64 bit integers, no division except one on a gap.
#pragma once

#include <cstdint>

#include "port/equation.hpp"
#include "port/estimate.hpp"
#include "port/sample.hpp"

namespace steerid {

/// What a steering wheel with a driver can do. Wide: they are to catch nonsense, not to judge drivers.
struct InputLimits {
  std::int32_t angle_urad = 20'000'000;    ///< three turns
  std::int32_t torque_mnm = 100'000;       ///< each torque
  std::int32_t angle_step_urad = 400'000;  ///< per period: 40 rad/s
  std::int32_t torque_step_mnm = 20'000;   ///< per period
  std::int32_t stuck_torque_mnm = 1'000;   ///< how far the torque must have moved ...
  std::uint8_t stuck_samples = 30;         ///< ... during so many samples without any movement of the angle
};

class InputSupervision {
 public:
  static constexpr InputLimits kSteeringWheel{};
  /// What of an accepted sample is compared with the next one.
  struct Reading {
    std::int32_t angle_urad = 0;
    std::int32_t voluntary_mnm = 0;  ///< the driver's own torque; 0 where it is not measured
    std::int32_t opposing_mnm = 0;   ///< of motor, torsion bar or rim, whichever the equation has
    std::int32_t probe_mnm = 0;
    /// What is known of the torque on arm and wheel. Within the limits, so that the difference fits.
    [[nodiscard]] std::int32_t torque_mnm() const { return voluntary_mnm - opposing_mnm; }
  };

  enum class Verdict : std::uint8_t {
    kUse,       ///< the sample follows the last one by one period
    kBridge,    ///< good, with `missing` samples before it: fill them in without learning from them
    kResettle,  ///< good, but the gap is too long to bridge: filters start again, what was learned stays
    // From here on there is nothing to learn.
    kStill,   ///< good, and as the ones before it
    kReject,  ///< not to be used
  };

  /// `limits` are not copied, so that they can lie in flash: they have to live as long as the supervision does.
  explicit InputSupervision(const InputLimits& limits = kSteeringWheel) : limits_(&limits) {}
  explicit InputSupervision(const InputLimits&& passing) = delete;

  /// Looks at the newest sample. `missing` is written for kBridge only. `asked_mnm`: the probe that the task asked for.
  Verdict judge(const Sample& sample, int& missing, std::int32_t asked_mnm = 0);

  /// A tick without any sample, or with a late deadline.
  void tick_without_sample();
  void late_tick() { count(counters_.late_tick); }

  /// The last accepted sample: where a gap is bridged from.
  [[nodiscard]] const Reading& last() const { return last_; }
  [[nodiscard]] std::int64_t last_stamp_us() const { return stamp_us_; }
  /// What the wheel's channels allow; kNone before the first sample that allows anything.
  [[nodiscard]] Equation equation() const { return equation_; }
  /// How far the wheel turned from the accepted sample before it.
  [[nodiscard]] std::int32_t angle_step_urad() const { return angle_step_urad_; }
  [[nodiscard]] const InputCounters& counters() const { return counters_; }
  /// True while samples are the same.
  [[nodiscard, gnu::noinline]] bool still() const { return unmoved_ >= kStillSamples || flat_ >= kStillSamples; }
  /// True while no usable sample has come for kFaultAfter ticks.
  [[nodiscard]] bool faulty() const { return ticks_without_ >= kFaultAfter; }

  static constexpr int kLongestBridge = 10;  ///< samples: a tenth of a second, half a period of the probe's top tone

 private:
  static constexpr int kFaultAfter = 10;    ///< ticks
  static constexpr int kAcceptAnyway = 20;  ///< refusals in a row
  static constexpr int kAcceptEquation = 100;
  static constexpr int kStillSamples = 50;
  static constexpr int kStuck = 255;  ///< instead of a number of samples

  [[nodiscard]] bool usable(const Sample& sample) {
    const std::uint8_t needed = channels_of(equation_);
    if (equation_ == Equation::kNone || (sample.valid_bits & needed) != needed) return agreed_equation(sample);
    other_samples_ = 0;
    return true;
  }
  [[nodiscard]] bool agreed_equation(const Sample& sample);
  [[nodiscard]] Reading reading_of(const Sample& sample, std::int32_t asked_mnm) const {
    return {sample.angle_urad, voluntary_torque_mnm(sample, equation_), opposing_torque_mnm(sample, equation_),
            (sample.valid_bits & kProbeValid) != 0 ? sample.probe_mnm : asked_mnm};
  }
  Verdict judge_closely(std::int64_t stamp_us, const Reading& reading, int& missing);
  [[nodiscard]] bool follows(std::int64_t stamp_us, const Reading& reading) const;
  void accept(std::int64_t stamp_us, const Reading& reading);
  Verdict reject(std::uint16_t& counter);
  [[nodiscard]] bool in_range(const Reading& reading) const;
  [[nodiscard]] bool reachable(const Reading& reading, std::uint32_t periods) const;
  static std::uint32_t periods_of(std::uint64_t elapsed_us);
  [[nodiscard]] bool stuck(std::int32_t torque_mnm);
  [[nodiscard]] bool is_flat(const Reading& reading) const {
    return equation_ == Equation::kBar && reading.opposing_mnm == last_.opposing_mnm;
  }
  static void count(std::uint16_t& counter) {
    if (counter < UINT16_MAX) ++counter;
  }

  std::int64_t stamp_us_ = 0;  ///< of the last accepted sample
  Reading last_;
  std::int32_t angle_step_urad_ = 0;
  const InputLimits* limits_;
  std::int32_t torque_then_mnm_ = 0;  ///< when the angle stopped
  InputCounters counters_;
  std::uint8_t unmoved_ = 0;  ///< samples; and likewise of a torsion bar's torque
  std::uint8_t flat_ = 0;
  std::uint8_t ticks_without_ = 0;
  std::uint8_t disputed_ = 0;  ///< refusals in a row that only hold if the last accepted sample is right
  Equation equation_ = Equation::kNone;
  Equation other_ = Equation::kNone;  ///< that refused samples allow
  std::uint8_t other_samples_ = 0;    ///< in a row that allow it
  bool any_ = false;
};

inline InputSupervision::Verdict InputSupervision::judge(const Sample& sample, int& missing, std::int32_t asked_mnm) {
  if (!usable(sample)) return reject(counters_.invalid_channel);
  const Reading reading = reading_of(sample, asked_mnm);
  if (!in_range(reading)) return reject(counters_.out_of_range);
  if (!follows(sample.stamp_us, reading)) return judge_closely(sample.stamp_us, reading, missing);
  unmoved_ = flat_ = 0;
  accept(sample.stamp_us, reading);
  return Verdict::kUse;
}

/// Of a sample that lacks a channel of the equation, or that comes before there is one: whether it may be used by
/// another one, which holds from then on.
[[gnu::cold, gnu::noinline]] inline bool InputSupervision::agreed_equation(const Sample& sample) {
  const Equation allowed = equation_of(sample.valid_bits);
  if (allowed != other_) other_samples_ = 0;
  other_ = allowed;
  if (allowed == Equation::kNone) return false;
  if (++other_samples_ < kAcceptEquation && equation_ != Equation::kNone) return false;
  equation_ = allowed;
  other_samples_ = 0;
  any_ = false;  // the torque is another one: nothing to compare the sample with
  return true;
}

/// What nearly every sample is: one period after the last one, where the wheel can be by then, and moved.
inline bool InputSupervision::follows(std::int64_t stamp_us, const Reading& reading) const {
  const std::uint64_t elapsed = static_cast<std::uint64_t>(stamp_us) - static_cast<std::uint64_t>(stamp_us_);
  return any_ && periods_of(elapsed) == 1 && reading.angle_urad != last_.angle_urad && !is_flat(reading) && !still() &&
         reachable(reading, 1);
}

inline void InputSupervision::accept(std::int64_t stamp_us, const Reading& reading) {
  stamp_us_ = stamp_us;
  angle_step_urad_ = reading.angle_urad - last_.angle_urad;
  last_ = reading;
  any_ = true;
  ticks_without_ = 0;
  disputed_ = 0;
}

[[gnu::cold, gnu::noinline]] inline InputSupervision::Verdict InputSupervision::judge_closely(std::int64_t stamp_us,
                                                                                              const Reading& reading,
                                                                                              int& missing) {
  std::uint32_t periods = 0;
  bool restart = !any_;
  if (any_) {
    // Unsigned: two's complement differences are defined whatever the stamps are.
    const auto elapsed =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(stamp_us) - static_cast<std::uint64_t>(stamp_us_));
    if (elapsed == 0) return reject(counters_.repeated);
    if (elapsed < 0) {
      if (++disputed_ < kAcceptAnyway) return reject(counters_.out_of_order);
      restart = true;
    } else {
      periods = periods_of(static_cast<std::uint64_t>(elapsed));
      if (periods == 0) return reject(counters_.repeated);
      if (!reachable(reading, periods)) {
        if (++disputed_ < kAcceptAnyway) return reject(counters_.spike);
        restart = true;
      }
    }
  }
  disputed_ = 0;
  restart = restart || still();
  flat_ = !any_ || !is_flat(reading) ? 0 : flat_ < kStillSamples ? flat_ + 1 : flat_;
  if (!any_ || reading.angle_urad != last_.angle_urad) {
    unmoved_ = 0;
  } else if (stuck(reading.torque_mnm())) {
    return reject(counters_.stuck);
  }
  accept(stamp_us, reading);
  if (still()) return Verdict::kStill;
  missing = restart ? 0 : static_cast<int>(periods > kLongestBridge ? kLongestBridge + 1 : periods) - 1;
  if (!restart && missing > 0) count(counters_.accepted_after_gap);
  if (restart || missing >= kLongestBridge) return Verdict::kResettle;
  return missing > 0 ? Verdict::kBridge : Verdict::kUse;
}

inline void InputSupervision::tick_without_sample() {
  if (ticks_without_ < kFaultAfter) ++ticks_without_;
}

inline InputSupervision::Verdict InputSupervision::reject(std::uint16_t& counter) {
  count(counter);
  tick_without_sample();
  return Verdict::kReject;
}

inline bool InputSupervision::in_range(const Reading& reading) const {
  // Unsigned, what is below the lower limit is far above the upper one: one comparison.
  const auto within = [](std::int32_t value, std::int32_t limit) {
    const auto half = static_cast<std::uint32_t>(limit);
    return static_cast<std::uint32_t>(value) + half <= 2 * half;
  };
  return within(reading.angle_urad, limits_->angle_urad) && within(reading.voluntary_mnm, limits_->torque_mnm) &&
         within(reading.opposing_mnm, limits_->torque_mnm) && within(reading.probe_mnm, limits_->torque_mnm);
}

/// To the nearest. A gap of minutes is as long as one of hours, so that 32 bits are enough to divide.
inline std::uint32_t InputSupervision::periods_of(std::uint64_t elapsed_us) {
  constexpr std::uint32_t kPeriod = kTickPeriodUs;
  if (elapsed_us < kPeriod + kPeriod / 2) return elapsed_us >= kPeriod / 2 ? 1 : 0;  // nearly always
  if (elapsed_us > UINT32_MAX / 2) return UINT32_MAX / 2 / kPeriod;
  return (static_cast<std::uint32_t>(elapsed_us) + kPeriod / 2) / kPeriod;
}

[[gnu::noinline]] inline bool InputSupervision::reachable(const Reading& reading, std::uint32_t periods) const {
  // After a quarter of a second a wheel can be anywhere in its range.
  if (periods > 25) return true;
  const auto near = [periods](std::int32_t now, std::int32_t before, std::int32_t step) {
    // Unsigned, the difference of any two fits.
    const auto a = static_cast<std::uint32_t>(now);
    const auto b = static_cast<std::uint32_t>(before);
    const std::uint32_t moved = now > before ? a - b : b - a;
    const auto once = static_cast<std::uint32_t>(step);
    return moved <= once || (periods > 1 && moved <= static_cast<std::uint64_t>(once) * periods);
  };
  return near(reading.angle_urad, last_.angle_urad, limits_->angle_step_urad) &&
         near(reading.voluntary_mnm, last_.voluntary_mnm, limits_->torque_step_mnm) &&
         near(reading.opposing_mnm, last_.opposing_mnm, limits_->torque_step_mnm);
}

/// Of a sample whose angle is the one before.
inline bool InputSupervision::stuck(std::int32_t torque_mnm) {
  if (unmoved_ == 0) torque_then_mnm_ = last_.torque_mnm();
  if (unmoved_ < kStuck - 1) ++unmoved_;
  const std::int32_t moved = torque_mnm - torque_then_mnm_;
  if (unmoved_ >= limits_->stuck_samples && (moved < 0 ? -moved : moved) > limits_->stuck_torque_mnm) unmoved_ = kStuck;
  return unmoved_ == kStuck;
}

}  // namespace steerid
