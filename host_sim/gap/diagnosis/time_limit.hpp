// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What an answer can do without is left out once the time is up, and the answer says so.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"

namespace steerid::gap {

/// Whether there is time for `what`; where there is none, `notes` say once that it was left out.
inline bool time_for(const std::string& what, const DiagnoseOptions& options, std::vector<std::string>& notes) {
  if (!options.out_of_time()) return true;
  std::string says = "the time limit was reached: " + what + " was left out";
  if (std::ranges::find(notes, says) == notes.end()) notes.push_back(std::move(says));
  return false;
}

}  // namespace steerid::gap
