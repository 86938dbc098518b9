// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The filter before a record is brought to 100 Hz: a linear-phase windowed sinc (log/kaiser_sinc.hpp), the same for
// every channel, so that what it does to torque and to angle cancels in T = J th'' + B th' + C th. With f the lower of
// the record's rate and 100 Hz:
//
//   | pass band   | 0 to 0.3 f (30 Hz for faster records)  | within 1e-4 of one, no phase                     |
//   | stop band   | from 0.5 f (50 Hz for faster records)  | at least 80 dB down, so nothing aliases visibly  |
//   | half length | 2.86 / (0.2 f) (0.143 s)               | the filter is centred: zero phase, no delay      |
#pragma once

#include <cstddef>
#include <vector>

namespace steerid {

inline constexpr double kResampledRateHz = 100.0;

struct AntiAlias {
  double pass_hz;
  double stop_hz;
  double half_length_s;
};

/// For a record of `source_rate_hz`.
[[nodiscard]] AntiAlias anti_alias_for(double source_rate_hz);

/// The filter's impulse response over its half length, tabulated: the same curve for every rate, since cut-off times
/// half length is the same. Straight lines between 16384 points are 120 dB from it.
class AntiAliasKernel {
 public:
  AntiAliasKernel();
  /// At `share` of the half length from the centre, where it is 1; zero beyond.
  [[nodiscard]] double at(double share) const;

 private:
  std::vector<double> table_;
};

}  // namespace steerid
