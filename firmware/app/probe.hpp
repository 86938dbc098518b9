// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe that the task asks the EPS for: three sines, where the arm shows most, as large as the accuracy that is
// asked needs, and none once it is reached.
//
//   lines     at the resonance of the arm as it is known now, sqrt(C / J) / 2 pi within 1.5 and 3.5 Hz, and 0.8 Hz
//             above it, with 35 % of the power each, and 5.5 Hz with 30 %, which tells J from C. Before anything is
//             known that is the prior's arm: 2.3, 3.1 and 5.5 Hz. docs/column.md has the bound that they make
//   size      rms = 4 (r - 1) needed, none below r = 1. r is the largest deviation over what is asked of it; `needed`
//             is the rms with which the information of 30 s makes the asked deviation
//             (ClosedLoopIdentifier::probe_needed_nm). As long as nobody knows that, it is ProbeLimits::rms_mnm
//   limits    ProbeLimits::rms_mnm, and amplitude_mnm for the sum of all lines at their peak
//   ramps     the size follows with a time constant of 2.56 s: faster than a deviation moves, much slower than the
//             lines swing, so that it makes no lines of its own
//   rate      ProbeLimits::rate_mnm_per_tick bounds the change from tick to tick, whatever happens but a cut
//   start     only when allowed (off by default), wanted for 3 s without a break, and never on a fault
//   rest      where 30 s at its limit have brought none of the three to twice what is asked, nothing comes of it: it
//             fades, and does not begin again for 60 s
//   cut       to 0 within the same tick on a fault, when permission is withdrawn, or when the driver steers strongly:
//             more torque or a faster wheel than the limits say. 60 s without it follow.
//
// The size follows from deviations and from the mean noise of half a minute, the phases from nothing: no driver moves
// them, and the probe stays an instrument.
//
// Integers only: each line is a cosine of its phase, by a polynomial of fifth order in Q30 within 1.1e-4 of its
// amplitude. No table, no libm, no float; some 100 integer operations a tick while the probe runs.
#pragma once

#include <cstdint>

namespace steerid {

struct ProbeLimits {
  std::int32_t amplitude_mnm = 3'000;      ///< largest torque asked for
  std::int32_t rms_mnm = 1'000;            ///< largest root mean square
  std::int32_t rate_mnm_per_tick = 500;    ///< largest change a tick
  std::int32_t driver_torque_mnm = 4'000;  ///< a driver who applies more is steering
  std::int32_t wheel_step_urad = 30'000;   ///< a wheel that turns further in a tick (3 rad/s) is being steered
  /// Of J, B and C: the relative standard deviation that is asked. Below the tenth at which the steady identifier calls
  /// a parameter learned, or what is asked would never be called valid.
  std::int32_t asked_permille[3] = {80, 80, 80};
};

/// What the identifier says, ten times a second. Ratios are in 256ths, of a deviation over the one that is asked.
struct ProbeNeed {
  std::int32_t worst_256 = 0;       ///< of the parameter that is least known
  std::int32_t best_256 = 0;        ///< of the one that is known best
  std::int32_t needed_mnm = 0;      ///< rms that makes the asked deviations within 30 s; 0: not known now
  std::int32_t resonance_dhz = 23;  ///< of the arm, tenths of a hertz
};

/// What the probe has to know of the present tick.
struct ProbeConditions {
  bool allowed = false;  ///< the vehicle permits a probe now
  bool fault = false;
  std::int32_t torque_driver_mnm = 0;
  std::int32_t angle_step_urad = 0;  ///< since the sample before
};

class Probe {
 public:
  static constexpr ProbeLimits kGentle{};

  /// `limits` are not copied: they have to live as long as the probe does.
  explicit Probe(const ProbeLimits& limits = kGentle) : limits_(&limits) {}
  explicit Probe(const ProbeLimits&& passing) = delete;

  /// What to aim at from now on.
  void aim(const ProbeNeed& need);
  /// The torque to ask for on this tick, mNm.
  std::int32_t next(const ProbeConditions& now);

  /// Root mean square of the lines as they are now, mNm; 0 while it is off.
  [[nodiscard]] std::int32_t size_mnm() const { return size_256_ / 256; }
  [[nodiscard]] const ProbeLimits& limits() const { return *limits_; }

 private:
  static constexpr int kLines = 3;
  static constexpr std::int32_t kOne = 1 << 30;
  static constexpr std::int32_t kFollow = 256;  ///< ticks, 2.56 s
  static constexpr std::int32_t kSteep = 4;     ///< the size is `needed` where r is 1.25
  static constexpr std::int16_t kPatience = 300;
  static constexpr std::int16_t kLongest = 3000;
  static constexpr std::int16_t kPause = 6000;
  static constexpr std::int32_t kHopeless = 512;                                       ///< twice what is asked
  static constexpr std::int32_t kApart = 8, kLowest = 15, kHighest = 35, kUpper = 55;  ///< tenths of a hertz
  /// Amplitudes over the rms in Q10, sqrt(2 times the share of the power), and all of them together.
  static constexpr std::int32_t kTwo = 857, kThird = 793, kAll = 2 * kTwo + kThird;

  static std::int32_t product(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>((static_cast<std::int64_t>(a) * b + (1 << 29)) >> 30);
  }
  static std::int32_t cosine(std::uint32_t turn);
  std::int32_t turn();
  [[nodiscard]] std::int32_t most() const;
  [[nodiscard]] bool steered(const ProbeConditions& now) const;
  void cut();
  void follow();

