// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An angle resolution far coarser than the noise: written down is the nearest multiple of the step.
//
// Signature: few distinct angles; the residual is a saw tooth of the angle, within half a step.
#include <cmath>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"step_rad", 0.05, 0.0, 0.5, 0.005, "distance between neighbouring readings"},
};

class CoarseQuantization final : public RecordEffect {
 public:
  explicit CoarseQuantization(std::span<const double> values) : step_rad_(values[0]) {}
  [[nodiscard]] bool converter() const override { return true; }
  void record(Channels& now) override { now.angle_rad = nearest(now.angle_rad); }
  void record(Trajectory& run) const override {
    for (double& angle : run.angle_rad) angle = nearest(angle);
  }

 private:
  [[nodiscard]] double nearest(double angle) const {
    return step_rad_ > 0 ? step_rad_ * std::round(angle / step_rad_) : angle;
  }
  double step_rad_;
};

}  // namespace

constinit const EffectType coarse_quantization{
    .id = "coarse_quantization",
    .says = "an angle resolution far coarser than the noise",
    .parameters = kParameters,
    .on_record = record_effect<CoarseQuantization>,
};

}  // namespace steerid::effect
