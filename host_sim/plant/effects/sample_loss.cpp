// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Lost angle samples: the last value is repeated, each sample lost with the same probability.
//
// Signature: exact repeats of the angle while the wheel moves.
// In a replay the record itself shows which samples were lost, so the prediction repeats where the record does.
#include <cstdint>
#include <random>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"loss_probability", 0.1, 0.0, 0.9, 0.01, "part of the angle samples that is lost"},
};

class SampleLoss final : public RecordEffect {
 public:
  SampleLoss(std::span<const double> values, const RunSetting& setting)
      : probability_(values[0]), draw_(setting.seed ^ 0x5a3b1e55ULL) {}

  [[nodiscard]] bool converter() const override { return true; }

  void record(Channels& now) override {
    // The top 53 bits as a number in [0, 1): the same on every platform, unlike std::bernoulli_distribution.
    const bool lost = 0x1p-53 * static_cast<double>(draw_() >> 11U) < probability_;
    if (lost && started_) now.angle_rad = held_rad_;
    held_rad_ = now.angle_rad;
    started_ = true;
  }

  void record(Trajectory& run) const override {
    if (probability_ == 0) return;
    for (std::size_t i = 1; i < run.recorded_angle_rad.size() && run.first + i < run.angle_rad.size(); ++i) {
      if (run.recorded_angle_rad[i] == run.recorded_angle_rad[i - 1]) {
        run.angle_rad[run.first + i] = run.angle_rad[run.first + i - 1];
      }
    }
  }

 private:
  double probability_;
  std::mt19937_64 draw_;
  bool started_ = false;
  double held_rad_ = 0;
};

std::unique_ptr<RecordEffect> make(std::span<const double> values, const RunSetting& setting) {
  return std::make_unique<SampleLoss>(values, setting);
}

}  // namespace

constinit const EffectType sample_loss{
    .id = "sample_loss",
    .says = "lost angle samples, the last value repeated",
    .parameters = kParameters,
    .on_record = make,
};

}  // namespace steerid::effect
