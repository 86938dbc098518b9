// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Parts to JSON: the document that page/src/document.ts describes.
#pragma once

#include <nlohmann/json.hpp>

#include "report/parts.hpp"

namespace steerid::report {

/// Throws std::invalid_argument when the part contradicts itself.
nlohmann::json to_document(const Part& part);

}  // namespace steerid::report
