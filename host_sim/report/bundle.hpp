// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page's template with script and style inside, as the build made it from page/.
#pragma once

#include <string_view>

namespace steerid::report {

std::string_view page_bundle();

/// The script that draws a document's charts as files (page/src/figures_main.mjs).
std::string_view figures_bundle();

}  // namespace steerid::report
