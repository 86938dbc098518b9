// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/following.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "experiment/signal_point.hpp"
#include "study/arm_score.hpp"
#include "study/quantiles.hpp"

namespace steerid {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kLongestLag_s = 10;
constexpr double kUnchanged = 1e-6;  // of the truth: it does not change

double variance(const std::vector<double>& values) {
  double mean = 0, square = 0;
  for (const double x : values) mean += x / static_cast<double>(values.size());
  for (const double x : values) square += (x - mean) * (x - mean) / static_cast<double>(values.size());
  return square;
}

bool changes(const FollowedCourse& drive) {
  const auto [low, high] = std::minmax_element(drive.truth.begin(), drive.truth.end());
  return *high - *low > kUnchanged * *high;
}

double accounted_for(const FollowedCourse& drive) {
  std::vector<double> error(drive.truth.size());
  for (std::size_t k = 0; k < error.size(); ++k) error[k] = drive.estimate[k] - drive.truth[k];
  return 1 - variance(error) / variance(drive.truth);
}

double lag_s(const std::vector<FollowedCourse>& drives) {
  const std::size_t ticks = drives.front().truth.size();
  double best_s = 0;
  double least = std::numeric_limits<double>::infinity();
  constexpr std::size_t kStep = 5;
  const std::size_t longest = std::min(ticks - 1, static_cast<std::size_t>(std::llround(kLongestLag_s / kTickS)));
  for (std::size_t late = 0; late <= longest; late += kStep) {
    double sum = 0;
    for (const FollowedCourse& drive : drives) {
      for (std::size_t k = 0; k < ticks; k += kStep) {
        const double then = drive.truth[k > late ? k - late : 0];  // before its start the truth was as at its start
        sum += std::pow(drive.estimate[k] / then - 1, 2);
      }
    }
    if (sum >= least) continue;
    least = sum;
    best_s = static_cast<double>(late) * kTickS;
  }
  return best_s;
}

/// From 10 to 90 % of the truth's way from its first to its last value, of the mean over the drives.
double rise_s(const std::vector<FollowedCourse>& drives, std::vector<double> FollowedCourse::*of) {
  const std::size_t ticks = drives.front().truth.size();
  double from = kNothing;
  for (std::size_t k = 0; k < ticks; ++k) {
    double way = 0;
    for (const FollowedCourse& drive : drives) {
      const double whole = drive.truth.back() - drive.truth.front();
      way += ((drive.*of)[k] - drive.truth.front()) / whole / static_cast<double>(drives.size());
    }
    if (!(way >= 0.1)) from = kNothing;
    if (way >= 0.1 && std::isnan(from)) from = static_cast<double>(k) * kTickS;
    if (way >= 0.9) return static_cast<double>(k) * kTickS - from;
  }
  return kNothing;
}

double settled_s(const FollowedCourse& drive, double change_s) {
  const auto end = static_cast<std::size_t>(std::llround(change_s / kTickS));
  double settled = 0;
  for (std::size_t k = end; k < drive.truth.size(); ++k) {
    if (std::abs(drive.estimate[k] / drive.truth[k] - 1) > ArmScore::kClose) {
      settled = static_cast<double>(k + 1 - end) * kTickS;
    }
  }
  return settled;
}

}  // namespace

Following following_of(const std::vector<FollowedCourse>& drives, double change_s) {
  const std::size_t ticks = drives.front().truth.size();
  const auto count = static_cast<double>(drives.size());
  double bias = 0, random = 0;
  for (std::size_t k = 0; k < ticks; ++k) {
    double mean = 0, square = 0;
    for (const FollowedCourse& drive : drives) {
      const double off = drive.estimate[k] / drive.truth[k] - 1;
      mean += off / count;
      square += off * off / count;
    }
    bias += mean * mean / static_cast<double>(ticks);
    random += (square - mean * mean) / static_cast<double>(ticks);
  }
  Following result;
  result.bias = std::sqrt(bias);
  result.random = std::sqrt(std::max(0.0, random));
  result.total = std::sqrt(bias + random);
  std::vector<double> settled, accounted;
  for (const FollowedCourse& drive : drives) settled.push_back(settled_s(drive, change_s));
  result.settled_median_s = quantile(settled, 0.5);
  result.settled_p90_s = quantile(settled, 0.9);
  result.accounted = result.lag_s = result.rise_s = result.truth_rise_s = kNothing;
  if (!std::all_of(drives.begin(), drives.end(), changes)) return result;
  for (const FollowedCourse& drive : drives) accounted.push_back(accounted_for(drive));
  result.accounted = quantile(accounted, 0.5);
  result.lag_s = lag_s(drives);
  const auto goes_somewhere = [](const FollowedCourse& drive) {
    return std::abs(drive.truth.back() / drive.truth.front() - 1) > 0.05;
  };
  if (std::all_of(drives.begin(), drives.end(), goes_somewhere)) {
    result.rise_s = rise_s(drives, &FollowedCourse::estimate);
    result.truth_rise_s = rise_s(drives, &FollowedCourse::truth);
  }
  return result;
}

}  // namespace steerid
