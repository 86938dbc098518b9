// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/clock_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/model/run_slopes.hpp"
#include "gap/sets/projection.hpp"

namespace steerid::gap {

std::optional<ClockError> clock_error_left(const FittedSet& one, const SetFitter& fitter, ClockError::Course course) {
  const bool growing = course == ClockError::Course::kGrowing;
  const SpectralRecord& record = fitter.setting().record;
  const MeasuredMotion& motion = record.motion;
  const double middle_s = span_of(record).middle_s();
  const auto made = [&](const std::vector<double>& channel, bool grows) {
    std::vector<double> signal = channel;
    for (std::size_t i = 0; grows && i < signal.size(); ++i) signal[i] *= motion.time_s[i] - middle_s;
    return record.made(signal);
  };
  const Whittle::Whitened whitened(record.spectra, one.fit.response, one.fit.floor, kSeen);
  std::vector<Spectrum> slopes = RunSlopes(record, one.set.hypotheses()).at(one.fit.x, fitter.fitted(one));
  slopes.push_back(made(motion.rate_rad_s, !growing));
  for (const auto* channel : {&motion.acceleration_rad_s2, &motion.rate_rad_s, &motion.angle_rad}) {
    slopes.emplace_back(made(*channel, true).cwiseProduct(one.fit.response.gain_on_motion()));
  }
  const Projection beside(whitened, slopes);
  const Eigen::VectorXd left = beside.of(whitened, one.fit.residual);
  const Eigen::VectorXd along = beside.of(whitened, -made(motion.rate_rad_s, growing));
  const double above_noise = left.squaredNorm() - whitened.lines();
  const double information = along.squaredNorm();
  if (!(information > 0) || !(above_noise > 0)) return std::nullopt;
  const double gained = std::pow(along.dot(left), 2) / information;
  const double after = std::max(1.0, (left.squaredNorm() - gained) / whitened.lines());
  return ClockError{
      .size = along.dot(left) / information, .nats = gained / after, .share = std::min(1.0, gained / above_noise)};
}

bool ClockError::is_plain() const { return nats >= kStrong_nats; }

bool ClockError::matters() const {
  constexpr double kMuch = 0.1;
  return is_plain() && share >= kMuch;
}

}  // namespace steerid::gap
