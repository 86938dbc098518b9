// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/clock_lag.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "fit/motion_fit.hpp"
#include "log/log_format.hpp"

namespace steerid {
namespace {

constexpr double kPeriodS = 0.01;
constexpr double kEightNats = 8;
constexpr std::ptrdiff_t kNear = 6;        // samples
constexpr std::size_t kToSearchIn = 3000;  // samples

Record rows_of(const Record& record, std::size_t begin, std::size_t end) {
  Record part = record;
  for (const Channel channel : kAllChannels) {
    std::vector<double>& values = values_of(part, channel);
    if (values.empty()) continue;
    values.assign(values_of(record, channel).begin() + static_cast<std::ptrdiff_t>(begin),
                  values_of(record, channel).begin() + static_cast<std::ptrdiff_t>(end));
  }
  return part;
}

/// What each lag leaves unexplained.
class Lags {
 public:
  /// Of lags up to `most` samples: the same rows are explained with each, so many away from the ends.
  Lags(Record record, std::uint8_t channels, std::ptrdiff_t most)
      : record_(std::move(record)), channels_(channels), margin_(static_cast<std::size_t>(most)) {}

  /// Of the torque's power, which a lag between two torques changes as well; nothing where there is nothing to fit.
  std::optional<double> share(std::ptrdiff_t lag) {
    if (const auto known = share_.find(lag); known != share_.end()) return known->second;
    if (record_.size() <= 2 * margin_) return std::nullopt;
    const std::size_t end = record_.size() - margin_;
    Record earlier = rows_of(record_, margin_, end);
    for (const Channel channel : kAllChannels) {
      if ((valid_bit(channel) & channels_) == 0 || !record_.has(valid_bit(channel))) continue;
      const auto from = values_of(record_, channel).begin() + lag;
      values_of(earlier, channel)
          .assign(from + static_cast<std::ptrdiff_t>(margin_), from + static_cast<std::ptrdiff_t>(end));
    }
    const MotionFit fit = fit_motion(earlier, explained_torque_nm(earlier));
    if (fit.samples == 0 || !(fit.torque_rms_nm > 0)) return std::nullopt;
    samples_ = fit.samples;
    return share_[lag] = fit.residual_rms_nm * fit.residual_rms_nm / (fit.torque_rms_nm * fit.torque_rms_nm);
  }

  /// The lag from `first` to `last` that leaves the least; nothing where there is nothing to fit.
  std::optional<std::ptrdiff_t> best(std::ptrdiff_t first, std::ptrdiff_t last) {
    std::ptrdiff_t best = first;
    for (std::ptrdiff_t lag = first; lag <= last; ++lag) {
      if (!share(lag)) return std::nullopt;
      if (*share(lag) < *share(best)) best = lag;
    }
    return best;
  }

  [[nodiscard]] double independent() const { return static_cast<double>(samples_) / kSamplesAlike; }

 private:
  Record record_;
  std::uint8_t channels_;
  std::size_t margin_;
  std::map<std::ptrdiff_t, double> share_{};
  std::size_t samples_ = 0;
};

}  // namespace

ClockLag clock_lag(const Record& record, std::uint8_t channels, double most_s) {
  const auto most = static_cast<std::ptrdiff_t>(std::lround(most_s / kPeriodS));
  std::ptrdiff_t middle = 0;
  if (most > kNear) {
    const auto far = Lags(rows_of(record, 0, std::min(record.size(), kToSearchIn)), channels, most).best(-most, most);
    if (!far) return {};
    middle = *far;
  }
  Lags lags(record, channels, std::abs(middle) + kNear);
  const auto near = lags.best(std::max(-most, middle - kNear), std::min(most, middle + kNear));
  if (!near || !lags.share(0)) return {};
  const std::ptrdiff_t best = *near;
  ClockLag found{.unexplained = *lags.share(best), .unexplained_as_is = *lags.share(0)};
  if (std::abs(best) >= most) return found;
  const double before = *lags.share(best - 1);
  const double least = *lags.share(best);
  const double behind = *lags.share(best + 1);
  const double bend = before - 2 * least + behind;
  const double off = bend > 0 ? 0.5 * (before - behind) / bend : 0;
  const double lowest = std::max(least - 0.5 * bend * off * off, 1e-12 * *lags.share(0));
  found.late_s = kPeriodS * (static_cast<double>(best) + off);
  if (bend > 0) found.sd_s = kPeriodS * std::sqrt(2 * lowest / (lags.independent() * bend));
  found.shown = std::abs(found.late_s) > 0.5 * kPeriodS &&
                0.5 * lags.independent() * std::log(*lags.share(0) / lowest) > kEightNats;
  return found;
}

}  // namespace steerid
