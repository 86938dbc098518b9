// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the driver is doing, for a take-over function: from the identified J, B and C with their standard deviations.
//
//   hands_off  nobody holds the wheel
//   relaxed    an arm that steers
//   braced     an arm that holds against something
//
// Co-contraction shows in the stiffness: with one arm C is 4.5 to 13.1 Nm/rad in the active task and 13.0 to 80.5 in
// the passive one (Lv et al. 2018, tables I and II); both arms are some 1.3 times as stiff. Each decision compares the
// interval value +- 2 sd with two limits and leaves the state alone between them, which is its hysteresis:
//
//   C below 2 Nm/rad      hands_off: a wheel's own centring without a column, 1 Nm/rad. A finger adds 1 to 3 Nm/rad:
//                         from 2 to 4 it is `unknown`. Above 4 somebody holds it: no arm in the tables is below 4.5.
//   C above 17            braced: stiffer than any steering arm, or pair of arms
//   C from 4 to 13        relaxed: softer than any bracing arm
//   C between 13 and 17   C/B decides where B is valid: above 9 /s braced, below 7 /s relaxed.
//
// Nominal arms have a C/B of 15 to 24 /s in the passive task and of 3.1 to 3.5 /s in the active one, the same with one
// arm and two, since both hands raise B as well.
//
// Above a torsion bar the identifier tells by itself that nobody holds the wheel (identifier/hands.hpp). From a
// probability of 0.99 on, kept for a second, that is hands_off, whatever is valid: a false hands_off counts as
// ninety-nine missed refreshes, and fingers that pull nothing for half a second are no release. It ends where somebody
// is as likely as nobody: hands that come back are told within some looks, and an empty wheel hovers about 0.99.
// docs/adr/0007 has what others give.
//
// A new state has to be seen kConfirm times in a row. It is told only while C is `valid`, and hands_off also while J is
// and C is known to be about zero, which is no share of itself: at any other time, in a fault above all, the answer is
// `unknown`, and what was decided before is forgotten.
//
// Nothing is told either while hardly any torque acts (0.1 Nm, mean over 0.6 s): then the sensors' noise is all
// there is to identify from.
//
// And hands_off contradicts a driver's torque: while more than 0.06 Nm of it is measured (mean size; the sensor's own
// noise makes half of that) somebody holds the wheel whatever the parameters say, and the answer is unknown.
//
// Hands. Drivers' inertias differ far more than one arm from two (0.02 to 0.18 kg m2 against a factor of about 1.15),
// so an inertia alone seldom tells: above 0.18 it takes two arms. Within one drive the same driver's inertia changes
// with his hands only: a rise by 8 % and more is a second hand that came, such a fall one that left. It
// is searched for while the state is known and J is `valid` to 2 %, told while J is at least held, and ends with
// hands_off.
//
// Integers only, in the port's micro-units. Memory 12 bytes; some 30 operations, every kTicks ticks.
#pragma once

#include <cstdint>

#include "port/estimate.hpp"

namespace steerid {

struct DriverEvidence {
  ParameterEstimate inertia;
  ParameterEstimate damping;
  ParameterEstimate stiffness;
  std::int32_t torque_mnm = 0;         ///< mean size of what acts on the wheel, over 0.6 s
  std::int32_t torque_driver_mnm = 0;  ///< of the driver's part, likewise
  std::int32_t released_micro = 0;     ///< 1e-6: probability that nobody holds the wheel; of a torsion bar only
  bool above_bar = false;              ///< that it is known; C alone then tells of no release
};

/// All in micro-units but the rates.
struct DriverStateLimits {
  std::int32_t hands_off_below = 2'000'000;
  std::int32_t hands_on_above = 4'000'000;
  std::int32_t relaxed_below = 13'000'000;
  std::int32_t braced_above = 17'000'000;
  std::int32_t relaxed_below_per_s = 7;  ///< C/B
  std::int32_t braced_above_per_s = 9;
  /// J
  std::int32_t two_hands_above = 180'000;
  std::int32_t hand_percent = 8;  ///< of J, when a hand comes or leaves
  std::int32_t least_torque_mnm = 100;
  std::int32_t hands_torque_mnm = 60;  ///< of the driver: somebody holds the wheel
  std::int32_t released_above = 990'000;
  std::int32_t still_released_above = 500'000;
};

class DriverStateObserver {
 public:
  static constexpr int kTicks = 10;         ///< from one take() to the next
  static constexpr int kConfirm = 3;        ///< take()s that have to agree on a new state, ...
  static constexpr int kConfirmHands = 10;  ///< ... and on a new number of hands, or that a torsion bar tells of none

