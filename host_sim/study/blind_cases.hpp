// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A blind study's truths and answers, read from its files: the key that was sealed, and one diagnosis.json a record.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "study/score.hpp"

namespace steerid::blind_study {

using Values = std::map<std::string, double>;

/// What has to change in a simulation: an effect, and add, resize or remove.
using Change = std::pair<std::string, std::string>;

struct Truth {
  std::string label;                         ///< the verdict that is right
  std::vector<std::string> effects;          ///< what was in the record; for unknown effects their own names
  std::map<std::string, Values> parameters;  ///< of each effect
  Values arm;                                ///< inertia_kgm2, damping_nms_per_rad, stiffness_nm_per_rad
  double gap_over_floor = 1;
  std::string several_case;  ///< what has to change, in words (blind/contents.hpp)
  std::set<Change> changes;
};

struct Estimated {
  double value = 0;
  Interval ci95;
};

struct NamedCause {
  std::string effect;
  std::map<std::string, Estimated> parameters;
  std::string change = "add";
};

struct Answer {
  std::string verdict = {};
  std::map<std::string, double> probability = {};  ///< of every id
  std::vector<NamedCause> causes = {};
  std::vector<std::string> equivalent = {};
  std::optional<Estimated> closed_fraction = {};
  std::map<std::string, Estimated> arm = {};
  std::map<Change, double> inclusion = {};  ///< the probability of every change

  /// What is named; nothing of a surrogate.
  [[nodiscard]] std::set<Change> changes() const;
};

struct Case {
  std::string name;
  Truth truth;
  std::optional<Answer> answer;  ///< nothing where the diagnosis refused the record
};

/// The key's text; throws BadInput naming `file` when it is no key.
[[nodiscard]] std::map<std::string, Truth> read_key(std::string_view text, const std::string& file);

/// ANSWERS/NAME/diagnosis.json; nothing when there is none. Throws BadInput when it cannot be understood.
[[nodiscard]] std::optional<Answer> read_answer(const std::filesystem::path& file);

}  // namespace steerid::blind_study
