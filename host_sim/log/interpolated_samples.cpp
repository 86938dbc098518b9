// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/interpolated_samples.hpp"

#include <algorithm>
#include <vector>

#include "log/log_format.hpp"

namespace steerid {
namespace {

constexpr std::size_t kMostFor = 50;  // a sensor of 20 Hz in a log of 1 kHz
// Of sum d^2 on the rows between. Straight lines leave the rounding of the text, 1e-6 of it in a log of six digits;
// anything else leaves half of it and more (n = 2). Any share in between decides the same.
constexpr double kBesideLines = 1e-3;

/// sum d_i^2 over the rows i with i mod `every` = r, for every r.
std::vector<double> bends(const std::vector<double>& x, std::size_t every) {
  std::vector<double> sum(every);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double bend = x[i + 1] - 2 * x[i] + x[i - 1];
    sum[i % every] += bend * bend;
  }
  return sum;
}

double total(const std::vector<double>& sums) {
  double all = 0;
  for (const double sum : sums) all += sum;
  return all;
}

/// Whether nearly half of the rows or more lie on a straight line: if not, no `every` is worth a look.
bool mostly_straight(const std::vector<double>& x) {
  constexpr double kNearlyHalf = 0.45;  // of white noise it is a fortieth
  const auto rows = static_cast<double>(x.size());
  const double straight = kBesideLines * total(bends(x, 1)) / rows;
  std::size_t count = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double bend = x[i + 1] - 2 * x[i] + x[i - 1];
    if (bend * bend <= straight) ++count;
  }
  return static_cast<double>(count) > kNearlyHalf * rows;
}

/// Whether the channels bend at the rows of one remainder only; `first` is that.
bool bend_once(const std::vector<const std::vector<double>*>& channels, std::size_t every, std::size_t& first) {
  bool found = false;
  for (const std::vector<double>* const x : channels) {
    const std::vector<double> sums = bends(*x, every);
    const auto most = std::ranges::max_element(sums);
    const auto at = static_cast<std::size_t>(most - sums.begin());
    if (found && at != first) return false;
    if (total(sums) - *most > kBesideLines * *most) return false;
    first = at;
    found = true;
  }
  return found;
}

}  // namespace

MeasuredRows measured_rows(const Record& record) {
  std::vector<const std::vector<double>*> channels;
  for (const Channel channel : kAllChannels) {
    const std::vector<double>& x = values_of(record, channel);
    if (channel == Channel::kTime || !(total(bends(x, 1)) > 0)) continue;
    if (!mostly_straight(x)) return {};
    channels.push_back(&x);
  }
  constexpr std::size_t kFewestBends = 20;  // fewer may be by chance
  for (std::size_t every = std::min(kMostFor, record.size() / kFewestBends); every > 1; --every) {
    std::size_t first = 0;
    if (bend_once(channels, every, first)) return {every, first};
  }
  return {};
}

Record only(const Record& record, MeasuredRows rows) {
  Record out;
  out.channels = record.channels;
  out.motor_channel = record.motor_channel;
  for (const Channel channel : kAllChannels) {
    const std::vector<double>& from = values_of(record, channel);
    std::vector<double>& to = values_of(out, channel);
    for (std::size_t i = rows.first; i < from.size(); i += rows.every) to.push_back(from[i]);
  }
  return out;
}

}  // namespace steerid
