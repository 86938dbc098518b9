// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Both torque channels clipped at +-limit; the wheel felt the whole torque.
//
// Signature: flat tops in the torque, and an angle that goes further than the recorded torque explains.
// In a replay the clipped stretches are rebuilt from the torque on both sides of them (plant/hidden_samples.hpp), never
// below the limit. Peaks of a probe come back; what a long plateau hid cannot be known.
#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "plant/effects/vocabulary.hpp"
#include "plant/hidden_samples.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"limit_nm", 3.0, 0.05, 100.0, 0.1, "largest torque that can be written down"},
};

class TorqueSaturation final : public RecordEffect {
 public:
  explicit TorqueSaturation(std::span<const double> values) : limit_nm_(values[0]) {}

  void record(Channels& now) override {
    now.torque_driver_nm = std::clamp(now.torque_driver_nm, -limit_nm_, limit_nm_);
    now.torque_motor_nm = std::clamp(now.torque_motor_nm, -limit_nm_, limit_nm_);
  }

  [[nodiscard]] bool repairs_torque() const override { return true; }
  void repair_torque(std::span<double> torque_nm) const override {
    // A record is run again and again, and every run repairs it: the last ones are remembered.
    struct Repaired {
      double limit_nm;
      std::vector<double> clipped_nm;
      std::vector<double> filled_nm;
    };
    constexpr std::size_t kRemembered = 4;
    thread_local std::deque<Repaired> last;
    for (const Repaired& one : last) {
      if (one.limit_nm != limit_nm_ || !std::ranges::equal(one.clipped_nm, torque_nm)) continue;
      std::ranges::copy(one.filled_nm, torque_nm.begin());
      return;
    }
    Repaired now{limit_nm_, {torque_nm.begin(), torque_nm.end()}, {}};
    const HiddenSamples filled(torque_nm, clipped_stretches(torque_nm, limit_nm_), limit_nm_);
    now.filled_nm.assign(torque_nm.begin(), torque_nm.end());
    last.push_front(std::move(now));
    if (last.size() > kRemembered) last.pop_back();
  }

 private:
  double limit_nm_;
};

}  // namespace

constinit const EffectType torque_saturation{
    .id = "torque_saturation",
    .says = "torque channels clipped",
    .parameters = kParameters,
    .on_record = record_effect<TorqueSaturation>,
};

}  // namespace steerid::effect
