// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The files of a study: NAME.csv and NAME.json for programs, NAME.html for readers. Each appears whole or not at all,
// and nothing is written before all three are made.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "report/page.hpp"
#include "study/study.hpp"

namespace steerid {

/// One row a case, method and parameter.
[[nodiscard]] std::string study_csv(const StudyResult& result);
/// {"schema":"steerid.study/1", ...}: the same figures, with their intervals.
[[nodiscard]] std::string study_json(const StudyResult& result,
                                     const nlohmann::ordered_json& made_by = nlohmann::ordered_json::object());
[[nodiscard]] report::Page study_page(const StudyResult& result);

/// Makes `folder` when it is missing. Throws BadInput when it cannot be written.
void write_study(const std::filesystem::path& folder, const StudyResult& result, const nlohmann::ordered_json& made_by);

}  // namespace steerid
