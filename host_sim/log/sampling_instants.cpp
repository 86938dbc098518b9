// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/sampling_instants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "log/bend.hpp"
#include "log/neighbours.hpp"

namespace steerid {
namespace {

/// The lower quartile of what is left of a window at the record's ends; NaN of nothing.
double lower_quartile(std::span<const double> all, std::size_t begin, std::size_t end) {
  std::vector<double> window(all.begin() + static_cast<std::ptrdiff_t>(begin),
                             all.begin() + static_cast<std::ptrdiff_t>(std::min(end, all.size())));
  if (window.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto quartile = window.begin() + static_cast<std::ptrdiff_t>(window.size() / 4);
  std::ranges::nth_element(window, quartile);
  return *quartile;
}

using Channels = std::span<const std::vector<double>>;

/// What a channel is off a parabola over two samples on either side of a hole of `lost` samples before sample i.
double bend_over(const std::vector<double>& x, std::size_t i, double lost) {
  const BendWeights weight = bend_weights({0, 1, 2 + lost, 3 + lost});
  return std::inner_product(weight.begin(), weight.end(), x.begin() + static_cast<std::ptrdiff_t>(i) - 2, 0.0);
}

/// By how much likelier the samples are with `lost` of them missing before sample i than with none, nats; 0 where
/// nothing moves.
class HolesBySamples {
 public:
  explicit HolesBySamples(Channels channels) : channels_(channels) {
    for (const std::vector<double>& x : channels) {
      double squares = 0;
      for (std::size_t i = 2; i + 1 < x.size(); ++i) squares += std::pow(bend_over(x, i, 0), 2);
      variance_.push_back(squares / static_cast<double>(std::max<std::size_t>(x.size(), 1)));
    }
  }
  [[nodiscard]] double nats(std::size_t i, double lost) const {
    double sum = 0;
    for (std::size_t c = 0; c < variance_.size(); ++c) {
      const std::vector<double>& x = channels_[c];
      if (i < 2 || i + 1 >= x.size() || !(variance_[c] > 0)) continue;
      sum += (std::pow(bend_over(x, i, 0), 2) - std::pow(bend_over(x, i, lost), 2)) / (2 * variance_[c]);
    }
    return sum;
  }

 private:
  Channels channels_;
  std::vector<double> variance_;
};

/// Whether next to no interval is farther from a whole number of periods than a quarter of one.
bool stand_on_whole_periods(const std::vector<double>& time_s, double period_s) {
  constexpr double kQuarter = 0.25;
  constexpr std::size_t kOneIn = 100;
  std::size_t between = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double interval = (time_s[i] - time_s[i - 1]) / period_s;
    if (std::abs(interval - std::round(interval)) > kQuarter) ++between;
  }
  return between * kOneIn < time_s.size();
}

/// How many samples were lost before each: see the header.
std::vector<double> lost_before(const std::vector<double>& time_s, double period_s, Channels channels) {
  constexpr double kNoLoss = 1.5;    // periods: half-way between none and one
  constexpr double kPlainly = 0.75;  // of a period: a whole one, less what strays move a quartile by
  constexpr std::array<std::size_t, 2> kWindows = {10, 30};
  const bool whole = stand_on_whole_periods(time_s, period_s);
  const HolesBySamples holes(channels);
  std::vector<double> late(time_s.size());  // periods, lost samples so far taken off
  for (std::size_t i = 0; i < late.size(); ++i) {
    late[i] = (time_s[i] - time_s.front()) / period_s - static_cast<double>(i);
  }
  std::vector<double> lost(late.size());
  double before = 0;
  for (std::size_t i = 1; i < late.size(); ++i) {
    const double interval = (time_s[i] - time_s[i - 1]) / period_s;
    if (interval >= kNoLoss) {
      double count = std::round(interval) - 1;
      for (const std::size_t window : kWindows) {
        const double step =
            lower_quartile(late, i, i + window) - before - lower_quartile(late, i - std::min(window, i), i);
        count = step >= kPlainly ? std::min(count, std::round(step)) : 0;
      }
      if (whole || holes.nats(i, count) >= 0) before += count;
    }
    late[i] -= before;
    lost[i] = before;
  }
  return lost;
}

/// By how much every stamp strays from the grid through all of them, s.
std::vector<double> strays_of(const std::vector<double>& time_s, const std::vector<double>& grid_s) {
  std::vector<double> stray(time_s.size());
  double mean = 0;
  for (std::size_t i = 0; i < stray.size(); ++i) mean += stray[i] = time_s[i] - grid_s[i];
  mean /= static_cast<double>(stray.size());
  for (double& one : stray) one -= mean;
  return stray;
}

}  // namespace

double clock_period_s(const std::vector<double>& time_s, double about_s, bool any_rate) {
  double unwrapped_s = about_s;  // of the span before, to count the periods of this one
  double best_s = about_s;
  double shortest_s = about_s;  // of all estimates, each of which slips bend another way
  double longest_s = about_s;
  double least_error_s = std::numeric_limits<double>::infinity();
  std::vector<double> periods_s;
  for (std::size_t span = 1; span <= time_s.size() / 2; span *= 2) {
    periods_s.clear();
    for (std::size_t i = 0; i + span < time_s.size(); ++i) {
      const double length_s = time_s[i + span] - time_s[i];
      periods_s.push_back(length_s / std::max(std::round(length_s / unwrapped_s), 1.0));
    }
    const auto quantile = [&](double share) {
      const auto at =
          periods_s.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(periods_s.size() - 1));
      std::ranges::nth_element(periods_s, at);
      return *at;
    };
    const double period_s = quantile(0.5);
    const double error_s =
        (quantile(0.75) - quantile(0.25)) * std::sqrt(static_cast<double>(span) / static_cast<double>(time_s.size()));
    shortest_s = span == 1 ? period_s : std::min(shortest_s, period_s);
    longest_s = span == 1 ? period_s : std::max(longest_s, period_s);
    if (error_s < least_error_s) {
      least_error_s = error_s;
      best_s = period_s;
    }
    if (span >= 8) unwrapped_s = period_s;
  }
  if (any_rate) return best_s;
  // Somebody set the clock, to a round rate; where the estimates disagree over one it is that.
  constexpr double kRounding = 1e-6;  // of the stamps
  for (const double rate_hz : {50, 60, 100, 120, 125, 200, 250, 400, 500, 1000, 2000, 2500, 4000, 5000, 10000}) {
    if (rate_hz * shortest_s <= 1 + kRounding && rate_hz * longest_s >= 1 - kRounding) return 1 / rate_hz;
  }
  return best_s;
}

