// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe that the task asks the EPS for while a parameter stays dark: a small, bounded multisine.
//
//   tones     0.2, 0.5, 0.9, 1.6, 2.8 and 5.0 Hz, each a multiple of 0.1 Hz: the sum repeats every 10 s
//   strength  ProbeLimits::amplitude_mnm is never exceeded: the tones' amplitudes add up to it at most
//   rate      ProbeLimits::rate_mnm_per_tick bounds the change from tick to tick, whatever happens but a cut
//   ramps     the envelope rises and falls in a straight line over 2 s
//   start     only when allowed (off by default), wanted for 3 s without a break, and never on a fault
//   end       soft after 10 s when nothing is dark any more, or after 30 s; then a pause of 60 s before the next
//   cut       to 0 within the same tick on a fault, when permission is withdrawn, or when the driver steers strongly:
//             more torque or a faster wheel than the limits say. The pause follows.
//
// Integers only, and no memory of the tones: each is a cosine of the tick, by a polynomial of fifth order in Q30 within
// 1.1e-4 of its amplitude. No table, no libm, no float; some 120 integer operations a tick while the probe runs.
#pragma once

#include <cstdint>

namespace steerid {

struct ProbeLimits {
  std::int32_t amplitude_mnm = 3'000;      ///< largest torque asked for
  std::int32_t rate_mnm_per_tick = 500;    ///< largest change a tick
  std::int32_t driver_torque_mnm = 4'000;  ///< a driver who applies more is steering
  std::int32_t wheel_step_urad = 30'000;   ///< a wheel that turns further in a tick (3 rad/s) is being steered
};

/// What the probe has to know of the present tick.
struct ProbeConditions {
  bool allowed = false;  ///< the vehicle permits a probe now
  bool dark = false;     ///< a parameter is not visible without one
  bool fault = false;
  std::int32_t torque_driver_mnm = 0;
  std::int32_t angle_step_urad = 0;  ///< since the sample before
};

class Probe {
 public:
  enum class Phase : std::uint8_t { kOff, kRising, kFull, kFalling };

  /// `limits` are not copied: they have to live as long as the probe does.
  explicit Probe(const ProbeLimits& limits = kGentle) : limits_(&limits) {}
  explicit Probe(const ProbeLimits&& passing) = delete;

  /// The torque to ask for on this tick, mNm.
  std::int32_t next(const ProbeConditions& now);

  [[nodiscard]] Phase phase() const { return phase_; }

 private:
  static constexpr int kTones = 6;
  static constexpr std::int32_t kOne = 1 << 30;
  static constexpr std::int16_t kPeriod = 1000;  ///< ticks, 10 s
  static constexpr std::int16_t kRamp = 200;     ///< ticks, 2 s
  static constexpr std::int16_t kPatience = 300;
  static constexpr std::int16_t kShortest = kPeriod;
  static constexpr std::int16_t kLongest = 3000;
  static constexpr std::int16_t kPause = 6000;

  /// How often it turns in kPeriod, and where it starts, in 2^-32 turns (phases that keep the peak at 0.62 of all six).
  struct Tone {
    std::uint32_t turns, start;
  };
  static constexpr Tone kTone[kTones] = {{2, 3140077883}, {5, 4080158737},  {9, 624155858},
                                         {16, 951593090}, {28, 1762662087}, {50, 301957200}};

  static std::int32_t product(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>((static_cast<std::int64_t>(a) * b + (1 << 29)) >> 30);
  }
  static std::int32_t cosine(std::uint32_t turn);
  std::int32_t turn();
  [[nodiscard]] bool steered(const ProbeConditions& now) const;
  void end();
  void move_phase(bool dark);

  static constexpr ProbeLimits kGentle{};
  const ProbeLimits* limits_;
  std::int32_t torque_mnm_ = 0;
  std::int16_t tick_ = 0;      ///< within the period
  std::int16_t envelope_ = 0;  ///< 0 to kRamp
  std::int16_t running_ = 0;
  std::int16_t waited_ = 0;
  std::int16_t pause_ = 0;
  Phase phase_ = Phase::kOff;
};

/// Of 2^-32 turns, Q30: sin(pi/2 z) of the triangle z = 1 - 4 |turn|.
inline std::int32_t Probe::cosine(std::uint32_t turn) {
  const std::uint32_t size = turn > UINT32_MAX / 2 ? 0U - turn : turn;  // half a turn at most
  const auto z = static_cast<std::int32_t>(static_cast<std::uint32_t>(kOne) - size);
  const std::int32_t square = product(z, z);
  // z (1.5706268 - z^2 (0.6432292 - 0.0727102 z^2)); the half of it first, which fits Q30.
  return 2 * product(z, 843223842 - product(square, 345331047 - product(square, 39035991)));
}

/// The sum of the tones, Q30 of all of them at their peak; then on by a tick.
inline std::int32_t Probe::turn() {
  constexpr std::uint32_t kTick = 4294967;  // 2^32 / kPeriod, 0.296 apart
  const auto tick = static_cast<std::uint32_t>(tick_);
  const std::uint32_t at = tick * kTick + tick * 296U / 1000U;
  std::int64_t sum = 0;
  for (const Tone& tone : kTone) sum += cosine(tone.start + tone.turns * at);
  if (++tick_ == kPeriod) tick_ = 0;
  return static_cast<std::int32_t>(sum / kTones);
}

inline bool Probe::steered(const ProbeConditions& now) const {
  const auto beyond = [](std::int32_t value, std::int32_t limit) { return value > limit || value < -limit; };
  return beyond(now.torque_driver_mnm, limits_->driver_torque_mnm) ||
         beyond(now.angle_step_urad, limits_->wheel_step_urad);
}

inline void Probe::end() {
  if (phase_ != Phase::kOff) pause_ = kPause;
  phase_ = Phase::kOff;
  envelope_ = 0;
  running_ = 0;
  waited_ = 0;
  torque_mnm_ = 0;
}

inline void Probe::move_phase(bool dark) {
  switch (phase_) {
    case Phase::kOff:
      waited_ = dark && pause_ == 0 ? static_cast<std::int16_t>(waited_ + 1) : std::int16_t{0};
      if (waited_ < kPatience) return;
      tick_ = 0;
      phase_ = Phase::kRising;
      return;
    case Phase::kRising:
      if (++envelope_ == kRamp) phase_ = Phase::kFull;
      return;
    case Phase::kFull:
      ++running_;
      if ((!dark && running_ >= kShortest) || running_ == kLongest) phase_ = Phase::kFalling;
      return;
    case Phase::kFalling:
      if (--envelope_ == 0) end();
      return;
  }
}

inline std::int32_t Probe::next(const ProbeConditions& now) {
  if (pause_ > 0) --pause_;
  if (!now.allowed || now.fault || steered(now)) {
    end();
    return 0;
  }
  move_phase(now.dark);
  if (phase_ == Phase::kOff) return 0;
  const std::int64_t peak = static_cast<std::int64_t>(limits_->amplitude_mnm) * envelope_ / kRamp;
  const auto wish = static_cast<std::int32_t>(peak * turn() / kOne);
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
