// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the likeliest set changes, whether it is sure enough to be named or not.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"

namespace steerid::test {

/// Ids, in the order of the alphabet.
inline std::vector<std::string> likeliest_changes(const gap::Diagnosis& diagnosis) {
  std::vector<std::string> ids;
  for (const gap::SetEvidence::Change& change : diagnosis.evidence.front().changes) ids.push_back(change.effect);
  std::ranges::sort(ids);
  return ids;
}

}  // namespace steerid::test
