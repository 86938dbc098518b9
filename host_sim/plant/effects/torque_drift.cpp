// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A torque offset that creeps through the record, as a warming bridge does: T_driver + d (1 - exp(-t/T)) is written
// down.
//
// t counts from the record's origin. A time constant far above the record's length makes it a ramp of d/T.
// Signature: residual below 0.05 Hz, with a trend. Source: first-order thermal drift of strain-gauge torque sensors.
#include <cmath>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"drift_nm", 1.0, -20.0, 20.0, 0.05, "offset d that it creeps to"},
    Parameter{"time_constant_s", 30.0, 1.0, 1000.0, 5.0, "T"},
};

class TorqueDrift final : public RecordEffect {
 public:
  explicit TorqueDrift(std::span<const double> values) : drift_nm_(values[0]), time_constant_s_(values[1]) {}
  void record(Channels& now) override { now.torque_driver_nm -= torque_correction_nm(now.time_s); }
  [[nodiscard]] bool corrects_torque() const override { return drift_nm_ != 0; }
  [[nodiscard]] double torque_correction_nm(double time_s) const override {
    return time_s <= 0 ? 0 : drift_nm_ * std::expm1(-time_s / time_constant_s_);
  }

 private:
  double drift_nm_;
  double time_constant_s_;
};

}  // namespace

constinit const EffectType torque_drift{
    .id = "torque_drift",
    .says = "a torque offset that creeps through the record",
    .parameters = kParameters,
    .on_record = record_effect<TorqueDrift>,
};

}  // namespace steerid::effect