  void take(const DriverEvidence& now);

  /// The state and the hands to publish beside parameters in these states, and these torques.
  [[nodiscard]] DriverState state(const DriverEvidence& now) const {
    if (!tells(now)) return DriverState::kUnknown;
    if (state_ == DriverState::kHandsOff && held(now)) return DriverState::kUnknown;
    return state_;
  }
  [[nodiscard]] HandCount hands(const DriverEvidence& now) const { return hands(state(now), now.inertia.state); }
  [[nodiscard]] HandCount hands(DriverState state, ParameterState inertia) const {
    switch (state) {
      case DriverState::kUnknown:
        return HandCount::kUnknown;  // hands that leave the wheel look like one that does, for a moment
      case DriverState::kHandsOff:
        return HandCount::kNone;
      case DriverState::kRelaxed:
      case DriverState::kBraced:
        break;
    }
    const bool known = inertia == ParameterState::kValid || inertia == ParameterState::kHolding;
    return known ? hands_ : HandCount::kUnknown;
  }

 private:
  /// In 16 micro-units: nine times the largest value, or a value and two deviations of that size, still fit.
  static constexpr std::int32_t coarse(std::int32_t micro) { return micro / 16; }
  /// value +- 2 sd, coarse
  struct Range {
    explicit Range(const ParameterEstimate& p)
        : low(coarse(p.value_micro) - 2 * coarse(p.sd_micro)), high(coarse(p.value_micro) + 2 * coarse(p.sd_micro)) {}
    std::int32_t low, high;
  };

  [[nodiscard, gnu::noinline]] bool released(const DriverEvidence& now) const {
    return now.released_micro >
           (state_ == DriverState::kHandsOff ? limits_.still_released_above : limits_.released_above);
  }
  [[nodiscard, gnu::noinline]] bool tells(const DriverEvidence& now) const { return released(now) || shown(now); }
  [[nodiscard]] bool shown(const DriverEvidence& now) const {
    return now.torque_mnm >= limits_.least_torque_mnm &&
           (now.stiffness.state == ParameterState::kValid ||
            (now.inertia.state == ParameterState::kValid && springless(now)));
  }
  /// A stiffness of about zero is never known to a share of itself, and so never valid.
  [[nodiscard]] bool springless(const DriverEvidence& now) const {
    return Range(now.stiffness).high < coarse(limits_.hands_off_below);
  }
  [[nodiscard]] bool held(const DriverEvidence& now) const { return now.torque_driver_mnm > limits_.hands_torque_mnm; }
  [[nodiscard]] DriverState seen(const DriverEvidence& now) const;
  [[nodiscard]] DriverState by_stiffness(const Range& stiffness, const DriverEvidence& now) const;
  [[nodiscard]] HandCount hands_seen(const Range& inertia) const;
  /// Valid, and to 2 %: a first answer is often off by as much as a hand makes.
  [[nodiscard]] static bool precise(const ParameterEstimate& inertia) {
    return inertia.state == ParameterState::kValid && inertia.sd_micro < inertia.value_micro / 50;
  }
  void count_hands(const ParameterEstimate& inertia);
  void forget_hands();

