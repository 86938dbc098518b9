// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a blind study says of simulations that have effects and of wheels with several: whether the changes that are
// named are those that were drawn, and whether a change is made as often as its probability says.
//
//   exact       the changes named are the changes drawn, no more and no less
//   all named   every change drawn is named
//   only true   no change is named that was not drawn
//
// A record that the diagnosis refused names nothing.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "study/blind_score.hpp"

namespace steerid::blind_study {

struct ChangeScore {
  Share exact;
  Share all_named;
  Share only_true;
};

struct SeveralScores {
  std::size_t cases = 0;
  std::size_t refused = 0;
  ChangeScore all;
  std::map<std::string, ChangeScore> of;     ///< by what has to change (blind/contents.hpp)
  std::vector<ReliabilityBand> reliability;  ///< of all changes that were considered; `right` where it was drawn
  double calibration_error = 0;              ///< mean distance of probability and share over the bands above 5 %
  double brier = 0;                          ///< mean over records of the sum over changes of (probability - 0 or 1)^2
  double median_closed = 0;
};

[[nodiscard]] SeveralScores score_several(std::span<const Case> cases);

}  // namespace steerid::blind_study
