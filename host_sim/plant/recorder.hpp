// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a measuring chain makes of the wheel, one sample at a time: the record effects in their order.
// FreeRun (plant/free_run.hpp) uses the same effects the other way round.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "plant/effects/effect.hpp"

namespace steerid {

class Recorder {
 public:
  Recorder(std::span<const Effect> effects, const RunSetting& setting);

  /// Turns the true channels into what reaches the converters: shifts, lags, offsets, limits. Sensors add their noise
  /// to the result. Once a sample, in order of time.
  void before_noise(Channels& sample);

  /// Turns noisy channels into what is written down: resolution, lost samples.
  void after_noise(Channels& sample);

 private:
  std::vector<std::unique_ptr<RecordEffect>> effects_;
};

/// The record effects among `effects`, in order.
[[nodiscard]] std::vector<std::unique_ptr<RecordEffect>> record_effects(std::span<const Effect> effects,
                                                                        const RunSetting& setting);

}  // namespace steerid
