// Both torque channels clipped at +-limit; the wheel felt the whole torque.
//
// Signature: flat tops in the torque, and an angle that goes further than the recorded torque explains.
// In a replay the clipped stretches are rebuilt: a Hermite cubic from the last good sample to the next one, with the
// slopes of a line through the good samples beside the stretch, never below the limit. It suits peaks of a probe of a
// few hertz; what a long plateau hid cannot be known.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "plant/cubic.hpp"
#include "plant/effects/vocabulary.hpp"

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
    for (std::size_t begin = 0; begin < torque_nm.size();) {
      const int side = clipped(torque_nm[begin]);
      std::size_t end = begin + 1;
      while (end < torque_nm.size() && clipped(torque_nm[end]) == side) ++end;
      if (side != 0) rebuild(torque_nm, begin, end, side);
      begin = end;
    }
  }

 private:
  static constexpr double kNearly = 0.98;  // noise and anti-alias filters keep clipped samples off the exact limit
  static constexpr std::size_t kSlopeSamples = 3;

  [[nodiscard]] int clipped(double torque_nm) const {
    return torque_nm >= kNearly * limit_nm_ ? 1 : torque_nm <= -kNearly * limit_nm_ ? -1 : 0;
  }

  void rebuild(std::span<double> torque_nm, std::size_t begin, std::size_t end, int side) const {
    if (begin < kSlopeSamples || end + kSlopeSamples > torque_nm.size()) return;  // no good samples to lean on
    const auto slope = [&](std::size_t from) {
      return (torque_nm[from + kSlopeSamples - 1] - torque_nm[from]) / static_cast<double>(kSlopeSamples - 1);
    };
    const Cubic peak = Cubic::hermite(torque_nm[begin - 1], slope(begin - kSlopeSamples), torque_nm[end], slope(end),
                                      static_cast<double>(end - begin + 1));
    for (std::size_t i = begin; i < end; ++i) {
      const double value = peak.at(static_cast<double>(i - begin + 1));
      torque_nm[i] = side * std::max(side * value, limit_nm_);
    }
  }

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
