// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a blind study says of the diagnosis. Every share carries the 95 % interval that so many cases leave (Wilson
// 1927).
//
//   right            the verdict is the label
//   top-1, top-3     the label is the most probable id, or among the three
//   Brier            mean over cases of the sum over ids of (probability - 1 for the label, 0 else)^2: 0 best, 2 worst
//                    (Brier 1950, as first stated)
//   false alarm      an effect is named although there is none (`none` and `parameters` records)
//   abstention       `unknown` is said of an effect outside the vocabulary; needless when it is said of anything else
//   detection        by gap over floor: `noticed` any gap at all, `right` the effect by name
//   closed           the fraction of the gap that the named effects close. With the right effect nothing
//                    but noise is left, so the interval covers when it reaches to 1
//   recovery         |found/true - 1| of an effect's parameters and of J, B, C, where the right effect is named
//
// A record that the diagnosis refused counts as wrong, with no probability on anything.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "study/blind_cases.hpp"

namespace steerid::blind_study {

/// Some of all, as a share with its interval. Of nothing: not a number.
struct Share {
  std::size_t some = 0;
  std::size_t all = 0;
  [[nodiscard]] double value() const;
  [[nodiscard]] Interval ci95() const;
  void count(bool is) { some += is ? 1 : 0, ++all; }
};

struct LabelScore {
  std::size_t cases = 0;
  Share right;
  double mean_probability = 0;  ///< on the label
  std::map<std::string, std::size_t> verdicts;
};

struct GapBand {
  double low = 0;
  double high = 0;
  Share noticed;
  Share right;
};

/// Cases whose most probable id has a probability from low to high.
struct ReliabilityBand {
  double low = 0;
  double high = 0;
  double mean_probability = 0;
  Share right;
};

struct Recovery {
  std::size_t cases = 0;
  double median_error_percent = 0;
  double p90_error_percent = 0;
  Share covered;  ///< by the 95 % interval
};

struct Scores {
  std::size_t cases = 0;
  std::size_t refused = 0;
  Share right;
  Share right_or_equivalent;
  Share top1;
  Share top3;
  Share false_alarms;
  Share abstained;
  Share needlessly_unknown;
  double mean_probability = 0;
  double brier = 0;
  double calibration_error = 0;  ///< mean distance of probability and share right over the bands, weighted by cases
  double median_closed = 0;
  Share closed_covers;
  std::map<std::string, LabelScore> labels;
  std::map<std::string, std::map<std::string, std::size_t>> outside;  ///< unknown effect -> verdicts
  std::vector<GapBand> detection;
  std::vector<ReliabilityBand> reliability;
  std::map<std::string, Recovery> recovery;  ///< "coulomb_friction.friction_nm", "inertia_kgm2"
};

[[nodiscard]] Scores score(std::span<const Case> cases);

/// Records with two effects at once.
struct PairScores {
  std::size_t cases = 0;
  Share both_named;
  Share one_named;  ///< at least
  Share only_true;  ///< nothing named that is not there
  double median_closed = 0;
};
[[nodiscard]] PairScores score_pairs(std::span<const Case> cases);

/// Leave-one-out: every case was diagnosed with its own effect taken out of the library.
struct LeftOut {
  Share unknown;  ///< or an effect that the whole library called equivalent
  std::map<std::string, std::size_t> impostors;
};
struct LeaveOneOutScores {
  Share unknown;
  std::map<std::string, LeftOut> effects;
};
/// `whole` holds the same cases diagnosed with the whole library, or nothing.
[[nodiscard]] LeaveOneOutScores score_leave_one_out(std::span<const Case> cases, std::span<const Case> whole);

}  // namespace steerid::blind_study
