// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A constant offset on the torque channel: written down is T_driver + b. An angle offset of -b/C is the same thing.
//
// Signature: the mean of the record. Beside dry friction it is asymmetric_friction.
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"bias_nm", 0.3, -20.0, 20.0, 0.02, "offset b on the recorded torque"},
};

class TorqueBias final : public RecordEffect {
 public:
  explicit TorqueBias(std::span<const double> values) : bias_nm_(values[0]) {}
  void record(Channels& now) override { now.torque_driver_nm += bias_nm_; }
  [[nodiscard]] bool corrects_torque() const override { return bias_nm_ != 0; }
  [[nodiscard]] double torque_correction_nm(double) const override { return -bias_nm_; }

 private:
  double bias_nm_;
};

}  // namespace

constinit const EffectType torque_bias{
    .id = "torque_bias",
    .says = "a constant offset on the torque channel",
    .parameters = kParameters,
    .on_record = record_effect<TorqueBias>,
};

}  // namespace steerid::effect
