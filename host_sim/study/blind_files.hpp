// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A blind study's results as files: blind.json, blind.csv (one row a record) and blind.html.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/page.hpp"
#include "study/blind_score.hpp"

namespace steerid::blind_study {

struct Study {
  std::uint64_t seed = 0;
  std::string key_sha256;
  std::vector<Case> cases = {};           ///< one effect or none in each; empty in a study of pairs
  std::vector<Case> pairs = {};           ///< two effects in each
  std::vector<Case> several = {};         ///< changes of every kind, up to four at once
  std::vector<Case> left_out = {};        ///< each without its own effect in the library
  std::vector<Case> left_out_whole = {};  ///< with the whole library, those of which something was named without
};

[[nodiscard]] std::string blind_json(const Study& study,
                                     const nlohmann::ordered_json& made_by = nlohmann::ordered_json::object());
[[nodiscard]] std::string blind_csv(const Study& study);
[[nodiscard]] report::Page blind_page(const Study& study);
/// The figures in lines, for a terminal.
[[nodiscard]] std::string blind_text(const Study& study);

/// All three files, or none.
void write_blind_study(const std::filesystem::path& folder, const Study& study,
                       const nlohmann::ordered_json& made_by = nlohmann::ordered_json::object());

}  // namespace steerid::blind_study
