// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/figures_option.hpp"

#include <string>

#include "apps/option_kinds.hpp"

namespace steerid {

CLI::Option* add_figures(CLI::App& command, std::filesystem::path& folder) {
  return writes_folder(command.add_option("--figures", folder,
                                          "Each chart as SVG one column of a paper wide, and its numbers as CSV"))
      ->check([](const std::string&) {
        report::require_node();
        return std::string();
      })
      ->type_name("DIR");
}

report::ClaimFile claims_figures(FilesOfRun& files) {
  return [&files](const std::filesystem::path& figure) { files.writes(figure, "--figures"); };
}

void write_figures_of_page(const std::filesystem::path& page, const std::filesystem::path& folder, FilesOfRun& files) {
  if (!folder.empty()) report::write_figures_of(page, folder, claims_figures(files));
}

}  // namespace steerid