  static constexpr DriverStateLimits limits_{};
  DriverState state_ = DriverState::kUnknown;
  DriverState candidate_ = DriverState::kUnknown;
  HandCount hands_ = HandCount::kUnknown;
  HandCount hands_candidate_ = HandCount::kUnknown;
  std::int32_t inertia_before_ = 0;  ///< of the present hands, micro-units; 0 before it was valid
  std::uint8_t agreed_ = 0;
  std::uint8_t hands_agreed_ = 0;
};

inline DriverState DriverStateObserver::seen(const DriverEvidence& now) const {
  if (released(now)) return DriverState::kHandsOff;
  if (springless(now)) return held(now) || now.above_bar ? DriverState::kUnknown : DriverState::kHandsOff;
  const Range stiffness(now.stiffness);
  if (stiffness.low > coarse(limits_.hands_on_above)) return by_stiffness(stiffness, now);
  const bool touched =
      stiffness.low > coarse(limits_.hands_off_below) && stiffness.high < coarse(limits_.hands_on_above);
  return touched ? DriverState::kUnknown : state_;
}

inline DriverState DriverStateObserver::by_stiffness(const Range& stiffness, const DriverEvidence& now) const {
  if (stiffness.low > coarse(limits_.braced_above)) return DriverState::kBraced;
  if (stiffness.high < coarse(limits_.relaxed_below)) return DriverState::kRelaxed;
  // A hand that came back is neither yet.
  const DriverState kept = state_ == DriverState::kHandsOff ? DriverState::kUnknown : state_;
  if (now.damping.state != ParameterState::kValid) return kept;
  const Range damping(now.damping);
  if (stiffness.low > limits_.braced_above_per_s * damping.high) return DriverState::kBraced;
  if (stiffness.high < limits_.relaxed_below_per_s * damping.low) return DriverState::kRelaxed;
  return kept;
}

inline void DriverStateObserver::take(const DriverEvidence& now) {
  if (!tells(now)) {
    state_ = DriverState::kUnknown;
    agreed_ = 0;
  } else {
    const DriverState next = seen(now);
    const int enough = next == DriverState::kHandsOff && now.above_bar ? kConfirmHands : kConfirm;
    if (next != candidate_) agreed_ = 0;
    candidate_ = next;
    if (++agreed_ >= enough) {
      agreed_ = static_cast<std::uint8_t>(enough);
      state_ = next;
    }
  }
  const bool nobody = state_ == DriverState::kHandsOff;
  const bool lost = now.inertia.state == ParameterState::kFault || now.inertia.state == ParameterState::kStarting;
  if (!nobody && state_ != DriverState::kUnknown && precise(now.inertia)) {
    count_hands(now.inertia);
  } else if (nobody || lost) {
    forget_hands();
  }
}

inline HandCount DriverStateObserver::hands_seen(const Range& inertia) const {
  if (inertia.low > coarse(limits_.two_hands_above)) return HandCount::kTwo;
  if (inertia_before_ == 0) return hands_;
  const std::int32_t before = coarse(inertia_before_);
  const std::int32_t hand = before / 100 * limits_.hand_percent;
  if (inertia.low > before + hand) return HandCount::kTwo;
  if (inertia.high < before - hand) return HandCount::kOne;
  return hands_;
}

inline void DriverStateObserver::count_hands(const ParameterEstimate& inertia) {
  const HandCount next = hands_seen(Range(inertia));
  if (next != hands_candidate_) hands_agreed_ = 0;
  hands_candidate_ = next;
  if (++hands_agreed_ < kConfirmHands) return;
  hands_agreed_ = kConfirmHands;
  // With the hands as they were the inertia to compare with follows slowly, with new ones it is theirs.
  if (next != hands_ || inertia_before_ == 0) {
    inertia_before_ = inertia.value_micro;
  } else {
    inertia_before_ += (inertia.value_micro - inertia_before_) / 128;  // neither is negative
  }
  hands_ = next;
}

inline void DriverStateObserver::forget_hands() {
  hands_ = HandCount::kUnknown;
  hands_candidate_ = HandCount::kUnknown;
  hands_agreed_ = 0;
  inertia_before_ = 0;
}

}  // namespace steerid
