// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Lost samples, in bursts (Gilbert's two-state model): of two neighbouring samples the second is
//   lost after a lost one with probability 1 - 1/mean_run, lost after a good one with
//   probability fraction / (mean_run (1 - fraction)),
// so that the share `fraction` of all samples is lost and a loss lasts `mean_run` samples on average.
// On a channel the last good value is repeated; on the whole message nothing arrives.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sensors/during.hpp"
#include "sensors/random.hpp"

namespace steerid::sensor {

struct Dropout {
  double fraction = 0;   ///< share of samples lost, 0 to 0.9; 0 is off
  double mean_run = 1;   ///< samples lost in a row on average, >= 1
  bool flagged = false;  ///< clears the channel's valid bit; otherwise the receiver cannot know
  During during;
};

/// The running state of a Dropout.
class DropoutProcess {
 public:
  explicit DropoutProcess(const Dropout& dropout)
      : dropout_(dropout),
        start_(std::min(1.0, dropout.fraction / (dropout.mean_run * (1.0 - dropout.fraction)))),
        stay_(1.0 - 1.0 / dropout.mean_run) {}

  /// Whether the sample at `instant_us` is lost. Call once for each sample.
  [[nodiscard]] bool lost(std::int64_t instant_us, Random& random) {
    if (dropout_.fraction == 0.0) return false;
    lost_ = random.uniform() < (lost_ ? stay_ : start_);
    return lost_ && dropout_.during.covers(instant_us);
  }

 private:
  Dropout dropout_;
  double start_;
  double stay_;
  bool lost_ = false;
};

}  // namespace steerid::sensor
