// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "report/thin.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steerid::report {
namespace {

struct Point {
  double x = 0;
  double y = 0;
};

/// A stretch of consecutive samples, its end excluded.
struct Bucket {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Mean of the bucket's finite points; of nothing but gaps, its middle at height `otherwise`.
Point centre(std::span<const double> x, std::span<const double> y, Bucket bucket, double otherwise) {
  Point sum;
  std::size_t finite = 0;
  for (std::size_t i = bucket.begin; i < bucket.end; ++i) {
    if (!std::isfinite(y[i])) continue;
    sum.x += x[i];
    sum.y += y[i];
    ++finite;
  }
  if (finite == 0) return {x[(bucket.begin + bucket.end - 1) / 2], otherwise};
  const auto n = static_cast<double>(finite);
  return {sum.x / n, sum.y / n};
}

/// The bucket's finite point with the largest triangle to `before` and `after`; of nothing but gaps, its first.
std::size_t chosen(std::span<const double> x, std::span<const double> y, Bucket bucket, Point before, Point after) {
  std::size_t best = bucket.begin;
  double best_area = -1;
  for (std::size_t i = bucket.begin; i < bucket.end; ++i) {
    if (!std::isfinite(y[i])) continue;
    const double area = std::abs((before.x - after.x) * (y[i] - before.y) - (before.x - x[i]) * (after.y - before.y));
    if (area > best_area) {
      best_area = area;
      best = i;
    }
  }
  return best;
}

}  // namespace

std::vector<std::size_t> thinned(std::span<const double> x, std::span<const double> y, std::size_t keep) {
  const std::size_t n = y.size();
  if (n <= keep) {
    std::vector<std::size_t> all(n);
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }
  const std::size_t buckets = keep - 2;
  const auto bucket = [&](std::size_t k) {
    return k < buckets ? Bucket{1 + k * (n - 2) / buckets, 1 + (k + 1) * (n - 2) / buckets} : Bucket{n - 1, n};
  };
  std::vector<std::size_t> kept = {0};
  kept.reserve(keep);
  Point before{x[0], std::isfinite(y[0]) ? y[0] : 0};
  for (std::size_t k = 0; k < buckets; ++k) {
    const std::size_t i = chosen(x, y, bucket(k), before, centre(x, y, bucket(k + 1), before.y));
    kept.push_back(i);
    before = {x[i], std::isfinite(y[i]) ? y[i] : before.y};
  }
  kept.push_back(n - 1);
  return kept;
}

}  // namespace steerid::report
