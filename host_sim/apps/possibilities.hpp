// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a diagnosis says of every change, each with a probability of its own.
//
// The ranking of diagnosis.json shares one among all ids, so that three changes that are sure have a third each there.
// A reader wants to know how sure each is: that is the probability that its change is made, 0 to 1, whatever else is.
// Those of none, parameters and unknown are the same in both.
#pragma once

#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"

namespace steerid {

struct Possibility {
  std::string id;    ///< of an effect, or none, parameters, unknown
  std::string name;  ///< in words: "lag", "no lag", "lag of another size"
  double probability = 0;
  bool named = false;  ///< it is what the diagnosis answers, or a part of that
};

/// One a change that was tried, and one an id of which none was; the likeliest first.
[[nodiscard]] std::vector<Possibility> possibilities(const gap::Diagnosis& diagnosis);

}  // namespace steerid
