// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace steerid {
namespace {

constexpr double kEvenJitter = 1e-3;  // of a period

/// Lagrange's cubic through samples i .. i+3 at time t, for all channels.
void cubic(const Stretch& source, std::size_t i, double t, Stretch& out) {
  std::array<double, 4> weight{};
  for (std::size_t a = 0; a < 4; ++a) {
    weight[a] = 1.0;
    for (std::size_t b = 0; b < 4; ++b) {
      if (a == b) continue;
      weight[a] *= (t - source.time_s[i + b]) / (source.time_s[i + a] - source.time_s[i + b]);
    }
  }
  for (std::size_t channel = 0; channel < out.values.size(); ++channel) {
    if (source.values[channel].empty()) continue;
    double sum = 0.0;
    for (std::size_t a = 0; a < 4; ++a) sum += weight[a] * source.values[channel][i + a];
    out.values[channel].push_back(sum);
  }
}

}  // namespace

Stretch cut(const Record& record, GapFreeRows rows) {
  const auto part = [&](const std::vector<double>& column) {
    return std::vector<double>(column.begin() + static_cast<std::ptrdiff_t>(rows.begin),
                               column.begin() + static_cast<std::ptrdiff_t>(rows.end));
  };
  Stretch stretch{part(record.time_s), {}};
  for (std::size_t i = 0; i < stretch.values.size(); ++i) {
    const std::vector<double>& values = values_of(record, kAllChannels[i + 1]);
    if (!values.empty()) stretch.values[i] = part(values);
  }
  return stretch;
}

void append(Record& record, const Stretch& stretch) {
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(record.time_s, stretch.time_s);
  for (std::size_t i = 0; i < stretch.values.size(); ++i) {
    add(values_of(record, kAllChannels[i + 1]), stretch.values[i]);
  }
}

std::vector<double> even_times(double origin_s, double first_s, double last_s, double period_s) {
  std::vector<double> times;
  const double from = std::ceil((first_s - origin_s - kSameStampS) / period_s);
  const double to = std::floor((last_s - origin_s + kSameStampS) / period_s);
  for (double k = from; k <= to; k += 1.0) times.push_back(origin_s + k * period_s);
  return times;
}

double mean_period_s(const std::vector<double>& time_s, double median_s) {
  double sum_s = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double interval_s = time_s[i] - time_s[i - 1];
    if (std::abs(interval_s - median_s) > 0.5 * median_s) continue;
    sum_s += interval_s;
    ++count;
  }
  return count > 0 ? sum_s / static_cast<double>(count) : median_s;
}

bool on_even_grid(const std::vector<double>& time_s, double period_s) {
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double grid_s = time_s.front() + static_cast<double>(i) * period_s;
    if (std::abs(time_s[i] - grid_s) > kEvenJitter * period_s) return false;
  }
  return true;
}

Stretch interpolated(const Stretch& source, std::vector<double> times) {
  Stretch out;
  out.time_s = std::move(times);
  std::size_t next = 1;  // source sample next - 1 is the last one not after t
  for (const double t : out.time_s) {
    while (next + 1 < source.time_s.size() && source.time_s[next] <= t) ++next;
    const std::size_t nearest = t - source.time_s[next - 1] < source.time_s[next] - t ? next - 1 : next;
    if (std::abs(source.time_s[nearest] - t) <= kSameStampS) {
      for (std::size_t c = 0; c < out.values.size(); ++c) {
        if (!source.values[c].empty()) out.values[c].push_back(source.values[c][nearest]);
      }
    } else {
      cubic(source, std::clamp<std::size_t>(next, 2, source.time_s.size() - 2) - 2, t, out);
    }
  }
  return out;
}

std::vector<double> interpolated(const std::vector<double>& time_s, const std::vector<double>& values,
                                 std::vector<double> at_s) {
  Stretch source{time_s, {}};
  source.values.front() = values;
  return interpolated(source, std::move(at_s)).values.front();
}

Stretch evened(Stretch stretch, double period_s) {
  if (on_even_grid(stretch.time_s, period_s)) return stretch;
  const double first_s = stretch.time_s.front();
  return interpolated(stretch, even_times(first_s, first_s, stretch.time_s.back(), period_s));
}

Stretch filtered(const Stretch& source, double period_s, const AntiAlias& filter, std::vector<double> times) {
  static const AntiAliasKernel kernel;
  const double reach = filter.half_length_s / period_s;  // in source samples
  Stretch out;
  out.time_s = std::move(times);
  std::vector<double> weight;
  for (const double t : out.time_s) {
    const double centre = (t - source.time_s.front()) / period_s;
    const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(centre - reach)));
    const auto last = std::min(source.time_s.size() - 1, static_cast<std::size_t>(centre + reach));
    weight.clear();
    double scale = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      weight.push_back(kernel.at((centre - static_cast<double>(i)) / reach));
      scale += weight.back();
    }
    for (std::size_t channel = 0; channel < out.values.size(); ++channel) {
      if (source.values[channel].empty()) continue;
      const double* const value = source.values[channel].data() + first;
      double sum = 0.0;
      for (std::size_t k = 0; k < weight.size(); ++k) sum += weight[k] * value[k];
      out.values[channel].push_back(sum / scale);
    }
  }
  return out;
}

}  // namespace steerid
