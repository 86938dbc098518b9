// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/clock_drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/model/run_slopes.hpp"
#include "gap/sets/projection.hpp"

namespace steerid::gap {

std::optional<ClockDrift> clock_drift_left(const FittedSet& one, const SetFitter& fitter) {
  const SpectralRecord& record = fitter.setting().record;
  const std::vector<double>& rate_rad_s = record.motion.rate_rad_s;
  const double middle_s = span_of(record).middle_s();
  std::vector<double> late(rate_rad_s.size());
  std::vector<double> later(rate_rad_s.size());
  for (std::size_t i = 0; i < rate_rad_s.size(); ++i) {
    late[i] = -rate_rad_s[i];
    later[i] = -rate_rad_s[i] * (record.motion.time_s[i] - middle_s);
  }
  const Whittle::Whitened whitened(record.spectra, one.fit.response, one.fit.floor, kSeen);
  std::vector<Spectrum> slopes = RunSlopes(record, one.set.hypotheses()).at(one.fit.x, fitter.fitted(one));
  slopes.push_back(record.made(late));
  const Projection beside(whitened, slopes);
  const Eigen::VectorXd left = beside.of(whitened, one.fit.residual);
  const Eigen::VectorXd along = beside.of(whitened, record.made(later));
  const double above_noise = left.squaredNorm() - whitened.lines();
  const double information = along.squaredNorm();
  if (!(information > 0) || !(above_noise > 0)) return std::nullopt;
  const double gained = std::pow(along.dot(left), 2) / information;
  const double after = std::max(1.0, (left.squaredNorm() - gained) / whitened.lines());
  return ClockDrift{
      .per_s = along.dot(left) / information, .nats = gained / after, .share = std::min(1.0, gained / above_noise)};
}

std::string clock_drift_words(const FittedSet& one, const SetFitter& fitter) {
  constexpr double kMost = 0.5;
  const std::optional<ClockDrift> drift = clock_drift_left(one, fitter);
  if (!drift || drift->nats < kStrong_nats || drift->share < kMost) return {};
  return fmt::format(
      "{:.0f} % of what the simulation leaves beside the best J, B and C and a delay is a drift between the clocks of "
      "angle and torque: the angle comes "
      "{} by {:.2g} us every second, by {:.2g} ms from the record's first sample to its last; give all channels the "
      "stamps of one clock, or every file its own (--with)",
      100 * drift->share, drift->per_s > 0 ? "later" : "earlier", 1e6 * std::abs(drift->per_s),
      1e3 * std::abs(drift->per_s) * span_of(fitter.setting().record).length_s());
}

}  // namespace steerid::gap