  const ProbeLimits* limits_;
  std::uint32_t phase_[kLines] = {};  ///< 2^-32 turns
  std::int32_t torque_mnm_ = 0;
  std::int32_t size_256_ = 0;    ///< rms, 256ths of a millinewton metre
  std::int32_t target_mnm_ = 0;  ///< where the size goes
  std::int32_t needed_mnm_ = 0;  ///< as last known; 0: never
  std::int16_t hopeless_ = 0;    ///< ticks at the limit with nothing known
  std::int16_t waited_ = 0;
  std::int16_t pause_ = 0;
  std::int8_t resonance_dhz_ = 23;
  bool known_nothing_ = true;
};

/// Of 2^-32 turns, Q30: sin(pi/2 z) of the triangle z = 1 - 4 |turn|.
inline std::int32_t Probe::cosine(std::uint32_t turn) {
  const std::uint32_t size = turn > UINT32_MAX / 2 ? 0U - turn : turn;  // half a turn at most
  const auto z = static_cast<std::int32_t>(static_cast<std::uint32_t>(kOne) - size);
  const std::int32_t square = product(z, z);
  // z (1.5706268 - z^2 (0.6432292 - 0.0727102 z^2)); the half of it first, which fits Q30.
  return 2 * product(z, 843223842 - product(square, 345331047 - product(square, 39035991)));
}

/// The lines at a rms of 1, Q28; then on by a tick.
inline std::int32_t Probe::turn() {
  constexpr std::uint32_t kTenthHz = 4294967;  // 2^32 / 1000 ticks; 7e-8 less than it
  const std::int32_t dhz[kLines] = {resonance_dhz_, resonance_dhz_ + kApart, kUpper};
  std::int64_t sum = 0;
  for (int i = 0; i < kLines; ++i) {
    sum += static_cast<std::int64_t>(i < 2 ? kTwo : kThird) * cosine(phase_[i]);
    phase_[i] += static_cast<std::uint32_t>(dhz[i]) * kTenthHz;
  }
  return static_cast<std::int32_t>(sum >> 12);
}

/// The largest rms that all limits allow.
inline std::int32_t Probe::most() const {
  const auto by_peak = static_cast<std::int32_t>(static_cast<std::int64_t>(limits_->amplitude_mnm) * 1024 / kAll);
  return by_peak < limits_->rms_mnm ? by_peak : limits_->rms_mnm;
}

inline void Probe::aim(const ProbeNeed& need) {
  const std::int32_t most = this->most();
  if (need.needed_mnm > 0) needed_mnm_ = need.needed_mnm < most ? need.needed_mnm : most;
  const std::int32_t basis = needed_mnm_ > 0 ? needed_mnm_ : most;
  const std::int64_t wished = static_cast<std::int64_t>(basis) * kSteep * (need.worst_256 - 256) / 256;
  target_mnm_ = wished <= 0 ? 0 : wished < most ? static_cast<std::int32_t>(wished) : most;
  known_nothing_ = need.best_256 > kHopeless;
  const std::int32_t dhz = need.resonance_dhz;
  resonance_dhz_ = static_cast<std::int8_t>(dhz < kLowest ? kLowest : dhz > kHighest ? kHighest : dhz);
}

inline bool Probe::steered(const ProbeConditions& now) const {
  const auto beyond = [](std::int32_t value, std::int32_t limit) { return value > limit || value < -limit; };
  return beyond(now.torque_driver_mnm, limits_->driver_torque_mnm) ||
         beyond(now.angle_step_urad, limits_->wheel_step_urad);
}

inline void Probe::cut() {
  if (size_256_ > 0) pause_ = kPause;
  size_256_ = 0;
  torque_mnm_ = 0;
  hopeless_ = 0;
  waited_ = 0;
}

/// The size on by a tick.
inline void Probe::follow() {
  const std::int32_t target = pause_ > 0 ? 0 : target_mnm_;
  if (size_256_ == 0) {
    waited_ = target > 0 ? static_cast<std::int16_t>(waited_ + 1) : std::int16_t{0};
    if (waited_ < kPatience) return;
    waited_ = 0;
  }
  size_256_ += (target * 256 - size_256_) / kFollow;
  if (size_256_ < 256 && target == 0) size_256_ = 0;
  const bool hopeless = known_nothing_ && target == most();
  hopeless_ = hopeless ? static_cast<std::int16_t>(hopeless_ + 1) : std::int16_t{0};
  if (hopeless_ < kLongest) return;
  hopeless_ = 0;
  pause_ = kPause;
}

inline std::int32_t Probe::next(const ProbeConditions& now) {
  if (pause_ > 0) --pause_;
  if (!now.allowed || now.fault || steered(now)) {
    cut();
    return 0;
  }
  follow();
  const auto wish = static_cast<std::int32_t>(static_cast<std::int64_t>(size_256_) * turn() / (std::int64_t{1} << 36));
  if (wish > torque_mnm_ + limits_->rate_mnm_per_tick) {
    torque_mnm_ += limits_->rate_mnm_per_tick;
  } else if (wish < torque_mnm_ - limits_->rate_mnm_per_tick) {
    torque_mnm_ -= limits_->rate_mnm_per_tick;
  } else {
    torque_mnm_ = wish;
  }
  return torque_mnm_;
}

}  // namespace steerid