std::vector<double> even_stamps(const std::vector<double>& time_s, double period_s, Channels channels) {
  std::vector<double> grid_s = lost_before(time_s, period_s, channels);
  for (std::size_t i = 0; i < grid_s.size(); ++i) {
    grid_s[i] = time_s.front() + period_s * (static_cast<double>(i) + grid_s[i]);
  }
  return grid_s;
}

bool evenly_sampled(const std::vector<double>& time_s, double period_s, std::span<const std::vector<double>> channels) {
  constexpr std::size_t kFewest = 100;
  constexpr double kSure = 0.1;                     // deviation of s
  constexpr std::size_t kReach = 3;                 // samples to either side that a sample is judged by
  constexpr double kNoneLost = 2.0 * kReach + 0.5;  // periods
  const std::size_t n = time_s.size();
  if (n < kFewest) return false;
  const std::vector<double> grid_s = even_stamps(time_s, period_s, channels);
  const std::vector<double> stray = strays_of(time_s, grid_s);
  std::vector<std::size_t> judged;  // none is missing around them, by the grid and by the stamps
  for (std::size_t i = kReach; i + kReach < n; ++i) {
    const auto none_lost = [&](const std::vector<double>& at_s) {
      return at_s[i + kReach] - at_s[i - kReach] < kNoneLost * period_s;
    };
    if (none_lost(grid_s) && none_lost(time_s)) judged.push_back(i);
  }
  const auto samples = static_cast<double>(judged.size());
  double weight = 0;
  double sum = 0;
  std::vector<double> slope(n);
  std::vector<double> moved(n);
  for (const std::vector<double>& x : channels) {
    if (x.empty()) continue;
    for (std::size_t i = 1; i + 1 < n; ++i) slope[i] = (x[i + 1] - x[i - 1]) / (2 * period_s);
    double both = 0;
    double of_moved = 0;
    double of_x = 0;
    for (const std::size_t i : judged) {
      // An even grid may stand anywhere: what all stamps here stray alike, by lost samples that were not seen as well,
      // moves none against its neighbours.
      const double here_s = std::accumulate(&stray[i - 2], &stray[i + 3], 0.0) / 5;
      for (std::size_t k = i - 2; k <= i + 2; ++k) moved[k] = slope[k] * (stray[k] - here_s);
      const double a = x[i] - by_neighbours(x, i);
      const double b = moved[i] - by_neighbours(moved, i);
      both += a * b;
      of_moved += b * b;
      of_x += a * a;
    }
    if (!(of_moved > 0) || !(of_x > 0)) continue;
    const double s = both / of_moved;
    const double left = std::max(of_x - s * both, 1e-6 * of_x) / samples;  // variance; neighbours share some of it
    weight += of_moved / left;
    sum += s * of_moved / left;
  }
  constexpr double kShared = 2;
  return weight * kSure * kSure > kShared && sum < 0.5 * weight;
}

}  // namespace steerid
