// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// --figures DIR of the commands that write a page: its charts as files for papers (report/figures.hpp).
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "apps/files_of_run.hpp"
#include "report/figures.hpp"

namespace steerid {

/// Where there is no node to draw them, the option is refused before anything is computed. `folder` is empty without
/// it.
CLI::Option* add_figures(CLI::App& command, std::filesystem::path& folder);

/// Of the page that the command has written; nothing where no figures were asked for.
void write_figures_of_page(const std::filesystem::path& page, const std::filesystem::path& folder, FilesOfRun& files);

/// Figures are no inputs and no other outputs of this run.
[[nodiscard]] report::ClaimFile claims_figures(FilesOfRun& files);

}  // namespace steerid
