// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/prior.hpp"

#include <algorithm>
#include <cmath>

namespace steerid::gap {
namespace {

/// A number that was given is not taken for nothing: its logarithm is finite.
double at_least(double x, double mean) { return std::max(x, 1e-6 * mean); }

double off(const Prior& prior, double x) {
  return prior.law == Prior::Law::kNormal ? (x - prior.mean) / prior.sd
                                          : std::log(at_least(x, prior.mean) / prior.mean) / prior.sd;
}

}  // namespace

double Prior::cost(double x) const {
  if (law == Law::kNone) return 0;
  const double u = off(*this, x);
  return law == Law::kNormal ? u * u / 2 : std::log1p(u * u);
}

double Prior::weight(double x) const {
  if (law == Law::kNone) return 0;
  if (law == Law::kNormal) return 1 / (sd * sd);
  const double u = off(*this, x);
  const double width = sd * at_least(x, mean);
  return 2 / (1 + u * u) / (width * width);
}

double Prior::slope(double x) const {
  if (law == Law::kNone) return 0;
  if (law == Law::kNormal) return (x - mean) / (sd * sd);
  const double u = off(*this, x);
  return 2 * u / (1 + u * u) / (sd * at_least(x, mean));
}

}  // namespace steerid::gap
