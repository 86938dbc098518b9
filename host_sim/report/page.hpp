// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A report: one HTML page that holds its data, its script and its style, and asks no network for anything.
//
// The page's script and style come from page/ (Apache ECharts and the parts' own modules, bundled by esbuild when the
// project is built) and are linked into this library, so that a program needs no file beside it.
//
// The same Page gives the same bytes. A page without data is about 0.7 MB.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "report/parts.hpp"

namespace steerid::report {

struct Page {
  std::string title = {};
  std::string subtitle = {};
  std::vector<Part> parts = {};
  std::string footer = {};
};

/// A series of more samples than this is thinned to so many when the page is written; the page says so under the chart.
inline constexpr std::size_t kSamplesKept = 20'000;

/// The document that stands in the page, as JSON text.
/// Throws std::invalid_argument when a part contradicts itself: columns of unequal length, rows of unequal length.
std::string document_json(const Page& page);

/// The whole page.
std::string html(const Page& page);

/// Writes the page to `path`, whole or not at all (log/whole_file.hpp). Throws what html() throws, and BadInput when
/// the file cannot be written.
void write_page(const std::filesystem::path& path, const Page& page);

}  // namespace steerid::report
