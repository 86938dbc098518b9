// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The charts of a page as files for papers: SVG one column of a journal wide (88 mm, letters of 8 points, on white),
// and the numbers of each as CSV in full precision, with units in the header.
//
// They are drawn by the page's own modules, which node runs without a browser: one place says how a chart looks.
#pragma once

#include <filesystem>
#include <functional>

#include "report/page.hpp"

namespace steerid::report {

/// Called with every figure's place before it is written; throws where it is not free, as that of an input.
using ClaimFile = std::function<void(const std::filesystem::path&)>;

/// Writes FOLDER/NN_TITLE.svg and .csv of each chart, numbered in the page's order; makes the folder. All are drawn
/// before the first takes its place. Throws BadInput when there is no node in PATH, when node fails or when the folder
/// cannot be written, and what `claim` throws.
void write_figures(const std::filesystem::path& folder, const Page& page, const ClaimFile& claim);

/// The same of a page that write_page() has written.
void write_figures_of(const std::filesystem::path& page, const std::filesystem::path& folder, const ClaimFile& claim);

/// Throws BadInput when there is no node in PATH: for a command to ask before it computes.
void require_node();

}  // namespace steerid::report
