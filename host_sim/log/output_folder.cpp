// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/output_folder.hpp"

#include <list>
#include <system_error>

#include "log/bad_input.hpp"
#include "log/whole_file.hpp"

namespace steerid {

void make_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw bad_input({.file = folder.string(),
                     .expected = "a folder that can be made",
                     .found = error.message(),
                     .advice = "give --out another place"});
  }
}

void make_output_folder(const std::filesystem::path& folder) {
  make_folders(folder);
  const WholeFile probe(folder / "probe of steerid");  // never committed: it goes again
}

void check_output_file(const std::filesystem::path& target) {
  if (target == "-") return;
  std::error_code missing;
  const std::filesystem::file_status status = std::filesystem::status(target, missing);
  if (std::filesystem::is_other(status)) return;
  const WholeFile probe(target);  // never committed: it goes again
}

void write_together(const std::filesystem::path& folder, std::initializer_list<OutputFile> files) {
  make_output_folder(folder);
  std::list<WholeFile> written;
  for (const OutputFile& file : files) written.emplace_back(folder / file.name).write(file.text);
  for (WholeFile& file : written) file.commit();
}

}  // namespace steerid
