// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/searched_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steerid::gap {
namespace {

// How often a simulation is right in what it says, before a record is looked at.
constexpr double kWheelGiven = 0.5;
constexpr double kKept = 0.7;
constexpr double kResized = 0.2;
constexpr double kAddedEach = 0.03;

double log_prior(const EffectSet& set) {
  double sum = std::log(set.wheel_given ? kWheelGiven : 1 - kWheelGiven);
  for (const SetPart& part : set.parts) {
    sum += std::log(part.as == Stands::kGiven ? kKept : part.as == Stands::kResized ? kResized : kAddedEach);
  }
  sum += static_cast<double>(set.removed.size()) * std::log(1 - kKept - kResized);
  return sum + (set.slow == SlowTorque::kCause ? std::log(kAddedEach) : 0);
}

}  // namespace

double SearchedSets::score(const FittedSet& one, double dispersion) {
  if (!one.eligible) return -std::numeric_limits<double>::infinity();
  return one.log_evidence(dispersion) + log_prior(one.set);
}

const FittedSet* SearchedSets::find(const EffectSet& set) const {
  const std::string name = set.name();
  const auto same = std::ranges::find_if(visited, [&](const FittedSet& one) { return one.set.name() == name; });
  return same == visited.end() ? nullptr : &*same;
}

const FittedSet& SearchedSets::nearest() const {
  return *std::ranges::min_element(visited, {}, [](const FittedSet& one) {
    return one.eligible ? one.nats() : std::numeric_limits<double>::infinity();
  });
}

void SearchedSets::rank() { rank_by(std::max(1.0, nearest().excess())); }

void SearchedSets::judge() { rank_by(nearest().left_nats() / nearest().chance_nats()); }

void SearchedSets::rank_by(double by) {
  dispersion = by;
  const auto highest = std::ranges::max_element(visited, {}, [&](const FittedSet& one) { return score(one); });
  best = static_cast<std::size_t>(highest - visited.begin());
}

std::vector<double> SearchedSets::probabilities() const {
  std::vector<double> all;
  double sum = 0;
  for (const FittedSet& one : visited) {
    all.push_back(std::exp(score(one) - score(visited[best])));
    sum += all.back();
  }
  for (double& one : all) one /= sum;
  return all;
}

}  // namespace steerid::gap
