// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/several_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace steerid::blind_study {
namespace {

constexpr std::array kEdges = {0.0, 0.05, 0.3, 0.5, 0.7, 0.85, 0.95, 0.99, 1.0};

void count(ChangeScore& score, const Case& one) {
  const std::set<Change> named = one.answer ? one.answer->changes() : std::set<Change>{};
  score.exact.count(named == one.truth.changes && one.answer && one.answer->verdict != "unknown");
  score.all_named.count(std::ranges::includes(named, one.truth.changes));
  score.only_true.count(std::ranges::includes(one.truth.changes, named));
}

}  // namespace

SeveralScores score_several(std::span<const Case> cases) {
  SeveralScores out;
  for (std::size_t i = 0; i + 1 < kEdges.size(); ++i) out.reliability.push_back({kEdges[i], kEdges[i + 1], 0, {}});
  std::vector<double> closed;
  for (const Case& one : cases) {
    ++out.cases;
    count(out.all, one);
    count(out.of[one.truth.several_case], one);
    if (!one.answer) {
      ++out.refused;
      continue;
    }
    if (one.answer->closed_fraction) closed.push_back(one.answer->closed_fraction->value);
    for (const auto& [change, probability] : one.answer->inclusion) {
      const bool drawn = one.truth.changes.contains(change);
      out.brier += std::pow(probability - (drawn ? 1 : 0), 2);
      const auto above = std::upper_bound(kEdges.begin() + 1, kEdges.end() - 1, probability);
      ReliabilityBand& band = out.reliability[static_cast<std::size_t>(above - kEdges.begin()) - 1];
      band.mean_probability += probability;
      band.right.count(drawn);
    }
  }
  out.brier /= static_cast<double>(std::max<std::size_t>(out.cases, 1));
  double weight = 0;
  for (ReliabilityBand& band : out.reliability) {
    if (band.right.all == 0) continue;
    const auto of = static_cast<double>(band.right.all);
    band.mean_probability /= of;
    if (band.low < kEdges[1]) continue;
    out.calibration_error += of * std::abs(band.mean_probability - band.right.value());
    weight += of;
  }
  if (weight > 0) out.calibration_error /= weight;
  std::ranges::sort(closed);
  out.median_closed = closed.empty() ? std::nan("") : closed[closed.size() / 2];
  return out;
}

}  // namespace steerid::blind_study
